#include "core/volume/state_grid.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <random>

#include "core/volume/tsdf_volume.h"

namespace vantage {
namespace {

GridGeometry geometry(int x, int y, int z) {
  return {Eigen::Vector3d(-0.1, 0.2, 0.3), 0.01, Eigen::Vector3i(x, y, z)};
}

/// Distance to the nearest voxel that is not free, by looking at all within reach.
int radiusByBruteForce(const StateGrid& grid, const Eigen::Vector3i& v) {
  const Eigen::Vector3i size = grid.geometry().size;
  int nearest = StateGrid::kMaxRadius;
  for (int k = std::max(v.z() - 14, 0); k <= std::min(v.z() + 14, size.z() - 1); ++k)
    for (int j = std::max(v.y() - 14, 0); j <= std::min(v.y() + 14, size.y() - 1); ++j)
      for (int i = std::max(v.x() - 14, 0); i <= std::min(v.x() + 14, size.x() - 1); ++i)
        if (grid.at(i, j, k) != VoxelState::Free)
          nearest = std::min(nearest, (Eigen::Vector3i(i, j, k) - v).cwiseAbs().maxCoeff());
  return nearest;
}

void expectExactRadius(const StateGrid& grid, std::mt19937_64& random, int samples) {
  const GridGeometry& g = grid.geometry();
  for (int n = 0; n < samples; ++n) {
    const std::size_t at = random() % g.count();
    ASSERT_EQ(grid.freeRadius()[at], radiusByBruteForce(grid, g.voxel(at))) << g.voxel(at).transpose();
  }
}

TEST(StateGrid, FreeRadiusIsTheChebyshevDistanceToTheNearestObstacle) {
  std::mt19937_64 random(5);
  for (const Eigen::Vector3i& size : {Eigen::Vector3i(70, 66, 67), Eigen::Vector3i(64, 20, 130),
                                      Eigen::Vector3i(131, 9, 3), Eigen::Vector3i(5, 90, 70)}) {
    for (const int obstacles : {0, 1, 30, 3000}) {
      StateGrid grid(geometry(size.x(), size.y(), size.z()));
      const GridGeometry& g = grid.geometry();
      for (std::size_t n = 0; n < g.count(); ++n) grid.set(g.voxel(n), VoxelState::Free);
      for (int n = 0; n < obstacles; ++n)
        grid.set(g.voxel(random() % g.count()), n % 2 ? VoxelState::Unknown : VoxelState::Occupied);
      grid.rebuildFreeRadius();
      expectExactRadius(grid, random, 400);
    }
  }
}

/// Changes a random box of a volume and returns its bricks.
BrickSet changeBox(TsdfVolume& volume, std::mt19937_64& random) {
  const Eigen::Vector3i size = volume.geometry().size;
  BrickSet changed(volume.bricks().total());
  Eigen::Vector3i low, high;
  for (int a = 0; a < 3; ++a) {
    low[a] = static_cast<int>(random() % size[a]);
    high[a] = std::min<int>(low[a] + 1 + static_cast<int>(random() % 30), size[a]);
  }
  const TsdfVoxel values[] = {{0, 0}, {100, 3}, {-100, 3}, {0, 1}, {32767, 128}};
  const TsdfVoxel value = values[random() % 5];
  for (int k = low.z(); k < high.z(); ++k)
    for (int j = low.y(); j < high.y(); ++j)
      for (int i = low.x(); i < high.x(); ++i) {
        volume.at(i, j, k) = value;
        changed.insert(volume.bricks().brickOf({i, j, k}));
      }
  return changed;
}

TEST(StateGrid, UpdateByChangedBricksEqualsAFreshGrid) {
  std::mt19937_64 random(6);
  TsdfVolume volume(geometry(150, 100, 90));
  for (TsdfVoxel& voxel : volume.voxels()) voxel = {200, 5};
  StateGrid grid = makeStateGrid(volume);
  for (int n = 0; n < 40; ++n) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1 + n % 3);
    BrickSet changed = changeBox(volume, random);
    if (n % 2) changed.merge(changeBox(volume, random));
    grid.update(volume, changed);
    const StateGrid fresh = makeStateGrid(volume);
    ASSERT_TRUE(std::equal(grid.states().begin(), grid.states().end(), fresh.states().begin())) << n;
    ASSERT_TRUE(std::equal(grid.freeRadius().begin(), grid.freeRadius().end(), fresh.freeRadius().begin()))
        << n;
  }
  for (std::size_t n = 0; n < volume.geometry().count(); ++n)
    ASSERT_EQ(grid.at(volume.geometry().voxel(n)), volume.voxels()[n].state());
  expectExactRadius(grid, random, 500);
}

TEST(StateGrid, CountsVoxelsWhoseCentreLiesInABox) {
  std::mt19937_64 random(7);
  const GridGeometry g = geometry(20, 22, 24);
  StateGrid grid(g);
  for (std::size_t n = 0; n < g.count(); ++n) grid.set(g.voxel(n), static_cast<VoxelState>(random() % 3));
  std::uniform_real_distribution<double> unit(-0.3, 0.3);
  std::uint64_t total = 0;
  for (int n = 0; n < 30; ++n) {
    const Eigen::Vector3d a = g.bounds().center() + Eigen::Vector3d(unit(random), unit(random), unit(random));
    const Eigen::Vector3d b =
        n % 3 ? Eigen::Vector3d(g.bounds().center()) : g.center({3, 4, 5});  // on centres too
    const Box box(a.cwiseMin(b), a.cwiseMax(b));
    for (const VoxelState state : {VoxelState::Unknown, VoxelState::Free, VoxelState::Occupied}) {
      std::uint64_t expected = 0;
      for (std::size_t v = 0; v < g.count(); ++v)
        expected += grid.at(g.voxel(v)) == state && box.contains(g.center(g.voxel(v)));
      EXPECT_EQ(grid.count(state, box), expected);
      total += expected;
    }
  }
  EXPECT_GT(total, 1000u);
  EXPECT_EQ(grid.count(VoxelState::Free, Box()), 0u);
}

TEST(StateGrid, RefusesAVolumeOfAnotherGeometry) {
  StateGrid grid(geometry(20, 20, 20));
  const TsdfVolume volume(geometry(20, 20, 21));
  EXPECT_THROW(grid.update(volume, BrickSet(volume.bricks().total())), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
