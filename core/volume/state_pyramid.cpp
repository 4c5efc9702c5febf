#include "core/volume/state_pyramid.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/geometry/check.h"
#include "core/volume/pyramid_rules.h"

namespace vantage {
namespace {

using Eigen::Vector3i;
using Flags = std::vector<std::uint8_t>;

/// Index of a level's first node in the infinite grid of its nodes. Shifts round down, also below 0.
Vector3i firstNode(const Vector3i& first_voxel, int level) {
  return first_voxel.unaryExpr([&](int v) { return v >> level; });
}

GridGeometry levelGeometry(const GridGeometry& finest, const Vector3i& first_voxel, int level) {
  const Vector3i first = firstNode(first_voxel, level);
  const Vector3i last = firstNode(first_voxel + finest.size - Vector3i::Ones(), level);
  const Vector3i offset = first_voxel - first * (1 << level);
  GridGeometry g;
  g.voxel_size_m = std::ldexp(finest.voxel_size_m, level);
  g.size = last - first + Vector3i::Ones();
  g.origin_m = finest.origin_m - finest.voxel_size_m * offset.cast<double>() +
               Eigen::Vector3d::Constant((g.voxel_size_m - finest.voxel_size_m) / 2);
  return g;
}

Flags allBricks(const StateGrid& grid) {
  return Flags(BrickLayout(grid.geometry().size).total(), 1);
}

/// Differences of the flagged bricks, each by `refresh(brick)`.
template <class Refresh>
Flags refreshBricks(std::span<const std::uint8_t> flags, Refresh refresh) {
  Flags differences(flags.size(), 0);
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, static_cast<std::uint32_t>(flags.size()), 64),
                    [&](const tbb::blocked_range<std::uint32_t>& range) {
                      for (std::uint32_t b = range.begin(); b < range.end(); ++b)
                        if (flags[b]) differences[b] = refresh(b);
                    });
  return differences;
}

/// Bricks in which a voxel became free or stopped being it.
Flags movedBricks(Flags differences) {
  for (std::uint8_t& difference : differences) difference &= 1;
  return differences;
}

}  // namespace

Vector3i firstVoxelOf(const GridGeometry& g) {
  const Eigen::Vector3d corner = g.origin_m / g.voxel_size_m - Eigen::Vector3d::Constant(0.5);
  return {static_cast<int>(std::lround(corner.x())), static_cast<int>(std::lround(corner.y())),
          static_cast<int>(std::lround(corner.z()))};
}

StatePyramid::StatePyramid(const GridGeometry& finest, const Vector3i& first_voxel, int coarse_levels,
                           const OccupancyConfig& config)
    : StatePyramid(StateGrid(finest), first_voxel, coarse_levels, config) {
  if (config_.inner == InnerRule::Max) return;
  for (const StateGrid& level : levels_) probability_.emplace_back(level.geometry().count(), 0.5f);
}

StatePyramid::StatePyramid(StateGrid finest, const Vector3i& first_voxel, int coarse_levels)
    : StatePyramid(std::move(finest), first_voxel, coarse_levels, OccupancyConfig{}) {
  refreshCoarse(allBricks(levels_[0]));
}

StatePyramid::StatePyramid(const OccupancyOctree& map, int coarse_levels)
    : StatePyramid(map.geometry(), firstVoxelOf(map.geometry()), coarse_levels, map.config()) {
  BrickSet all(map.bricks().total());
  std::fill(all.flags().begin(), all.flags().end(), std::uint8_t{1});
  update(map, all);
}

StatePyramid::StatePyramid(StateGrid finest, const Vector3i& first_voxel, int coarse_levels,
                           const OccupancyConfig& config)
    : config_(config), first_voxel_(first_voxel) {
  requireInRange("state pyramid: coarse_levels", coarse_levels, 0, kMaxCoarseLevels);
  levels_.reserve(coarse_levels + 1);
  levels_.push_back(std::move(finest));
  for (int i = 1; i <= coarse_levels; ++i)
    levels_.emplace_back(levelGeometry(levels_[0].geometry(), first_voxel, i));
}

Vector3i StatePyramid::offset(int level) const {
  return first_voxel_ - firstNode(first_voxel_, level) * (1 << level);
}

Vector3i StatePyramid::node(const Vector3i& voxel, int level) const {
  return (voxel + offset(level)).unaryExpr([&](int v) { return v >> level; });
}

void StatePyramid::update(const OccupancyOctree& map, const BrickSet& changed) {
  const GridGeometry& g = levels_.front().geometry();
  if (!(map.geometry() == g) || !(map.config() == config_) || changed.total() != map.bricks().total())
    throw std::invalid_argument(
        "state pyramid: map and brick set must have the geometry and the labels of the pyramid");
  Flags flags(changed.total(), 0);
  for (const std::uint32_t brick : changed.list()) flags[brick] = 1;
  Flags differences = refreshBricks(flags, [&](std::uint32_t b) { return takeOver(map, b); });
  levels_[0].rebuildFreeRadiusNear(movedBricks(differences));
  // A mean changes with every value, the maximum with labels alone.
  refreshCoarse(config_.inner == InnerRule::Mean ? std::move(flags) : std::move(differences));
}

std::uint8_t StatePyramid::takeOver(const OccupancyOctree& map, std::uint32_t brick) {
  float log_odds[kBrickX * kBrickY * kBrickZ];
  const BrickRange r = map.bricks().range(brick);
  const OccupancyBand band(config_);
  map.readBrick(brick, {log_odds, static_cast<std::size_t>((r.end - r.begin).prod())});
  std::span<std::uint8_t> states = levels_[0].editStates();
  const float* value = log_odds;
  std::uint8_t difference = 0;
  for (int k = r.begin.z(); k < r.end.z(); ++k)
    for (int j = r.begin.y(); j < r.end.y(); ++j) {
      const std::size_t row = levels_[0].geometry().index(0, j, k);
      for (int i = r.begin.x(); i < r.end.x(); ++i, ++value) {
        const auto state = static_cast<std::uint8_t>(band.label(*value));
        difference |= state ^ states[row + i];
        states[row + i] = state;
        if (config_.inner == InnerRule::Mean)
          probability_[0][row + i] =
              std::isnan(*value) ? 0.5f : static_cast<float>(probabilityOf(*value));  // D-A6
      }
    }
  return difference;
}

void StatePyramid::refreshCoarse(Flags changed) {
  for (int i = 1; i <= coarseLevels(); ++i) {
    const Vector3i phase = firstNode(first_voxel_, i - 1) - 2 * firstNode(first_voxel_, i);
    const pyramid::LevelPair levels{levels_[i - 1], levels_[i], phase};
    const BrickLayout bricks(levels_[i].geometry().size);
    Flags parents = pyramid::parentBricks(levels, changed);
    Flags differences = refreshBricks(parents, [&](std::uint32_t b) {
      if (config_.inner == InnerRule::Max) return pyramid::refreshByMax(levels, bricks.range(b));
      const pyramid::MeanLevels means{levels_[0].geometry().size, offset(i), i, probability_[i - 1],
                                      probability_[i]};
      return pyramid::refreshByMean(levels, means, config_, bricks.range(b));
    });
    levels_[i].rebuildFreeRadiusNear(movedBricks(differences));
    changed = config_.inner == InnerRule::Mean ? std::move(parents) : std::move(differences);
  }
}

}  // namespace vantage
