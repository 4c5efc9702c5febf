#include "core/volume/state_grid.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "core/volume/free_radius.h"
#include "core/volume/tsdf_volume.h"

namespace vantage {
namespace {

/// Eq. (1) for a row; true if a voxel became free or stopped being it.
bool takeOver(const TsdfVoxel* voxels, int count, std::uint8_t* states) {
  std::uint8_t difference = 0;
  for (int x = 0; x < count; ++x) {
    const std::uint8_t state = voxels[x].weight == 0 ? 0 : (voxels[x].value <= 0 ? 2 : 1);
    difference |= static_cast<std::uint8_t>(state ^ states[x]);
    states[x] = state;
  }
  return (difference & 1) != 0;  // bit 0 of a state says free
}

bool takeOver(const TsdfVolume& volume, const BrickRange& r, std::uint8_t* states) {
  bool changed = false;
  for (int k = r.begin.z(); k < r.end.z(); ++k)
    for (int j = r.begin.y(); j < r.end.y(); ++j) {
      const std::size_t at = volume.geometry().index(r.begin.x(), j, k);
      changed |= takeOver(volume.voxels().data() + at, r.end.x() - r.begin.x(), states + at);
    }
  return changed;
}

}  // namespace

StateGrid::StateGrid(const GridGeometry& geometry) : geometry_(geometry) {
  requireGridFits("state grid", geometry, 2, 1);
  try {
    states_.resize(geometry.count() + kReadMargin, 0);
    free_radius_.resize(geometry.count() + kReadMargin, 0);
  } catch (const std::bad_alloc&) {
    throwDoesNotFit("state grid", geometry, 2);
  }
}

void StateGrid::update(const TsdfVolume& volume, const BrickSet& changed) {
  const BrickLayout& bricks = volume.bricks();
  if (!(volume.geometry() == geometry_) || changed.total() != bricks.total())
    throw std::invalid_argument("state grid: volume and brick set must have the geometry of the grid");
  std::vector<std::uint8_t> moved(bricks.total(), 0);
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, static_cast<std::uint32_t>(bricks.total()), 64),
                    [&](const tbb::blocked_range<std::uint32_t>& range) {
                      for (std::uint32_t b = range.begin(); b < range.end(); ++b)
                        if (changed.contains(b)) moved[b] = takeOver(volume, bricks.range(b), states_.data());
                    });
  rebuildFreeRadiusNear(moved);
}

void StateGrid::rebuildFreeRadius() {
  rebuildFreeRadiusNear(std::vector<std::uint8_t>(BrickLayout(geometry_.size).total(), 1));
}

void StateGrid::rebuildFreeRadiusNear(std::span<const std::uint8_t> moved) {
  vantage::rebuildFreeRadiusNear(geometry_.size, states_.data(), moved, free_radius_.data());
}

std::uint64_t StateGrid::count(VoxelState state, const Box& box) const {
  if (box.isEmpty() || geometry_.count() == 0) return 0;
  // Candidates by index, decided by the centre itself so that rounding cannot move the border.
  Eigen::Vector3i low, high;
  for (int a = 0; a < 3; ++a) {
    const double last = geometry_.size[a] - 1;
    const auto center = [&](int i) { return geometry_.origin_m[a] + geometry_.voxel_size_m * i; };
    const auto at = [&](double p) { return (p - geometry_.origin_m[a]) / geometry_.voxel_size_m; };
    low[a] = static_cast<int>(std::clamp(std::floor(at(box.min()[a])) - 1, 0.0, last + 1));
    high[a] = static_cast<int>(std::clamp(std::ceil(at(box.max()[a])) + 1, -1.0, last));
    while (low[a] <= high[a] && center(low[a]) < box.min()[a]) ++low[a];
    while (high[a] >= low[a] && center(high[a]) > box.max()[a]) --high[a];
    if (high[a] < low[a]) return 0;
  }
  return tbb::parallel_reduce(
      tbb::blocked_range<int>(low.z(), high.z() + 1), std::uint64_t{0},
      [&](const tbb::blocked_range<int>& range, std::uint64_t sum) {
        for (int k = range.begin(); k < range.end(); ++k)
          for (int j = low.y(); j <= high.y(); ++j) {
            const std::uint8_t* row = states_.data() + geometry_.index(0, j, k);
            sum += std::count(row + low.x(), row + high.x() + 1, static_cast<std::uint8_t>(state));
          }
        return sum;
      },
      std::plus<>());
}

StateGrid makeStateGrid(const TsdfVolume& volume) {
  StateGrid grid(volume.geometry());
  BrickSet all(volume.bricks().total());
  std::fill(all.flags().begin(), all.flags().end(), std::uint8_t{1});
  grid.update(volume, all);
  return grid;
}

}  // namespace vantage
