#include "core/raycasting/first_hits.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace vantage {
namespace {

StateGrid randomGrid(std::mt19937& random) {
  StateGrid grid(GridGeometry{{-0.5, -0.5, -0.5}, 0.05, {24, 20, 22}});
  for (std::size_t v = 0; v < grid.geometry().count(); ++v) {
    const unsigned dice = random() % 40;
    grid.set(grid.geometry().voxel(v), dice == 0   ? VoxelState::Occupied
                                       : dice == 1 ? VoxelState::Unknown
                                                   : VoxelState::Free);
  }
  grid.rebuildFreeRadius();
  return grid;
}

Pose randomPose(std::mt19937& random) {
  std::uniform_real_distribution<double> at(-1.0, 1.0);
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(at(random), at(random), at(random));
  pose.rotate(Eigen::AngleAxisd(3.0 * at(random),
                                Eigen::Vector3d(at(random), at(random), at(random) + 1e-3).normalized()));
  return pose;
}

TEST(FirstHits, AreThoseThatTheCasterCounts) {
  std::mt19937 random(23);
  PinholeCamera camera = cameraFromFov(40, 30, 1.2);
  camera.min_range_m = 0.2;
  camera.max_range_m = 1.5;
  std::uint64_t seen = 0, near = 0;
  for (int round = 0; round < 30; ++round) {
    const StateGrid grid = randomGrid(random);
    const Pose pose = randomPose(random);
    VisibilityQuery query;
    query.sphere = Sphere{{0.1, 0.0, 0.1}, 0.35};
    query.distinct_voxels = true;
    query.outside = round % 2 ? OutsideUnknown::Opaque : OutsideUnknown::Transparent;
    const VisibilityCounts expected = castUniform(grid, camera, pose, query);
    std::uint64_t unknown = 0, occupied = 0;
    std::set<std::size_t> voxels;
    for (const FirstHit& hit : firstHits(grid, camera, pose, query)) {
      EXPECT_EQ(grid.states()[hit.voxel], static_cast<std::uint8_t>(hit.state));
      EXPECT_NE(hit.state, VoxelState::Free);
      near += hit.too_near;
      if (!hit.counts) continue;
      EXPECT_FALSE(hit.too_near);
      ++(hit.state == VoxelState::Unknown ? unknown : occupied);
      if (hit.state == VoxelState::Unknown) voxels.insert(hit.voxel);
    }
    EXPECT_EQ(unknown, expected.unknown);
    EXPECT_EQ(occupied, expected.occupied);
    EXPECT_EQ(voxels.size(), expected.unknown_voxels);
    seen += unknown;
  }
  EXPECT_GT(seen, 100u);
  EXPECT_GT(near, 10u);
}

TEST(FirstHits, NothingIsHitInNoGrid) {
  EXPECT_TRUE(firstHits(StateGrid(), PinholeCamera(), Pose::Identity(), {}).empty());
}

}  // namespace
}  // namespace vantage
