// Fast casts over the derived pyramid against slow casts over OctoMap's own tree.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/core/raycasting/random_scene.h"
#include "tests/support/octree_caster.h"

namespace vantage {
namespace {

using testing::OctreeCaster;
using testing::randomPose;
using testing::randomSensor;

constexpr double kVoxel = 0.02;

/// A map with free space, boxes and single voxels of random values, and parts that are not stored.
OccupancyOctree randomMap(std::mt19937_64& random, InnerRule inner) {
  OccupancyConfig config;
  config.inner = inner;
  const auto upTo = [&](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Eigen::Vector3d low(unit(random), unit(random), unit(random));
  const Eigen::Vector3d size(0.4 + 0.02 * upTo(20), 0.4 + 0.02 * upTo(15), 0.4 + 0.02 * upTo(12));
  const GridGeometry g = OccupancyOctree::gridAround(Box(low, low + size), kVoxel);
  const Box object(g.bounds().center() - Eigen::Vector3d(0.1, 0.07, 0.05), g.bounds().center());
  OccupancyOctree map(g, object, VoxelState::Free, config);
  const float values[] = {-2.0f, -0.4f, 0.0f, 0.85f, 3.5f, std::numeric_limits<float>::quiet_NaN()};
  const Eigen::Vector3i middle = g.voxelAt(object.center());
  for (int n = 0; n < 9; ++n) {
    Eigen::Vector3i from(upTo(g.size.x()), upTo(g.size.y()), upTo(g.size.z()));
    if (n < 3) from = middle - Eigen::Vector3i(upTo(6), upTo(6), upTo(6));
    const Eigen::Vector3i to = (from + Eigen::Vector3i(upTo(9), upTo(9), upTo(9))).cwiseMin(g.size);
    const float value = n < 3 ? 3.5f : values[upTo(6)];
    for (int k = from.z(); k < to.z(); ++k)
      for (int j = from.y(); j < to.y(); ++j)
        for (int i = from.x(); i < to.x(); ++i) map.set({i, j, k}, value);
  }
  for (int n = 0; n < 15; ++n)
    map.set({upTo(g.size.x()), upTo(g.size.y()), upTo(g.size.z())}, values[upTo(6)]);
  return map;
}

HierarchicalQuery randomQuery(std::mt19937_64& random, const OccupancyOctree& map) {
  HierarchicalQuery query;
  if (random() % 4) query.bounds = map.objectBox();
  if (random() % 4 == 0) query.sphere = Sphere{map.geometry().bounds().center(), 0.13};
  query.start = random() % 2 ? ChildStart::Resume : ChildStart::Restart;
  query.refine_unknown = random() % 3 == 0;
  query.distinct_voxels = random() % 2 == 0;
  return query;
}

class OctreeReference : public ::testing::TestWithParam<InnerRule> {};

TEST_P(OctreeReference, AgreesWithCastsOverThePyramidOnRandomMaps) {
  std::mt19937_64 random(41);
  RayCounts total;
  int refined = 0;
  for (int n = 0; n < 100; ++n) {
    SCOPED_TRACE(n);
    const OccupancyOctree map = randomMap(random, GetParam());
    const RaySensor sensor = randomSensor(random, 0.5);
    const RayTree tree(sensor, kVoxel, std::min(3, maxCoarseLevels(sensor, kVoxel)));
    const StatePyramid pyramid(map, tree.coarseLevels());
    const OctreeCaster reference(map);
    const Pose pose = randomPose(random, map.geometry().bounds());
    const HierarchicalQuery query = randomQuery(random, map);
    for (int m = 0; m <= tree.coarseLevels(); ++m) {
      const RayCounts slow = reference.cast(tree, m, pose, query);
      EXPECT_EQ(castHierarchical(pyramid, tree, m, pose, query), slow) << "m " << m;
      total.unknown += slow.unknown, total.occupied += slow.occupied;
      total.unknown_scene += slow.unknown_scene, total.unknown_voxels += slow.unknown_voxels;
      refined += m > 0 && slow.finest_rays_cast > 0;
    }
    EXPECT_EQ(castUniformRays(pyramid.finest(), tree, pose, query), reference.cast(tree, 0, pose, query));
  }
  EXPECT_GT(total.unknown, 2000u);
  EXPECT_GT(total.occupied, 1000u);
  EXPECT_GT(total.unknown_scene, 500u);
  EXPECT_GT(total.unknown_voxels, 100u);
  EXPECT_GT(refined, 15);
}

INSTANTIATE_TEST_SUITE_P(Rules, OctreeReference, ::testing::Values(InnerRule::Max, InnerRule::Mean));

}  // namespace
}  // namespace vantage
