#include "core/volume/state_pyramid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>

namespace vantage {
namespace {

using Eigen::Vector3i;

constexpr double kVoxel = 0.02;
constexpr float kNotStored = std::numeric_limits<float>::quiet_NaN();

Vector3i randomIndex(std::mt19937_64& random, const Vector3i& size) {
  return {static_cast<int>(random() % size.x()), static_cast<int>(random() % size.y()),
          static_cast<int>(random() % size.z())};
}

StateGrid randomGrid(std::mt19937_64& random, const Vector3i& size) {
  GridGeometry g;
  g.size = size;
  StateGrid grid(g);
  for (std::size_t i = 0; i < g.count(); ++i) grid.set(g.voxel(i), VoxelState::Free);
  const int changes = static_cast<int>(random() % 60);
  for (int n = 0; n < changes; ++n)
    grid.set(randomIndex(random, size), n % 2 ? VoxelState::Unknown : VoxelState::Occupied);
  const Vector3i low = randomIndex(random, size);
  for (int k = low.z(); k < size.z(); ++k)
    for (int j = low.y(); j < size.y(); ++j)
      for (int i = low.x(); i < size.x(); ++i) grid.set({i, j, k}, VoxelState::Unknown);
  grid.rebuildFreeRadius();
  return grid;
}

/// D-A5 over all finest voxels of a node.
VoxelState labelByMax(const StatePyramid& pyramid, int level, const Vector3i& node) {
  const GridGeometry& g = pyramid.finest().geometry();
  const Vector3i low = node * (1 << level) - pyramid.offset(level);
  bool all_free = true, any_occupied = false, any = false;
  for (int n = 0; n < 1 << (3 * level); ++n) {
    const int mask = (1 << level) - 1;
    const Vector3i v = low + Vector3i(n & mask, n >> level & mask, n >> (2 * level) & mask);
    if (!g.contains(v)) continue;
    any = true;
    EXPECT_EQ(pyramid.node(v, level), node);
    all_free = all_free && pyramid.finest().at(v) == VoxelState::Free;
    any_occupied = any_occupied || pyramid.finest().at(v) == VoxelState::Occupied;
  }
  EXPECT_TRUE(any) << "a node without voxels";
  return any_occupied ? VoxelState::Occupied : all_free ? VoxelState::Free : VoxelState::Unknown;
}

/// Every free radius is that of a grid built at once from the same states.
void expectFreshRadii(const StatePyramid& pyramid) {
  for (int i = 0; i <= pyramid.coarseLevels(); ++i) {
    StateGrid fresh = pyramid.level(i);
    fresh.rebuildFreeRadius();
    ASSERT_TRUE(std::ranges::equal(pyramid.level(i).freeRadius(), fresh.freeRadius())) << "level " << i;
  }
}

TEST(StatePyramid, NodesFollowTheMaxRuleOverTheirFinestVoxels) {
  std::mt19937_64 random(51);
  std::array<int, 3> seen{};
  for (int n = 0; n < 30; ++n) {
    const Vector3i size = randomIndex(random, {50, 40, 45}) + Vector3i::Ones();
    const Vector3i first = randomIndex(random, {40, 40, 40}) - Vector3i::Constant(20);
    const StatePyramid pyramid(randomGrid(random, size), first, 4);
    ASSERT_EQ(pyramid.coarseLevels(), 4);
    for (int i = 1; i <= 4; ++i) {
      const GridGeometry& g = pyramid.level(i).geometry();
      for (std::size_t k = 0; k < g.count(); ++k) {
        const VoxelState state = pyramid.level(i).at(g.voxel(k));
        ASSERT_EQ(state, labelByMax(pyramid, i, g.voxel(k))) << "level " << i;
        ++seen[static_cast<int>(state)];
      }
    }
    expectFreshRadii(pyramid);
  }
  for (const int count : seen) EXPECT_GT(count, 1000);
}

TEST(StatePyramid, NodesLieAtMultiplesOfTheirEdgeInTheInfiniteGrid) {
  GridGeometry g;
  g.voxel_size_m = kVoxel;
  g.size = {30, 20, 10};
  const Vector3i first(-13, 5, 64);
  g.origin_m = kVoxel * (first.cast<double>() + Eigen::Vector3d::Constant(0.5));
  EXPECT_EQ(firstVoxelOf(g), first);
  const StatePyramid pyramid(StateGrid(g), first, 5);
  for (int i = 0; i <= 5; ++i) {
    const GridGeometry& level = pyramid.level(i).geometry();
    EXPECT_DOUBLE_EQ(level.voxel_size_m, kVoxel * (1 << i));
    const Eigen::Vector3d corner = level.bounds().min() / level.voxel_size_m;
    EXPECT_LT((corner - corner.array().round().matrix()).norm(), 1e-9);
    EXPECT_TRUE(level.bounds().contains(g.bounds().center()));
    EXPECT_EQ(pyramid.node(Vector3i::Zero(), i), Vector3i::Zero());
    EXPECT_EQ(pyramid.node(g.size - Vector3i::Ones(), i), level.size - Vector3i::Ones());
  }
}

TEST(StatePyramid, StartsUnknown) {
  GridGeometry g;
  g.size = {9, 1, 20};
  const StatePyramid pyramid(g, Vector3i(3, 3, 3), 3);
  for (int i = 0; i <= 3; ++i)
    for (const std::uint8_t state : pyramid.level(i).states())
      EXPECT_EQ(state, static_cast<std::uint8_t>(VoxelState::Unknown));
  expectFreshRadii(pyramid);
}

OccupancyOctree emptyMap(InnerRule inner, const Eigen::Vector3d& corner) {
  OccupancyConfig config;
  config.inner = inner;
  const GridGeometry g =
      OccupancyOctree::gridAround(Box(corner, corner + Eigen::Vector3d(1.1, 0.74, 0.5)), kVoxel);
  const Box object(g.bounds().center() - Eigen::Vector3d(0.2, 0.1, 0.1), g.bounds().center());
  return OccupancyOctree(g, object, VoxelState::Free, config);
}

/// Changes some voxels and a box of the map; returns the bricks.
BrickSet change(OccupancyOctree& map, std::mt19937_64& random) {
  const float values[] = {-2.0f, -0.41f, 0.0f, 0.02f, 0.85f, 3.5f, kNotStored};
  BrickSet changed(map.bricks().total());
  const auto set = [&](const Vector3i& v, float value) {
    map.set(v, value);
    changed.insert(map.bricks().brickOf(v));
  };
  const Vector3i& size = map.geometry().size;
  for (int n = 0; n < 10; ++n) set(randomIndex(random, size), values[random() % 7]);
  const Vector3i low = randomIndex(random, size);
  const Vector3i high = (low + randomIndex(random, {9, 9, 9})).cwiseMin(size);
  const float value = values[random() % 7];
  for (int k = low.z(); k < high.z(); ++k)
    for (int j = low.y(); j < high.y(); ++j)
      for (int i = low.x(); i < high.x(); ++i) set({i, j, k}, value);
  return changed;
}

class PyramidOfMap : public ::testing::TestWithParam<InnerRule> {};

TEST_P(PyramidOfMap, FollowsTheMapThroughUpdates) {
  std::mt19937_64 random(52);
  std::array<int, 3> seen{};
  for (int n = 0; n < 3; ++n) {
    OccupancyOctree map = emptyMap(GetParam(), Eigen::Vector3d(-0.26 + 0.3 * n, 0.14, -0.34 * n));
    StatePyramid pyramid(map, 3);
    for (int step = 0; step < 6; ++step) {
      pyramid.update(map, change(map, random));
      for (int i = 0; i <= 3; ++i) {
        const GridGeometry& g = pyramid.level(i).geometry();
        for (std::size_t k = 0; k < g.count(); ++k) {
          const Vector3i voxel = (g.voxel(k) * (1 << i) - pyramid.offset(i)).cwiseMax(0);
          ASSERT_EQ(pyramid.level(i).at(g.voxel(k)), map.label(voxel, i)) << "level " << i;
          ++seen[static_cast<int>(pyramid.level(i).at(g.voxel(k)))];
        }
      }
      expectFreshRadii(pyramid);
    }
  }
  for (const int count : seen) EXPECT_GT(count, 300);
}

INSTANTIATE_TEST_SUITE_P(Rules, PyramidOfMap, ::testing::Values(InnerRule::Max, InnerRule::Mean));

TEST(StatePyramid, RefusesOtherMapsAndLevelsThatCannotBe) {
  const OccupancyOctree map = emptyMap(InnerRule::Max, Eigen::Vector3d::Zero());
  EXPECT_THROW(StatePyramid(map, -1), std::invalid_argument);
  EXPECT_THROW(StatePyramid(map, 9), std::invalid_argument);
  StatePyramid pyramid(map, 2);
  const BrickSet none(map.bricks().total());
  EXPECT_NO_THROW(pyramid.update(map, none));
  EXPECT_THROW(pyramid.update(map, BrickSet(1)), std::invalid_argument);
  EXPECT_THROW(pyramid.update(emptyMap(InnerRule::Mean, Eigen::Vector3d::Zero()), none),
               std::invalid_argument);
  EXPECT_THROW(pyramid.update(emptyMap(InnerRule::Max, Eigen::Vector3d::Ones()), none),
               std::invalid_argument);
}

}  // namespace
}  // namespace vantage
