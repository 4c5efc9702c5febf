#include "viewer/voxel_faces.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace vantage {
namespace {

StateGrid gridOf(const Eigen::Vector3i& size, VoxelState fill) {
  StateGrid grid(GridGeometry{{0.0, 0.0, 0.0}, 0.1, size});
  for (int k = 0; k < size.z(); ++k) {
    for (int j = 0; j < size.y(); ++j) {
      for (int i = 0; i < size.x(); ++i) grid.set({i, j, k}, fill);
    }
  }
  return grid;
}

Box everywhere() {
  return Box(Eigen::Vector3d::Constant(-100.0), Eigen::Vector3d::Constant(100.0));
}

TEST(VoxelFaces, OneVoxelIsACubeWithSharedCorners) {
  StateGrid grid = gridOf({5, 4, 3}, VoxelState::Free);
  grid.set({2, 1, 1}, VoxelState::Occupied);
  const FaceMesh mesh = extractFaces(grid, VoxelState::Occupied, FaceRule::TowardOther, everywhere());
  EXPECT_EQ(mesh.quads.size(), 6u);
  ASSERT_EQ(mesh.corners.size(), 8u);
  for (const Eigen::Vector3f& corner : mesh.corners) {
    EXPECT_NEAR((corner - Eigen::Vector3f(0.2f, 0.1f, 0.1f)).cwiseAbs().maxCoeff(), 0.05f, 1e-6f);
  }
}

TEST(VoxelFaces, FacesLookOutward) {
  StateGrid grid = gridOf({3, 3, 3}, VoxelState::Free);
  grid.set({1, 1, 1}, VoxelState::Occupied);
  const FaceMesh mesh = extractFaces(grid, VoxelState::Occupied, FaceRule::TowardOther, everywhere());
  ASSERT_EQ(mesh.quads.size(), 6u);
  for (const auto& quad : mesh.quads) {
    const Eigen::Vector3f a = mesh.corners[quad[0]], b = mesh.corners[quad[1]], c = mesh.corners[quad[2]];
    const Eigen::Vector3f center = (a + c) / 2 - Eigen::Vector3f::Constant(0.1f);
    EXPECT_GT((b - a).cross(c - b).dot(center), 0.0f);
  }
}

TEST(VoxelFaces, NeighboursHideTheFaceBetweenThem) {
  StateGrid grid = gridOf({6, 3, 4}, VoxelState::Free);
  grid.set({2, 1, 1}, VoxelState::Occupied);
  grid.set({2, 1, 2}, VoxelState::Occupied);
  const FaceMesh mesh = extractFaces(grid, VoxelState::Occupied, FaceRule::TowardOther, everywhere());
  EXPECT_EQ(mesh.quads.size(), 10u);
  EXPECT_EQ(mesh.corners.size(), 12u);
}

TEST(VoxelFaces, FrontierLiesBetweenUnknownAndFreeOnly) {
  StateGrid grid = gridOf({8, 3, 3}, VoxelState::Occupied);
  for (int i = 0; i < 8; ++i) grid.set({i, 1, 1}, i == 3 ? VoxelState::Free : VoxelState::Unknown);
  const FaceMesh mesh = extractFaces(grid, VoxelState::Unknown, FaceRule::TowardFree, everywhere());
  EXPECT_EQ(mesh.quads.size(), 2u);
}

TEST(VoxelFaces, FrontierIsClippedToTheWorkspace) {
  StateGrid grid = gridOf({10, 10, 10}, VoxelState::Unknown);
  for (int j = 0; j < 10; ++j) {
    for (int i = 0; i < 10; ++i) grid.set({i, j, 9}, VoxelState::Free);
  }
  EXPECT_EQ(extractFaces(grid, VoxelState::Unknown, FaceRule::TowardFree, everywhere()).quads.size(), 100u);
  const Box workspace(Eigen::Vector3d(0.15, 0.25, 0.0), Eigen::Vector3d(0.55, 0.45, 2.0));
  const FaceMesh mesh = extractFaces(grid, VoxelState::Unknown, FaceRule::TowardFree, workspace);
  EXPECT_EQ(mesh.quads.size(), 4u * 2u);
  for (const Eigen::Vector3f& corner : mesh.corners) {
    EXPECT_GE(corner.x(), 0.15f - 1e-5f);
    EXPECT_LE(corner.x(), 0.55f + 1e-5f);
    EXPECT_GE(corner.y(), 0.25f - 1e-5f);
    EXPECT_LE(corner.y(), 0.45f + 1e-5f);
  }
}

TEST(VoxelFaces, NothingComesFromNothing) {
  EXPECT_TRUE(extractFaces(StateGrid(), VoxelState::Unknown, FaceRule::TowardFree, everywhere()).empty());
  EXPECT_TRUE(extractFaces(gridOf({3, 3, 3}, VoxelState::Free), VoxelState::Occupied, FaceRule::TowardOther,
                           everywhere())
                  .empty());
  EXPECT_TRUE(extractFaces(gridOf({3, 3, 3}, VoxelState::Occupied), VoxelState::Occupied,
                           FaceRule::TowardOther, Box())
                  .empty());
}

TEST(VoxelFaces, AgreesWithPlainCountingOnRandomGrids) {
  std::mt19937 random(7);
  for (int round = 0; round < 8; ++round) {
    const Eigen::Vector3i size(5 + round, 9, 4 + round % 3);
    StateGrid grid = gridOf(size, VoxelState::Unknown);
    for (std::size_t v = 0; v < grid.geometry().count(); ++v) {
      grid.set(grid.geometry().voxel(v), static_cast<VoxelState>(random() % 3));
    }
    std::size_t faces = 0;
    std::set<std::array<int, 3>> corners;
    for (std::size_t index = 0; index < grid.geometry().count(); ++index) {
      const Eigen::Vector3i v = grid.geometry().voxel(index);
      if (grid.at(v) != VoxelState::Unknown) continue;
      for (int side = 0; side < 6; ++side) {
        Eigen::Vector3i n = v;
        n[side / 2] += side % 2 ? 1 : -1;
        if (!grid.geometry().contains(n) || grid.at(n) != VoxelState::Free) continue;
        ++faces;
        for (int c = 0; c < 4; ++c) {
          Eigen::Vector3i corner = v;
          corner[side / 2] += side % 2;
          corner[(side / 2 + 1) % 3] += c & 1;
          corner[(side / 2 + 2) % 3] += c >> 1;
          corners.insert({corner.x(), corner.y(), corner.z()});
        }
      }
    }
    ASSERT_GT(faces, 0u);
    const FaceMesh mesh = extractFaces(grid, VoxelState::Unknown, FaceRule::TowardFree, everywhere());
    EXPECT_EQ(mesh.quads.size(), faces);
    EXPECT_EQ(mesh.corners.size(), corners.size());
  }
}

TEST(FacesOf, TouchingVoxelsShareCornersAndHaveNoFaceBetweenThem) {
  const GridGeometry grid{{0.0, 0.0, 0.0}, 0.1, {4, 4, 4}};
  const std::vector<std::size_t> voxels = {grid.index(1, 1, 1), grid.index(2, 1, 1)};
  const FaceMesh mesh = facesOf(grid, voxels);
  EXPECT_EQ(mesh.quads.size(), 10u);
  EXPECT_EQ(mesh.corners.size(), 12u);
  EXPECT_EQ(edgesOf(mesh).size(), 20u);
  EXPECT_TRUE(facesOf(grid, {}).empty());
}

TEST(FacesOf, AgreesWithExtractedFacesOnRandomGrids) {
  std::mt19937 random(7);
  for (int round = 0; round < 20; ++round) {
    StateGrid grid = gridOf({6, 5, 7}, VoxelState::Free);
    std::vector<std::size_t> voxels;
    for (std::size_t i = 0; i < grid.geometry().count(); ++i) {
      if (random() % 3) continue;
      grid.set(grid.geometry().voxel(i), VoxelState::Unknown);
      voxels.push_back(i);
    }
    ASSERT_FALSE(voxels.empty());
    const FaceMesh expected = extractFaces(grid, VoxelState::Unknown, FaceRule::TowardOther, everywhere());
    const FaceMesh mesh = facesOf(grid.geometry(), voxels);
    EXPECT_EQ(mesh.quads.size(), expected.quads.size());
    EXPECT_EQ(mesh.corners.size(), expected.corners.size());
    EXPECT_EQ(edgesOf(mesh).size(), edgesOf(expected).size());
  }
}

}  // namespace
}  // namespace vantage
