#include "core/motion/collision_grid.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <random>

#include "tests/core/motion/box_world.h"

namespace vantage {
namespace {

using test::fill;
using test::freeWorld;

/// The cell's definition, voxel by voxel.
bool freeCellReference(const StateGrid& states, const GridGeometry& cells, const Eigen::Vector3i& cell) {
  const GridGeometry& g = states.geometry();
  for (std::size_t n = 0; n < g.count(); ++n)
    if (cells.voxelAt(g.center(g.voxel(n))) == cell && states.at(g.voxel(n)) != VoxelState::Free)
      return false;
  return true;
}

TEST(CollisionGrid, CellIsFreeOnlyIfAllItsVoxelsAre) {
  GridGeometry g;
  g.voxel_size_m = 3.0 / 512.0;
  g.origin_m = {-0.2, 0.1, 0.3};
  g.size = {40, 33, 29};
  StateGrid states(g);
  std::mt19937 random(7);
  for (std::size_t n = 0; n < g.count(); ++n) {
    const unsigned r = random() % 600;
    states.set(g.voxel(n), r == 0 ? VoxelState::Unknown : r == 1 ? VoxelState::Occupied : VoxelState::Free);
  }
  const CollisionGrid grid(states, 0.04);
  const GridGeometry& cells = grid.geometry();
  ASSERT_EQ(cells.size, Eigen::Vector3i(5, 4, 4));  // whole cells only
  int free = 0;
  for (std::size_t n = 0; n < cells.count(); ++n) {
    ASSERT_EQ(grid.freeCell(cells.voxel(n)), freeCellReference(states, cells, cells.voxel(n)));
    free += grid.freeCell(cells.voxel(n));
  }
  EXPECT_GT(free, 5);
  EXPECT_LT(free, 75);
}

TEST(CollisionGrid, UnknownAndOutsideAreObstacles) {
  StateGrid states = freeWorld();
  const CollisionGrid all_free(states, 0.04);
  EXPECT_TRUE(all_free.freeCell({0, 0, 0}));
  EXPECT_FALSE(all_free.freeCell({-1, 0, 0}));
  EXPECT_FALSE(all_free.freeCell({0, 0, 25}));
  EXPECT_FALSE(all_free.freeBall({-0.95, 0.0, 0.5}, 0.08));  // reaches beyond the volume
  EXPECT_FALSE(CollisionGrid(StateGrid(states.geometry()), 0.04).freeCell({10, 10, 10}));
  EXPECT_FALSE(CollisionGrid().freeBall({0.0, 0.0, 0.0}, 0.0));
  EXPECT_EQ(CollisionGrid().component({0.0, 0.0, 0.0}), 0u);
}

TEST(CollisionGrid, BallTouchesExactlyTheCellsItOverlaps) {
  StateGrid states = freeWorld();
  fill(states, Box(Eigen::Vector3d(0.0, 0.0, 0.4), Eigen::Vector3d(0.04, 0.04, 0.44)), VoxelState::Occupied);
  const CollisionGrid grid(states, 0.04);
  const Box cell(Eigen::Vector3d(0.0, 0.0, 0.4), Eigen::Vector3d(0.04, 0.04, 0.44));
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> offset(-0.15, 0.15);
  int touching = 0;
  for (int n = 0; n < 20000; ++n) {
    const Eigen::Vector3d p = cell.center() + Eigen::Vector3d(offset(random), offset(random), offset(random));
    const bool overlaps = cell.exteriorDistance(p) < 0.08;
    touching += overlaps;
    ASSERT_EQ(grid.freeBall(p, 0.08), !overlaps) << p.transpose();
  }
  EXPECT_GT(touching, 1000);
  EXPECT_LT(touching, 19000);
}

TEST(CollisionGrid, SegmentThroughAThinObstacleIsNotFree) {
  StateGrid states = freeWorld();
  fill(states, Box(Eigen::Vector3d(0.0, -1.0, 0.0), Eigen::Vector3d(0.02, 1.0, 0.6)), VoxelState::Unknown);
  const CollisionGrid grid(states, 0.04);
  EXPECT_FALSE(grid.freeSegment({-0.5, 0.0, 0.3}, {0.5, 0.0, 0.3}, 0.08, 0.01));
  EXPECT_TRUE(grid.freeSegment({-0.5, 0.0, 0.8}, {0.5, 0.0, 0.8}, 0.08, 0.01));
  EXPECT_TRUE(grid.freeSegment({-0.5, 0.0, 0.3}, {-0.2, 0.0, 0.3}, 0.08, 0.01));
  EXPECT_TRUE(grid.freeSegment({-0.5, 0.0, 0.3}, {-0.5, 0.0, 0.3}, 0.08, 0.01));
}

TEST(CollisionGrid, ComponentsSeparateWhatAWallSeparates) {
  StateGrid states = freeWorld();
  const Box wall(Eigen::Vector3d(0.0, -1.0, 0.0), Eigen::Vector3d(0.04, 1.0, 1.0));
  fill(states, wall, VoxelState::Unknown);
  const Eigen::Vector3d left(-0.5, 0.0, 0.5), right(0.5, 0.0, 0.5);
  const CollisionGrid walled(states, 0.04, 0.08);
  EXPECT_EQ(walled.componentCount(), 2u);
  EXPECT_NE(walled.component(left), walled.component(right));
  EXPECT_NE(walled.component(left), 0u);
  EXPECT_EQ(walled.component({0.02, 0.0, 0.5}), 0u);
  EXPECT_EQ(walled.component({5.0, 0.0, 0.5}), 0u);

  // A hole of one cell connects points, but not balls.
  fill(states, Box(Eigen::Vector3d(0.0, 0.0, 0.4), Eigen::Vector3d(0.04, 0.04, 0.44)), VoxelState::Free);
  const CollisionGrid points(states, 0.04);
  EXPECT_EQ(points.component(left), points.component(right));
  const CollisionGrid balls(states, 0.04, 0.08);
  EXPECT_NE(balls.component(left), balls.component(right));
}

TEST(CollisionGrid, ComponentsNeverCutAFreeSegment) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int free_segments = 0;
  for (int world = 0; world < 4; ++world) {
    StateGrid states = freeWorld();
    for (int n = 0; n < 40; ++n) {
      const Eigen::Vector3d corner(2 * unit(random) - 1, 2 * unit(random) - 1, unit(random));
      const Eigen::Vector3d size(0.3 * unit(random), 0.3 * unit(random), 0.3 * unit(random));
      fill(states, Box(corner, Eigen::Vector3d(corner + size)), VoxelState::Occupied);
    }
    const CollisionGrid grid(states, 0.04, 0.08);
    for (int n = 0; n < 2000; ++n) {
      const Eigen::Vector3d a(2 * unit(random) - 1, 2 * unit(random) - 1, unit(random));
      const Eigen::Vector3d b(2 * unit(random) - 1, 2 * unit(random) - 1, unit(random));
      if (!grid.freeSegment(a, b, 0.08, 0.01)) continue;
      ++free_segments;
      ASSERT_NE(grid.component(a), 0u);
      ASSERT_EQ(grid.component(a), grid.component(b));
    }
  }
  EXPECT_GT(free_segments, 50);
}

TEST(CollisionGrid, SameForOneAndTwoThreads) {
  StateGrid states = freeWorld();
  std::mt19937 random(5);
  for (int n = 0; n < 3000; ++n)
    states.set(states.geometry().voxel(random() % states.geometry().count()), VoxelState::Occupied);
  const auto components = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const CollisionGrid grid(states, 0.04, 0.05);
    std::vector<std::uint32_t> all;
    for (std::size_t n = 0; n < grid.geometry().count(); ++n)
      all.push_back(grid.component(grid.geometry().center(grid.geometry().voxel(n))));
    return all;
  };
  EXPECT_EQ(components(1), components(2));
}

TEST(CollisionGrid, RefusesCellsBelowAVoxel) {
  try {
    CollisionGrid(freeWorld(), 0.01);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("collision cell (m) = 0.01"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace vantage
