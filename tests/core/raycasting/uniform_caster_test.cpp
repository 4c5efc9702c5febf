#include "core/raycasting/uniform_caster.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/geometry/depth_image.h"
#include "core/raycasting/bundle.h"
#include "tests/core/raycasting/random_scene.h"

namespace vantage {
namespace {

using testing::randomGrid;
using testing::randomPose;

PinholeCamera smallCamera() {
  PinholeCamera camera;
  camera.width = 42;
  camera.height = 30;
  camera.fx = camera.fy = 25.0;
  camera.cx = 20.5;
  camera.cy = 14.5;
  camera.min_range_m = 0.04;
  camera.max_range_m = 0.6;
  return camera;
}

/// Queries that use every field.
std::vector<VisibilityQuery> queries(const GridGeometry& g) {
  std::vector<VisibilityQuery> all(1);
  VisibilityQuery q;
  q.sphere = Sphere{g.bounds().center(), 0.15};
  q.distinct_voxels = true;
  q.histogram_bins = 20;
  q.histogram_start_m = 0.05;
  all.push_back(q);
  q.outside = OutsideUnknown::Transparent;
  all.push_back(q);
  q.bounds = Box(g.bounds().center() - Eigen::Vector3d(0.2, 0.1, 0.1), g.bounds().center());
  all.push_back(q);
  q.sphere.reset();
  all.push_back(q);
  q.outside = OutsideUnknown::Opaque;
  all.push_back(q);
  return all;
}

void expectEqual(const VisibilityCounts& a, const VisibilityCounts& b) {
  EXPECT_EQ(a.unknown, b.unknown);
  EXPECT_EQ(a.occupied, b.occupied);
  EXPECT_EQ(a.rays, b.rays);
  EXPECT_EQ(a.visited, b.visited);
  EXPECT_EQ(a.unknown_voxels, b.unknown_voxels);
  EXPECT_EQ(a.occupied_voxels, b.occupied_voxels);
  EXPECT_EQ(a.histogram, b.histogram);
}

/// Compares every path with the plain walk; returns the hits seen.
std::uint64_t comparePaths(const StateGrid& grid, const PinholeCamera& camera, const Pose& pose) {
  std::uint64_t hits = 0;
  for (const VisibilityQuery& query : queries(grid.geometry())) {
    const VisibilityCounts plain = castUniformReference(grid, camera, pose, query);
    hits += plain.unknown + plain.occupied;
    for (const CpuPath path : availableCpuPaths()) {
      SCOPED_TRACE(static_cast<int>(path));
      expectEqual(
          casting::castRectangle(path, grid, camera, pose, query, {0, 0, camera.width, camera.height}),
          plain);
    }
  }
  return hits;
}

TEST(UniformCaster, EveryPathAgreesWithThePlainWalkOnRandomGrids) {
  std::mt19937_64 random(7);
  std::uint64_t hits = 0;
  for (int n = 0; n < 60; ++n) {
    SCOPED_TRACE(n);
    const Eigen::Vector3i size(20 + random() % 60, 20 + random() % 40, 20 + random() % 50);
    const StateGrid grid = randomGrid(random, size, 0.01);
    for (int m = 0; m < 4; ++m)
      hits += comparePaths(grid, smallCamera(), randomPose(random, grid.geometry().bounds()));
  }
  EXPECT_GT(hits, 10000u);
}

TEST(UniformCaster, EveryPathAgreesWithThePlainWalkOnRaysThatStartOnPlanesAndRunAlongAxes) {
  std::mt19937_64 random(8);
  std::uint64_t hits = 0;
  PinholeCamera camera = smallCamera();
  camera.width = 33;
  camera.height = 31;
  camera.cx = 16;  // a ray along the axis, and many through edges and corners
  camera.cy = 15;
  camera.fx = camera.fy = 8;
  camera.min_range_m = 0.0;
  const Eigen::Vector3d axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0},
                                  {0, 0, 1}, {0, 0, -1}, {1, 1, 0}};
  for (int n = 0; n < 12; ++n) {
    SCOPED_TRACE(n);
    StateGrid random_grid = randomGrid(random, {40, 37, 45}, 0.0078125);
    GridGeometry g = random_grid.geometry();
    g.origin_m = Eigen::Vector3d::Constant(-0.5 * g.voxel_size_m);  // planes at exact numbers
    StateGrid grid(g);
    for (std::size_t i = 0; i < g.count(); ++i) grid.set(g.voxel(i), random_grid.at(g.voxel(i)));
    grid.rebuildFreeRadius();
    for (const Eigen::Vector3d& axis : axes)
      for (const int at : {0, 5, 20, 40, -3}) {
        const Eigen::Vector3d eye = Eigen::Vector3d(at, 20, 12) * g.voxel_size_m;
        hits += comparePaths(grid, camera, lookAlong(eye, axis));
      }
  }
  EXPECT_GT(hits, 20000u);
}

TEST(UniformCaster, QuarterTurnsAgreeExactlyWithPlainWalksOfTheSameRays) {
  std::mt19937_64 random(9);
  for (int n = 0; n < 20; ++n) {
    const StateGrid grid = randomGrid(random, {70, 50, 60}, 0.01);
    const Pose pose = randomPose(random, grid.geometry().bounds());
    PinholeCamera camera = smallCamera();
    if (n % 2) std::swap(camera.width, camera.height), std::swap(camera.cx, camera.cy);
    PinholeCamera turned = camera;
    std::swap(turned.width, turned.height);
    std::swap(turned.cx, turned.cy);
    for (const VisibilityQuery& query : queries(grid.geometry())) {
      const QuarterTurnCounts shared = castQuarterTurns(grid, camera, pose, query);
      expectEqual(shared.upright, castUniformReference(grid, camera, pose, query));
      expectEqual(shared.sideways, castUniformReference(grid, turned, pose, query));
      EXPECT_EQ(shared.rays_cast, 2u * 42 * 30 - 30 * 30);
    }
  }
}

TEST(UniformCaster, QuarterTurnsAgreeWithRolledPosesUpToRounding) {
  std::mt19937_64 random(10);
  const double quarter = std::numbers::pi / 2;
  std::uint64_t total = 0, difference = 0;
  for (int n = 0; n < 20; ++n) {
    const StateGrid grid = randomGrid(random, {70, 50, 60}, 0.01);
    const Pose pose = randomPose(random, grid.geometry().bounds());
    const VisibilityQuery query;
    const QuarterTurnCounts shared = castQuarterTurns(grid, smallCamera(), pose, query);
    for (int turn = 0; turn < 4; ++turn) {
      const Pose rolled = pose * Eigen::AngleAxisd(turn * quarter, Eigen::Vector3d::UnitZ());
      const std::uint64_t own = castUniform(grid, smallCamera(), rolled, query).unknown;
      const std::uint64_t both = turn % 2 ? shared.sideways.unknown : shared.upright.unknown;
      difference += own > both ? own - both : both - own;
      total += own;
    }
  }
  EXPECT_GT(total, 1000u);
  EXPECT_LE(difference, 5u);
}

TEST(UniformCaster, HistogramSumsToTheGainOfEverySphere) {
  std::mt19937_64 random(11);
  const StateGrid grid = randomGrid(random, {70, 50, 60}, 0.01);
  VisibilityQuery query;
  query.sphere = Sphere{grid.geometry().bounds().center(), 0.1};
  query.histogram_bins = 40;
  const Pose pose =
      lookAlong(grid.geometry().bounds().center() - Eigen::Vector3d(0.3, 0.02, 0.01), {1, 0, 0});
  const VisibilityCounts counts = castUniform(grid, smallCamera(), pose, query);
  std::uint64_t sum = 0;
  for (int k = 0; k < query.histogram_bins; ++k) {
    sum += counts.histogram[k];
    VisibilityQuery one;
    one.sphere = Sphere{query.sphere->center, k * 0.01};
    EXPECT_EQ(castUniform(grid, smallCamera(), pose, one).unknown, sum);
  }
  EXPECT_GT(sum, 0u);
}

TEST(UniformCaster, RayFromAnUnknownVoxelEndsThereAndCountsNothing) {
  GridGeometry g;
  g.size = {20, 20, 20};
  const StateGrid grid(g);
  const VisibilityCounts counts =
      castUniform(grid, smallCamera(), lookAlong(g.bounds().center(), {1, 0, 0}), {});
  EXPECT_EQ(counts.unknown, 0u);
  EXPECT_EQ(counts.rays, 42u * 30u);
  EXPECT_EQ(counts.visited, counts.rays);
}

TEST(UniformCaster, RaysThatMissTheGridVisitNothing) {
  GridGeometry g;
  g.size = {20, 20, 20};
  const StateGrid grid(g);
  const Eigen::Vector3d outside = g.bounds().max() + Eigen::Vector3d::Constant(0.1);
  EXPECT_EQ(castUniform(grid, smallCamera(), lookAlong(outside, {1, 1, 1}), {}).visited, 0u);
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Constant(DepthImage::kInvalid);
  EXPECT_EQ(castUniform(grid, smallCamera(), lookAlong(nowhere, {1, 1, 1}), {}).visited, 0u);
}

TEST(UniformCaster, CastRayFindsTheEntryIntoAVoxel) {
  GridGeometry g;
  g.size = {30, 30, 30};
  StateGrid grid(g);
  for (std::size_t i = 0; i < g.count(); ++i) grid.set(g.voxel(i), VoxelState::Free);
  grid.set({20, 10, 10}, VoxelState::Occupied);
  grid.rebuildFreeRadius();
  const auto hit = castRay(grid, g.center({5, 10, 10}), {2, 0, 0}, 1.0);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->voxel, Eigen::Vector3i(20, 10, 10));
  EXPECT_NEAR(hit->length_m, 0.145, 1e-12);
  EXPECT_EQ(hit->state, VoxelState::Occupied);
  EXPECT_FALSE(castRay(grid, g.center({5, 10, 10}), {2, 0, 0}, 0.144));
  EXPECT_FALSE(castRay(grid, g.center({5, 11, 10}), {1, 0, 0}, 1.0));
  EXPECT_TRUE(castRay(grid, g.center({40, 10, 10}), {-1, 0, 0}, 1.0));
}

}  // namespace
}  // namespace vantage
