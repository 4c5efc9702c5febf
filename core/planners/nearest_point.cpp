#include "core/planners/nearest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage {

struct NearestPoint::Best {
  double squared = std::numeric_limits<double>::infinity();
  std::uint32_t index = 0;
};

NearestPoint::NearestPoint(const std::vector<Eigen::Vector3f>& points) : points_(points) {
  if (points.empty()) return;
  Box box;
  for (const Eigen::Vector3f& p : points) box.extend(p.cast<double>());
  // About two points a cell, for a surface in its bounding box, and never more cells than that is worth.
  constexpr double kSmallest_m = 0.01, kMostCells = 1 << 20;
  const double longest = box.sizes().maxCoeff();
  const double volume = (box.sizes().array() + kSmallest_m).prod();
  cells_.voxel_size_m = std::max({kSmallest_m, std::cbrt(volume / kMostCells), longest / 1000.0});
  cells_.origin_m = box.min();
  cells_.size = ((box.sizes() / cells_.voxel_size_m).array() + 0.5).floor().cast<int>() + 1;

  first_.assign(cells_.count() + 1, 0);
  std::vector<std::uint32_t> cell_of(points.size());
  for (std::size_t n = 0; n < points.size(); ++n) {
    cell_of[n] = static_cast<std::uint32_t>(cells_.index(clampedCell(points[n].cast<double>())));
    ++first_[cell_of[n] + 1];
  }
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  sorted_.resize(points.size());
  for (std::uint32_t n = 0; n < points.size(); ++n) sorted_[next[cell_of[n]]++] = n;
}

Eigen::Vector3i NearestPoint::clampedCell(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d g = (cells_.toGrid(p).array() + 0.5).floor();
  const Eigen::Vector3d last = (cells_.size.array() - 1).cast<double>();
  return g.cwiseMax(Eigen::Vector3d::Zero()).cwiseMin(last).cast<int>();
}

void NearestPoint::searchCell(const Eigen::Vector3i& cell, const Eigen::Vector3d& p, Best& best) const {
  const std::size_t c = cells_.index(cell);
  for (std::uint32_t n = first_[c]; n < first_[c + 1]; ++n) {
    const std::uint32_t index = sorted_[n];
    const double squared = (points_[index].cast<double>() - p).squaredNorm();
    if (squared < best.squared || (squared == best.squared && index < best.index)) best = {squared, index};
  }
}

void NearestPoint::searchRing(const Eigen::Vector3i& center, int ring, const Eigen::Vector3d& p,
                              Best& best) const {
  const Eigen::Vector3i low = (center.array() - ring).max(0);
  const Eigen::Vector3i high = (center.array() + ring).min(cells_.size.array() - 1);
  for (int z = low.z(); z <= high.z(); ++z)
    for (int y = low.y(); y <= high.y(); ++y) {
      const bool on_face = std::abs(z - center.z()) == ring || std::abs(y - center.y()) == ring;
      if (on_face) {
        for (int x = low.x(); x <= high.x(); ++x) searchCell({x, y, z}, p, best);
        continue;
      }
      if (center.x() - ring >= 0) searchCell({center.x() - ring, y, z}, p, best);
      if (center.x() + ring < cells_.size.x()) searchCell({center.x() + ring, y, z}, p, best);
    }
}

std::optional<std::uint32_t> NearestPoint::operator()(const Eigen::Vector3d& p) const {
  if (points_.empty() || !p.allFinite()) return std::nullopt;
  const Eigen::Vector3i center = clampedCell(p);
  Best best;
  const int last_ring = cells_.size.maxCoeff();
  for (int ring = 0; ring <= last_ring; ++ring) {
    // Nothing in this ring or beyond is nearer than so many cells; the slack covers points on a cell's
    // border.
    const double at_least = (ring - 1) * cells_.voxel_size_m * (1.0 - 1e-9);
    if (at_least > 0.0 && best.squared < at_least * at_least) break;
    searchRing(center, ring, p, best);
  }
  return best.index;
}

}  // namespace vantage
