#include "core/raycasting/volume_caster.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "tests/core/raycasting/random_scene.h"

namespace vantage {
namespace {

PinholeCamera smallCamera() {
  PinholeCamera camera;
  camera.width = 32;
  camera.height = 24;
  camera.fx = camera.fy = 22.0;
  camera.cx = 15.5;
  camera.cy = 11.5;
  camera.min_range_m = 0.03;
  camera.max_range_m = 0.7;
  return camera;
}

/// Where a ray enters and leaves the box of a voxel; first > second if it misses it.
std::pair<double, double> crossing(const GridGeometry& g, const Eigen::Vector3i& voxel,
                                   const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d center = g.center(voxel), half = Eigen::Vector3d::Constant(g.voxel_size_m / 2);
  const Eigen::Array3d a = (center - half - origin).array() / direction.array();
  const Eigen::Array3d b = (center + half - origin).array() / direction.array();
  return {std::max(a.min(b).maxCoeff(), 0.0), a.max(b).minCoeff()};
}

/// Every voxel against every ray.
VisibilityCounts byBoxes(const StateGrid& grid, const PinholeCamera& camera, const Pose& pose,
                         const VisibilityQuery& query) {
  const GridGeometry& g = grid.geometry();
  const auto inRegion = [&](const Eigen::Vector3d& p) {
    return (!query.sphere || (p - query.sphere->center).norm() <= query.sphere->radius) &&
           (!query.bounds || query.bounds->contains(p));
  };
  VisibilityCounts counts;
  std::set<std::size_t> seen;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      ++counts.rays;
      const Eigen::Vector3d along = (pose.linear() * camera.ray(u, v)).normalized();
      double end = camera.max_range_m;
      std::optional<std::size_t> wall;
      std::vector<std::pair<double, std::size_t>> unknown;
      for (std::size_t n = 0; n < g.count(); ++n) {
        const VoxelState state = grid.at(g.voxel(n));
        if (state == VoxelState::Free) continue;
        const auto [in, out] = crossing(g, g.voxel(n), pose.translation(), along);
        if (in > out || in > camera.max_range_m) continue;
        if (state == VoxelState::Unknown) unknown.emplace_back(in, n);
        if (state != VoxelState::Occupied || in >= end) continue;
        end = in;
        wall = n;
      }
      bool meets = false;
      for (const auto& [in, n] : unknown) {
        if (in >= end || in < camera.min_range_m || !inRegion(g.center(g.voxel(n)))) continue;
        seen.insert(n);
        meets = true;
      }
      counts.unknown += meets;
      counts.occupied += wall && end >= camera.min_range_m && inRegion(g.center(g.voxel(*wall)));
    }
  counts.unknown_voxels = seen.size();
  return counts;
}

TEST(CastThroughUnknown, AgreesWithEveryVoxelAgainstEveryRayOnRandomScenes) {
  std::mt19937_64 random(5);
  const PinholeCamera camera = smallCamera();
  std::uint64_t met = 0;
  for (int n = 0; n < 60; ++n) {
    const StateGrid grid = testing::randomGrid(random, {17, 14, 15}, 0.02);
    const Pose pose = testing::randomPose(random, grid.geometry().bounds());
    VisibilityQuery query;
    if (n % 3 == 1) query.sphere = Sphere{grid.geometry().bounds().center(), 0.1};
    if (n % 3 == 2) query.bounds = Box(grid.geometry().bounds().min(), grid.geometry().bounds().center());
    const VisibilityCounts counts = castThroughUnknown(grid, camera, pose, query);
    const VisibilityCounts boxes = byBoxes(grid, camera, pose, query);
    // Rays through an edge fall to either side by rounding.
    EXPECT_NEAR(double(counts.unknown_voxels), double(boxes.unknown_voxels), 2.0) << n;
    EXPECT_NEAR(double(counts.unknown), double(boxes.unknown), 2.0) << n;
    EXPECT_NEAR(double(counts.occupied), double(boxes.occupied), 2.0) << n;
    EXPECT_EQ(counts.rays, boxes.rays);
    met += counts.unknown_voxels;
  }
  EXPECT_GT(met, 500u);
}

TEST(CastThroughUnknown, EqualsFirstHitsWhereThereIsNothingUnknown) {
  std::mt19937_64 random(6);
  const PinholeCamera camera = smallCamera();
  std::uint64_t occupied = 0;
  for (int n = 0; n < 20; ++n) {
    StateGrid grid = testing::randomGrid(random, {30, 25, 20}, 0.02);
    const GridGeometry& g = grid.geometry();
    for (std::size_t i = 0; i < g.count(); ++i)
      if (grid.at(g.voxel(i)) == VoxelState::Unknown) grid.set(g.voxel(i), VoxelState::Free);
    grid.rebuildFreeRadius();
    const Pose pose = testing::randomPose(random, g.bounds());
    const VisibilityCounts through = castThroughUnknown(grid, camera, pose, {});
    EXPECT_EQ(through.occupied, castUniform(grid, camera, pose, {}).occupied);
    EXPECT_EQ(through.unknown, 0u);
    occupied += through.occupied;
  }
  EXPECT_GT(occupied, 500u);
}

/// Acceptance check 12.4: everything from 0.8 m on is unknown; here up to 1.0 m.
TEST(CastThroughUnknown, SeesAboutOnePointThreeMillionVoxelsInASlabOfTwentyCentimetres) {
  constexpr double kVoxel = 3.0 / 512;
  GridGeometry g;
  g.voxel_size_m = kVoxel;
  g.size = {260, 220, 174};  // 34 layers of 0.2 m behind 140 free ones
  g.origin_m = {-129.5 * kVoxel, -109.5 * kVoxel, 0.8 + (0.5 - 140) * kVoxel};
  StateGrid grid(g);
  for (std::size_t i = 0; i < g.count(); ++i)
    if (g.voxel(i).z() < 140) grid.set(g.voxel(i), VoxelState::Free);
  grid.rebuildFreeRadius();
  const VisibilityCounts counts = castThroughUnknown(grid, PinholeCamera{}, Pose::Identity(), {});
  EXPECT_EQ(counts.unknown, 217088u);
  EXPECT_NEAR(static_cast<double>(counts.unknown_voxels), 1.31e6, 0.02e6);
}

TEST(CastThroughUnknown, CountsNothingFromFarAway) {
  std::mt19937_64 random(7);
  const StateGrid grid = testing::randomGrid(random, {9, 9, 9}, 0.02);
  Pose away = Pose::Identity();
  away.translation().x() = std::numeric_limits<double>::max() / 4;
  const VisibilityCounts counts = castThroughUnknown(grid, smallCamera(), away, {});
  EXPECT_EQ(counts.rays, 32u * 24u);
  EXPECT_EQ(counts.unknown_voxels + counts.unknown + counts.occupied, 0u);
}

}  // namespace
}  // namespace vantage
