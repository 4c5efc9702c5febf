#include "viewer/merged_faces.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <map>
#include <random>
#include <set>

namespace vantage {
namespace {

StateGrid gridOf(const Eigen::Vector3i& size, VoxelState fill) {
  StateGrid grid(GridGeometry{{0.5, 0.5, 0.5}, 1.0, size});  // corners are whole numbers
  for (std::size_t v = 0; v < grid.geometry().count(); ++v) grid.set(grid.geometry().voxel(v), fill);
  return grid;
}

StateGrid randomGrid(unsigned seed, int states) {
  std::mt19937 random(seed);
  StateGrid grid = gridOf({7, 6, 5}, VoxelState::Free);
  for (std::size_t v = 0; v < grid.geometry().count(); ++v)
    grid.set(grid.geometry().voxel(v), static_cast<VoxelState>(random() % states));
  return grid;
}

Box everywhere() {
  return Box(Eigen::Vector3d::Constant(-100.0), Eigen::Vector3d::Constant(100.0));
}

using Corner = std::array<float, 3>;

Corner keyOf(const Eigen::Vector3f& p) {
  return {p.x(), p.y(), p.z()};
}

Eigen::Vector3f normalOf(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  return (b - a).cross(c - a);
}

/// Area by outward direction (2 * axis + sign) and plane.
using Areas = std::map<std::pair<int, float>, double>;

void addArea(Areas& areas, const Eigen::Vector3f& a, const Eigen::Vector3f& normal, double area) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  areas[{2 * axis + (normal[axis] > 0.0f), a[axis]}] += area;
}

TEST(MergedFaces, APlateIsSixRectangles) {
  StateGrid grid = gridOf({12, 9, 4}, VoxelState::Free);
  for (int i = 2; i < 9; ++i)
    for (int j = 1; j < 6; ++j) grid.set({i, j, 2}, VoxelState::Occupied);
  const MergedFaces merged =
      extractMergedFaces(grid, VoxelState::Occupied, FaceRule::TowardOther, everywhere());
  EXPECT_EQ(merged.faces, 2u * 35u + 2u * 7u + 2u * 5u);
  EXPECT_EQ(merged.rectangles, 6u);
  EXPECT_EQ(merged.triangles.size(), 12u);
  EXPECT_EQ(merged.corners.size(), 8u);
}

TEST(MergedFaces, CoverWhatSingleFacesCover) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const StateGrid grid = randomGrid(seed, seed % 2 ? 2 : 3);
    for (const auto& [of, rule] : {std::pair{VoxelState::Occupied, FaceRule::TowardOther},
                                   {VoxelState::Unknown, FaceRule::TowardFree}}) {
      const FaceMesh single = extractFaces(grid, of, rule, everywhere());
      const MergedFaces merged = extractMergedFaces(grid, of, rule, everywhere());
      EXPECT_EQ(merged.faces, single.quads.size());
      EXPECT_LE(merged.rectangles, merged.faces);
      Areas expected, found;
      for (const auto& quad : single.quads) {
        const Eigen::Vector3f& a = single.corners[quad[0]];
        addArea(expected, a, normalOf(a, single.corners[quad[1]], single.corners[quad[2]]), 1.0);
      }
      for (const auto& triangle : merged.triangles) {
        const Eigen::Vector3f& a = merged.corners[triangle[0]];
        const Eigen::Vector3f n = normalOf(a, merged.corners[triangle[1]], merged.corners[triangle[2]]);
        EXPECT_GT(n.norm(), 0.1f) << "no empty triangles";
        addArea(found, a, n, n.norm() / 2);
      }
      ASSERT_EQ(found.size(), expected.size());
      for (const auto& [plane, area] : expected) EXPECT_NEAR(found[plane], area, 1e-3);
    }
  }
}

TEST(MergedFaces, HaveNoCracks) {
  // Watertight: every edge of a closed surface is walked as often in one direction as in the other, with the
  // same vertices; a corner that lies inside another triangle's edge would break that.
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const StateGrid grid = randomGrid(seed, 2);
    const MergedFaces merged =
        extractMergedFaces(grid, VoxelState::Unknown, FaceRule::TowardOther, everywhere());
    ASSERT_FALSE(merged.empty());
    std::map<std::pair<Corner, Corner>, int> balance;
    for (const auto& triangle : merged.triangles) {
      for (int c = 0; c < 3; ++c) {
        const Corner from = keyOf(merged.corners[triangle[c]]),
                     to = keyOf(merged.corners[triangle[(c + 1) % 3]]);
        from < to ? ++balance[{from, to}] : --balance[{to, from}];
      }
    }
    for (const auto& [edge, count] : balance) EXPECT_EQ(count, 0);
  }
}

TEST(MergedFaces, CornersAreSharedAndUsed) {
  const StateGrid grid = randomGrid(5, 3);
  const MergedFaces merged =
      extractMergedFaces(grid, VoxelState::Occupied, FaceRule::TowardOther, everywhere());
  std::set<Corner> places;
  for (const Eigen::Vector3f& corner : merged.corners) places.insert(keyOf(corner));
  EXPECT_EQ(places.size(), merged.corners.size());
  std::set<std::uint32_t> used;
  for (const auto& triangle : merged.triangles) used.insert(triangle.begin(), triangle.end());
  EXPECT_EQ(used.size(), merged.corners.size());
}

TEST(MergedFaces, AreClippedAndEmptyLikeSingleFaces) {
  const StateGrid grid = randomGrid(9, 3);
  const Box part(Eigen::Vector3d(1.0, 2.0, 0.0), Eigen::Vector3d(5.0, 4.0, 3.0));
  EXPECT_EQ(extractMergedFaces(grid, VoxelState::Occupied, FaceRule::TowardOther, part).faces,
            extractFaces(grid, VoxelState::Occupied, FaceRule::TowardOther, part).quads.size());
  EXPECT_TRUE(extractMergedFaces(StateGrid(), VoxelState::Occupied, FaceRule::TowardOther, part).empty());
  EXPECT_TRUE(extractMergedFaces(grid, VoxelState::Occupied, FaceRule::TowardOther, Box()).empty());
}

TEST(MergedFaces, DoNotDependOnTheNumberOfThreads) {
  const StateGrid grid = randomGrid(4, 3);
  const auto extract = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return extractMergedFaces(grid, VoxelState::Occupied, FaceRule::TowardOther, everywhere());
  };
  const MergedFaces one = extract(1), two = extract(2);
  EXPECT_EQ(one.triangles, two.triangles);
  EXPECT_EQ(one.corners.size(), two.corners.size());
}

}  // namespace
}  // namespace vantage
