#include "core/exploration/map_metrics.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vantage {
namespace {

/// Voxels whose centre lies in a box, cut to the grid: [first, last] inclusive; empty if any last < first.
struct VoxelRange {
  Eigen::Vector3i first, last;
  bool empty() const { return (last.array() < first.array()).any(); }
};

VoxelRange voxelsIn(const GridGeometry& geometry, const Box& box) {
  const Eigen::Vector3d low = geometry.toGrid(box.min()), high = geometry.toGrid(box.max());
  VoxelRange range;
  for (int a = 0; a < 3; ++a) {
    range.first[a] = std::max(0, static_cast<int>(std::ceil(std::max(low[a], 0.0))));
    range.last[a] = static_cast<int>(std::floor(std::min(high[a], geometry.size[a] - 1.0)));
  }
  return range;
}

/// Linear indices of the voxels of `range` for which `wanted` holds, ascending.
template <class Predicate>
std::vector<std::uint32_t> collect(const GridGeometry& geometry, const VoxelRange& range, Predicate wanted) {
  if (range.empty()) return {};
  std::vector<std::vector<std::uint32_t>> slabs(range.last.z() - range.first.z() + 1);
  tbb::parallel_for(std::size_t{0}, slabs.size(), [&](std::size_t slab) {
    const int k = range.first.z() + static_cast<int>(slab);
    for (int j = range.first.y(); j <= range.last.y(); ++j)
      for (int i = range.first.x(); i <= range.last.x(); ++i)
        if (wanted(geometry.center({i, j, k})))
          slabs[slab].push_back(static_cast<std::uint32_t>(geometry.index(i, j, k)));
  });
  std::vector<std::uint32_t> all;
  for (const auto& slab : slabs) all.insert(all.end(), slab.begin(), slab.end());
  return all;
}

std::uint64_t countUnknown(const StateGrid& states, const std::vector<std::uint32_t>& voxels) {
  const auto all = states.states();
  return std::count_if(voxels.begin(), voxels.end(), [&](std::uint32_t v) {
    return all[v] == static_cast<std::uint8_t>(VoxelState::Unknown);
  });
}

}  // namespace

MapMetricsCounter::MapMetricsCounter(const GridGeometry& geometry, const Box& workspace,
                                     const GroundTruth* truth)
    : workspace_(workspace), has_truth_(truth != nullptr) {
  if (!truth) return;
  std::vector<Box> boxes = truth->objectBoxes();
  Box all;
  for (Box& box : boxes) {
    box.min().array() -= kObjectMargin_m;
    box.max().array() += kObjectMargin_m;
    all.extend(box);
  }
  if (boxes.empty()) return;
  const VoxelRange range = voxelsIn(geometry, all);
  in_boxes_ = collect(geometry, range, [&](const Eigen::Vector3d& p) {
    return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) { return box.contains(p); });
  });
  // A voxel near a surface lies in that object's inflated box.
  std::vector<std::uint8_t> near(in_boxes_.size(), 0);
  tbb::parallel_for(std::size_t{0}, in_boxes_.size(), [&](std::size_t n) {
    const Eigen::Vector3d p = geometry.center(geometry.voxel(in_boxes_[n]));
    near[n] = truth->objectDistance(p) <= kObjectMargin_m && !truth->insideSolid(p);
  });
  for (std::size_t n = 0; n < near.size(); ++n)
    if (near[n]) near_objects_.push_back(in_boxes_[n]);
}

MapMetrics MapMetricsCounter::count(const StateGrid& states) const {
  MapMetrics metrics;
  metrics.unknown_voxels = states.count(VoxelState::Unknown, workspace_);
  if (has_truth_) {
    metrics.unknown_near_objects = countUnknown(states, near_objects_);
    metrics.unknown_in_boxes = countUnknown(states, in_boxes_);
  }
  return metrics;
}

double surfaceCoverage(const std::vector<Eigen::Vector3f>& truth, const std::vector<Eigen::Vector3f>& seen,
                       double distance_m) {
  if (truth.empty() || seen.empty()) return 0.0;
  // Cells of the search distance: a neighbour within it lies in one of 27 cells.
  const float cell = static_cast<float>(distance_m);
  Eigen::AlignedBox3f box;
  for (const auto& p : truth) box.extend(p);
  const Eigen::Vector3f low = box.min() - Eigen::Vector3f::Constant(cell);
  const Eigen::Vector3i size = ((box.max() - low) / cell).array().floor().cast<int>() + 2;
  const auto cellOf = [&](const Eigen::Vector3f& p) -> Eigen::Vector3i {
    return ((p - low) / cell).array().floor().cast<int>();
  };
  const auto inside = [&](const Eigen::Vector3i& c) {
    return (c.array() >= 0).all() && (c.array() < size.array()).all();
  };
  const auto linear = [&](const Eigen::Vector3i& c) {
    return (static_cast<std::size_t>(c.z()) * size.y() + c.y()) * size.x() + c.x();
  };
  std::vector<std::uint32_t> start(static_cast<std::size_t>(size.x()) * size.y() * size.z() + 1, 0);
  std::vector<std::uint32_t> order;
  for (const auto& p : seen)
    if (const Eigen::Vector3i c = cellOf(p); inside(c)) ++start[linear(c) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  order.resize(start.back());
  std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
  for (std::uint32_t n = 0; n < seen.size(); ++n)
    if (const Eigen::Vector3i c = cellOf(seen[n]); inside(c)) order[next[linear(c)]++] = n;

  const auto covered = [&](const Eigen::Vector3f& p) {
    const Eigen::Vector3i center = cellOf(p);
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const Eigen::Vector3i c = center + Eigen::Vector3i(dx, dy, dz);
          if (!inside(c)) continue;
          for (std::uint32_t n = start[linear(c)]; n < start[linear(c) + 1]; ++n)
            if ((seen[order[n]] - p).squaredNorm() <= cell * cell) return true;
        }
    return false;
  };
  std::vector<std::uint8_t> hit(truth.size(), 0);
  tbb::parallel_for(std::size_t{0}, truth.size(), [&](std::size_t n) { hit[n] = covered(truth[n]); });
  return static_cast<double>(std::count(hit.begin(), hit.end(), 1)) / static_cast<double>(truth.size());
}

std::vector<Eigen::Vector3f> occupiedCenters(const StateGrid& states, const Box& box) {
  const GridGeometry& geometry = states.geometry();
  const Eigen::Vector3d edge = Eigen::Vector3d::Constant(geometry.voxel_size_m);
  std::vector<Eigen::Vector3f> centers;
  const VoxelRange range = voxelsIn(geometry, Box(box.min() - edge, box.max() + edge));
  for (const std::uint32_t v : collect(geometry, range, [&](const Eigen::Vector3d& p) {
         return states.at(geometry.voxelAt(p)) == VoxelState::Occupied;
       }))
    centers.push_back(geometry.center(geometry.voxel(v)).cast<float>());
  return centers;
}

std::uint64_t countUnknown(const StateGrid& states, const Sphere& sphere) {
  const GridGeometry& geometry = states.geometry();
  const Eigen::Vector3d radius = Eigen::Vector3d::Constant(sphere.radius);
  const VoxelRange range = voxelsIn(geometry, Box(sphere.center - radius, sphere.center + radius));
  std::uint64_t unknown = 0;
  for (int k = range.first.z(); k <= range.last.z(); ++k)
    for (int j = range.first.y(); j <= range.last.y(); ++j)
      for (int i = range.first.x(); i <= range.last.x(); ++i)
        unknown +=
            states.at(i, j, k) == VoxelState::Unknown &&
            (geometry.center({i, j, k}) - sphere.center).squaredNorm() <= sphere.radius * sphere.radius;
  return unknown;
}

}  // namespace vantage
