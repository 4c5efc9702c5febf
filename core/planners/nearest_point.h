#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/grid_geometry.h"

namespace vantage {

/// Exact nearest neighbours in a fixed set of points: points sorted into cubic cells, searched ring by ring.
class NearestPoint {
 public:
  /// Keeps a reference to `points`.
  explicit NearestPoint(const std::vector<Eigen::Vector3f>& points);

  /// Index of the nearest point, of equally near ones the lowest; nothing if there are no points.
  std::optional<std::uint32_t> operator()(const Eigen::Vector3d& p) const;

 private:
  struct Best;
  void searchCell(const Eigen::Vector3i& cell, const Eigen::Vector3d& p, Best& best) const;
  void searchRing(const Eigen::Vector3i& center, int ring, const Eigen::Vector3d& p, Best& best) const;
  Eigen::Vector3i clampedCell(const Eigen::Vector3d& p) const;

  const std::vector<Eigen::Vector3f>& points_;
  GridGeometry cells_;
  std::vector<std::uint32_t> first_;   ///< of each cell into sorted_, and the end
  std::vector<std::uint32_t> sorted_;  ///< point indices by cell, ascending within one
};

}  // namespace vantage
