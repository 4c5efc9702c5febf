#include "core/raycasting/hierarchical_caster.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <map>
#include <numbers>

#include "core/raycasting/hierarchical_view.h"
#include "tests/core/raycasting/random_scene.h"
#include "tests/core/raycasting/toy_scene.h"

namespace vantage {

void PrintTo(const RayCounts& c, std::ostream* out) {
  *out << "unknown " << c.unknown << " occupied " << c.occupied << " scene " << c.unknown_scene << " rays "
       << c.rays << " cast " << c.rays_cast << " finest " << c.finest_rays_cast << " visited " << c.visited
       << " voxels " << c.unknown_voxels << " / " << c.occupied_voxels
       << (c.sensor_blocked ? " blocked" : "");
}

namespace {

using testing::randomGrid;
using testing::randomPose;
using testing::randomSensor;

constexpr double kVoxel = 0.01;

/// Queries that use every field, in both modes.
std::vector<HierarchicalQuery> queries(const Box& grid) {
  std::vector<HierarchicalQuery> all;
  for (const ChildStart start : {ChildStart::Resume, ChildStart::Restart}) {
    HierarchicalQuery q;
    q.start = start;
    all.push_back(q);
    q.bounds = Box(grid.center() - 0.3 * grid.sizes(), grid.center() + Eigen::Vector3d(0.113, 0.07, 0.1));
    q.distinct_voxels = true;
    all.push_back(q);
    q.refine_unknown = true;
    all.push_back(q);
    q.sphere = Sphere{grid.center(), 0.15};
    all.push_back(q);
    q.bounds.reset();
    q.refine_unknown = false;
    all.push_back(q);
  }
  return all;
}

/// A random grid with more single voxels.
StateGrid crowdedGrid(std::mt19937_64& random, const Eigen::Vector3i& size) {
  StateGrid grid = randomGrid(random, size, kVoxel);
  for (int n = 0; n < 12; ++n) {
    const Eigen::Vector3i v(random() % size.x(), random() % size.y(), random() % size.z());
    grid.set(v, n % 2 ? VoxelState::Unknown : VoxelState::Occupied);
  }
  grid.rebuildFreeRadius();
  return grid;
}

TEST(HierarchicalCaster, EveryPathAgreesWithThePlainRecursionOnRandomMaps) {
  std::mt19937_64 random(31);
  std::uint64_t unknown = 0, occupied = 0, scene = 0;
  int blocked = 0, views = 0;
  for (int n = 0; n < 40; ++n) {
    SCOPED_TRACE(n);
    const Eigen::Vector3i size(20 + random() % 60, 20 + random() % 40, 20 + random() % 50);
    const Eigen::Vector3i first(random() % 40, random() % 40, random() % 40);
    StateGrid grid = crowdedGrid(random, size);
    const Pose pose = randomPose(random, grid.geometry().bounds());
    const Eigen::Vector3i own = grid.geometry().voxelAt(pose.translation());
    if (n % 8 == 0 && grid.geometry().contains(own)) grid.set(own, VoxelState::Unknown);
    grid.rebuildFreeRadius();
    const StatePyramid pyramid(std::move(grid), first - Eigen::Vector3i::Constant(20), 4);
    const RaySensor sensor = randomSensor(random, 0.4);
    const RayTree tree(sensor, kVoxel, std::min(4, maxCoarseLevels(sensor, kVoxel)));
    for (const HierarchicalQuery& query : queries(pyramid.finest().geometry().bounds()))
      for (int m = 0; m <= tree.coarseLevels(); ++m) {
        const RayCounts plain = castHierarchicalReference(pyramid, tree, m, pose, query);
        unknown += plain.unknown, occupied += plain.occupied, scene += plain.unknown_scene;
        blocked += plain.sensor_blocked, ++views;
        for (const CpuPath path : availableCpuPaths())
          EXPECT_EQ(casting::castHierarchicalOn(path, pyramid, tree, m, pose, query), plain);
      }
  }
  EXPECT_GT(unknown, 100000u);
  EXPECT_GT(occupied, 50000u);
  EXPECT_GT(scene, 10000u);
  EXPECT_GT(blocked, 0);
  EXPECT_LT(blocked, views / 2);
}

TEST(HierarchicalCaster, EveryPathAgreesWithThePlainRecursionOnRaysThatStartOnPlanesAndRunAlongAxes) {
  std::mt19937_64 random(32);
  constexpr double kExact = 0.0078125;
  RaySensor sensor;
  sensor.horizontal_fov_rad = sensor.vertical_fov_rad = std::numbers::pi / 2;
  sensor.min_range_m = 0.0;
  sensor.max_range_m = 0.5;
  const RayTree tree(sensor, kExact, 3);
  std::uint64_t hits = 0;
  for (int n = 0; n < 8; ++n) {
    const StateGrid source = randomGrid(random, {40, 37, 45}, kExact);
    GridGeometry g = source.geometry();
    g.origin_m = Eigen::Vector3d::Constant(-0.5 * kExact);  // planes at exact numbers
    StateGrid grid(g);
    for (std::size_t i = 0; i < g.count(); ++i) grid.set(g.voxel(i), source.at(g.voxel(i)));
    grid.rebuildFreeRadius();
    const StatePyramid pyramid(std::move(grid), Eigen::Vector3i::Constant(n), 3);
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 0, 1)})
      for (const int at : {0, 8, 20, 40, -3})
        for (const ChildStart start : {ChildStart::Resume, ChildStart::Restart}) {
          HierarchicalQuery query;
          query.start = start;
          const Pose pose = lookAlong(Eigen::Vector3d(at, 20, 12) * kExact, axis);
          for (int m = 0; m <= 3; ++m) {
            const RayCounts plain = castHierarchicalReference(pyramid, tree, m, pose, query);
            hits += plain.occupied + plain.unknown;
            for (const CpuPath path : availableCpuPaths())
              EXPECT_EQ(casting::castHierarchicalOn(path, pyramid, tree, m, pose, query), plain);
          }
        }
  }
  EXPECT_GT(hits, 100000u);
}

TEST(HierarchicalCaster, NoCoarseLevelsAreUniformRayTracing) {
  std::mt19937_64 random(33);
  std::uint64_t hits = 0;
  for (int n = 0; n < 30; ++n) {
    const StatePyramid pyramid(crowdedGrid(random, {60, 50, 55}), Eigen::Vector3i::Zero(), 2);
    const RaySensor sensor = randomSensor(random, 0.4);
    const RayTree tree(sensor, kVoxel, 0);
    const Box bounds = pyramid.finest().geometry().bounds();
    const Pose pose = randomPose(random, bounds);
    for (const HierarchicalQuery& query : queries(bounds)) {
      const RayCounts uniform = castUniformRays(pyramid.finest(), tree, pose, query);
      hits += uniform.unknown + uniform.occupied;
      EXPECT_EQ(castHierarchical(pyramid, tree, 0, pose, query), uniform);
      for (const CpuPath path : availableCpuPaths())
        EXPECT_EQ(casting::castUniformRaysOn(path, pyramid.finest(), tree, pose, query), uniform);
    }
  }
  EXPECT_GT(hits, 10000u);
}

// Acceptance check 10.4 (ii).
TEST(HierarchicalCaster, RestartNeverSeesMoreOccupiedRaysThanUniform) {
  std::mt19937_64 random(34);
  std::uint64_t total = 0;
  for (int n = 0; n < 40; ++n) {
    const StatePyramid pyramid(crowdedGrid(random, {60, 50, 55}), Eigen::Vector3i::Zero(), 3);
    const RaySensor sensor = randomSensor(random, 0.4);
    const RayTree tree(sensor, kVoxel, std::min(3, maxCoarseLevels(sensor, kVoxel)));
    const Pose pose = randomPose(random, pyramid.finest().geometry().bounds());
    HierarchicalQuery query;
    query.start = ChildStart::Restart;
    const std::uint64_t uniform = castUniformRays(pyramid.finest(), tree, pose, query).occupied;
    total += uniform;
    for (int m = 1; m <= tree.coarseLevels(); ++m)
      EXPECT_LE(castHierarchical(pyramid, tree, m, pose, query).occupied, uniform);
  }
  EXPECT_GT(total, 1000u);
}

TEST(HierarchicalCaster, TraceTellsEveryRayAndTheSameCounts) {
  std::mt19937_64 random(35);
  const StatePyramid pyramid(crowdedGrid(random, {60, 50, 55}), Eigen::Vector3i::Zero(), 3);
  RaySensor sensor;
  sensor.min_range_m = 0.1;
  sensor.max_range_m = 0.9;
  const RayTree tree(sensor, kVoxel, 3);
  const Box bounds = pyramid.finest().geometry().bounds();
  HierarchicalQuery query;
  query.bounds = Box(bounds.center() - Eigen::Vector3d(0.2, 0.2, 0.2), bounds.max());
  const Pose pose = lookAlong(bounds.center() - Eigen::Vector3d(0.5, 0.03, 0.02), {1, 0, 0});
  std::vector<TracedRay> rays;
  const RayCounts counts = traceHierarchical(pyramid, tree, 2, pose, query, rays);
  EXPECT_EQ(counts, castHierarchical(pyramid, tree, 2, pose, query));
  EXPECT_EQ(rays.size(), counts.rays_cast);
  std::map<RayFate, std::uint64_t> leaves;
  std::uint64_t finest = 0;
  for (const TracedRay& ray : rays) {
    const RayLevel& level = tree.level(ray.level);
    finest += ray.level == 0;
    leaves[ray.fate] += level.leaves(ray.ray / level.columns.count(), ray.ray % level.columns.count());
    EXPECT_EQ(ray.node.x() < 0, ray.fate == RayFate::Missed);
    if (ray.node.x() < 0) continue;
    // The ray ends where it enters the node.
    const GridGeometry& g = pyramid.level(ray.level).geometry();
    const Eigen::Vector3d end =
        pose * (level.direction(ray.ray / level.columns.count(), ray.ray % level.columns.count()) *
                static_cast<double>(ray.end_m));
    EXPECT_LE((end - g.center(ray.node)).cwiseAbs().maxCoeff(), g.voxel_size_m / 2 + 1e-5);
  }
  EXPECT_EQ(finest, counts.finest_rays_cast);
  EXPECT_EQ(leaves[RayFate::Unknown], counts.unknown);
  EXPECT_EQ(leaves[RayFate::Occupied], counts.occupied);
  EXPECT_EQ(leaves[RayFate::OutsideUnknown], counts.unknown_scene);
  EXPECT_GT(counts.unknown, 0u);
  EXPECT_GT(counts.occupied, 0u);
}

/// A toy map with one label everywhere but where `label` says otherwise.
StatePyramid freeBut(const std::function<VoxelState(const Eigen::Vector3d&)>& label) {
  return testing::toyPyramid(label, 3);
}

// D-A12.
TEST(HierarchicalCaster, CoarseNodeAroundTheSensorIsRefinedWhateverItsLabel) {
  const RayTree tree(testing::toySensor(), testing::kToyVoxel, 3);
  for (const VoxelState beside : {VoxelState::Unknown, VoxelState::Occupied}) {
    // One voxel beside the sensor's own, in the same node from level 1 on, and a wall to see.
    const StatePyramid pyramid = freeBut([&](const Eigen::Vector3d& p) {
      if ((p - Eigen::Vector3d(0.075, 0.075, 0.025)).norm() < 0.01) return beside;
      return p.z() > 0.8 ? VoxelState::Unknown : VoxelState::Free;
    });
    RaySensor near = testing::toySensor();
    near.min_range_m = 0.2;  // the own node is refined although it is nearer
    for (const RayTree& t : {tree, RayTree(near, testing::kToyVoxel, 3)})
      for (int m = 1; m <= 3; ++m) {
        HierarchicalQuery query;
        query.bounds = Box(Eigen::Vector3d(-0.8, -0.8, 0.8), Eigen::Vector3d(0.8, 0.8, 1.6));
        const RayCounts counts = castHierarchical(pyramid, t, m, testing::toyPose(), query);
        EXPECT_EQ(counts, castHierarchicalReference(pyramid, t, m, testing::toyPose(), query));
        EXPECT_FALSE(counts.sensor_blocked);
        EXPECT_GT(counts.unknown, 100u);
        EXPECT_GT(counts.rays_cast, t.level(m).count());
      }
  }
}

TEST(HierarchicalCaster, SensorInAVoxelThatIsNotFreeSeesNothing) {
  const RayTree tree(testing::toySensor(), testing::kToyVoxel, 2);
  RayCounts blocked;
  blocked.sensor_blocked = true;
  for (const VoxelState own : {VoxelState::Unknown, VoxelState::Occupied}) {
    const StatePyramid pyramid = freeBut([&](const Eigen::Vector3d& p) {
      return p.norm() < 0.1 ? own : p.z() > 0.5 ? VoxelState::Unknown : VoxelState::Free;
    });
    for (int m = 0; m <= 2; ++m) {
      EXPECT_EQ(castHierarchical(pyramid, tree, m, testing::toyPose(), {}), blocked);
      EXPECT_EQ(castHierarchicalReference(pyramid, tree, m, testing::toyPose(), {}), blocked);
    }
    EXPECT_EQ(castUniformRays(pyramid.finest(), tree, testing::toyPose(), {}), blocked);
  }
}

// D-A22.
TEST(HierarchicalCaster, HitsNearerThanTheMinimumRangeAreLostAtEveryLevel) {
  RaySensor sensor = testing::toySensor();
  sensor.min_range_m = 0.9;  // beyond the wall, even of the longest ray
  const RayTree tree(sensor, testing::kToyVoxel, 3);
  const StatePyramid pyramid =
      freeBut([](const Eigen::Vector3d& p) { return p.z() > 0.5 ? VoxelState::Occupied : VoxelState::Free; });
  HierarchicalQuery beside;
  beside.bounds = Box(Eigen::Vector3d(-0.8, -0.8, 1.5), Eigen::Vector3d(0.8, 0.8, 1.6));
  for (int m = 0; m <= 3; ++m) {
    const RayCounts counts = castHierarchical(pyramid, tree, m, testing::toyPose(), {});
    EXPECT_EQ(counts.occupied + counts.unknown + counts.unknown_scene, 0u);
    EXPECT_EQ(castHierarchical(pyramid, tree, m, testing::toyPose(), beside).rays_cast,
              tree.level(m).count());
  }
}

TEST(HierarchicalCaster, NodesThatBeginNearerThanTheMinimumRangeHideNothingBeyondIt) {  // D-A22
  RaySensor sensor = testing::toySensor();
  sensor.min_range_m = 0.45;  // the nodes of 0.4 m with the wall begin at 0.4 m
  const RayTree tree(sensor, testing::kToyVoxel, 3);
  for (const VoxelState state : {VoxelState::Occupied, VoxelState::Unknown}) {
    const StatePyramid pyramid =
        freeBut([&](const Eigen::Vector3d& p) { return p.z() > 0.5 ? state : VoxelState::Free; });
    for (const ChildStart start : {ChildStart::Resume, ChildStart::Restart})
      for (int m = 0; m <= 3; ++m) {
        HierarchicalQuery query;
        query.start = start;
        const RayCounts counts = castHierarchical(pyramid, tree, m, testing::toyPose(), query);
        EXPECT_EQ(state == VoxelState::Occupied ? counts.occupied : counts.unknown, 336u) << "m " << m;
      }
  }
}

TEST(HierarchicalCaster, HitsOutsideTheBoxCountNothingAndAreNotRefined) {
  const RayTree tree(testing::toySensor(), testing::kToyVoxel, 3);
  HierarchicalQuery query;
  query.bounds = Box(Eigen::Vector3d(-0.8, -0.8, 1.0), Eigen::Vector3d(0.8, 0.8, 1.6));
  for (int m = 0; m <= 3; ++m) {
    const StatePyramid unknown = freeBut([](const auto& p) { return testing::toyLabel(0, p); });
    const RayCounts scene = castHierarchical(unknown, tree, m, testing::toyPose(), query);
    EXPECT_EQ(scene.unknown_scene, 336u);
    EXPECT_EQ(scene.unknown, 0u);
    const StatePyramid occupied = freeBut([](const auto& p) { return testing::toyLabel(1, p); });
    const RayCounts wall = castHierarchical(occupied, tree, m, testing::toyPose(), query);
    EXPECT_EQ(wall.occupied + wall.unknown + wall.unknown_scene, 0u);
    EXPECT_EQ(wall.rays_cast, tree.level(m).count());
  }
}

TEST(HierarchicalCaster, RefinedUnknownIsCountedByFinestRays) {
  const RayTree tree(testing::toySensor(), testing::kToyVoxel, 3);
  const StatePyramid pyramid = freeBut([](const auto& p) { return testing::toyLabel(4, p); });
  HierarchicalQuery query;
  query.start = ChildStart::Restart;
  const RayCounts uniform = castUniformRays(pyramid.finest(), tree, testing::toyPose(), query);
  query.refine_unknown = true;
  query.distinct_voxels = true;
  for (int m = 1; m <= 3; ++m) {
    const RayCounts counts = castHierarchical(pyramid, tree, m, testing::toyPose(), query);
    EXPECT_LE(counts.unknown, uniform.unknown);
    EXPECT_GE(counts.unknown, uniform.unknown * 9 / 10);
    EXPECT_LE(counts.unknown_voxels, counts.unknown);
    EXPECT_GT(counts.unknown_voxels, 0u);
  }
}

TEST(HierarchicalCaster, RaysFarFromTheGridSeeNothing) {
  const RayTree tree(testing::toySensor(), testing::kToyVoxel, 2);
  const StatePyramid pyramid = freeBut([](const auto&) { return VoxelState::Unknown; });
  for (const double away : {3.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    Pose pose = testing::toyPose();
    pose.translation().x() = away;
    const RayCounts counts = castHierarchical(pyramid, tree, 2, pose, {});
    EXPECT_EQ(counts, castHierarchicalReference(pyramid, tree, 2, pose, {}));
    EXPECT_EQ(counts.visited, 0u);
    EXPECT_EQ(counts.rays, 336u);
    EXPECT_EQ(counts.rays_cast, 24u);
    EXPECT_FALSE(counts.sensor_blocked);
  }
}

TEST(HierarchicalCaster, RefusesLevelsThatDoNotExistAndOtherResolutions) {
  const RayTree tree(testing::toySensor(), testing::kToyVoxel, 2);
  const StatePyramid pyramid = testing::toyPyramid([](const auto&) { return VoxelState::Free; }, 1);
  const Pose pose = testing::toyPose();
  EXPECT_NO_THROW(castHierarchical(pyramid, tree, 1, pose, {}));
  EXPECT_THROW(castHierarchical(pyramid, tree, 2, pose, {}), std::invalid_argument);
  EXPECT_THROW(castHierarchical(pyramid, tree, -1, pose, {}), std::invalid_argument);
  const RayTree finer(testing::toySensor(), 0.02, 1);
  EXPECT_THROW(castHierarchical(pyramid, finer, 1, pose, {}), std::invalid_argument);
  EXPECT_THROW(castHierarchicalReference(pyramid, finer, 1, pose, {}), std::invalid_argument);
  EXPECT_THROW(castUniformRays(pyramid.finest(), finer, pose, {}), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
