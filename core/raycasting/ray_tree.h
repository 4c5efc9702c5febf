#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/raycasting/ray_family.h"

namespace vantage {

/// Where the grid of rays lies in the aperture (D-A1).
enum class RayAnchor : std::uint8_t { Centered, Literal };

/// Perspective range sensor as the hierarchical planner sees it (sections 2 and 8).
struct RaySensor {
  double horizontal_fov_rad = 0.99483767363676789;  ///< full aperture, radians, (0, pi); 57 deg
  double vertical_fov_rad = 0.75049157835756175;    ///< full aperture, radians, (0, pi); 43 deg
  double min_range_m = 0.4;                         ///< nearer hits are lost (D-A22), metres, >= 0
  double max_range_m = 2.8;                         ///< d, depth of view, metres, > min_range_m
  RayAnchor anchor = RayAnchor::Centered;
  bool operator==(const RaySensor&) const = default;
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// Angles and families along one axis of a ray grid. Rays and their families are products of both axes, since
/// the nearest parent can be found per axis.
struct RayAxis {
  std::vector<double> angle_rad;
  /// Parent on the next coarser level (D-A2: ties go to the lower index); empty on the coarsest.
  std::vector<std::uint32_t> parent;
  /// Children on the next finer level: [first_child[i], first_child[i+1]); empty on the finest.
  std::vector<std::uint32_t> first_child;
  std::vector<std::uint32_t> leaves;  ///< finest rows (columns) below each one
  std::uint32_t count() const { return static_cast<std::uint32_t>(angle_rad.size()); }
};

/// Rays of a level in family order, for the casting kernels: children of a ray follow each other, and so do
/// those of its neighbours.
struct RayFamilies {
  std::vector<std::uint32_t> ray;       ///< RayLevel::index()
  std::vector<float> slope_x, slope_y;  ///< of these rays, and kMargin entries beyond
  std::vector<RayFamily> family;        ///< of these rays; empty on the finest level
  std::uint32_t most_children = 0;      ///< of a family
  static constexpr int kMargin = 8;
};

/// Rays of a level in tiles of 4 x 4, the packets of the casting kernels: 16 entries a tile. Lanes beyond the
/// grid of rays repeat a ray and are masked out.
struct RayTiles {
  std::vector<float> slope_x, slope_y;
  std::vector<std::uint32_t> ray;    ///< RayLevel::index()
  std::vector<std::uint32_t> place;  ///< in family order
  std::vector<std::uint16_t> lanes;  ///< one mask a tile
};

/// Rays for one resolution (eq. 6): direction of row j, column k is
/// (cos b_j sin a_k, sin b_j, cos b_j cos a_k) in the sensor frame, +z along the director ray.
struct RayLevel {
  double voxel_size_m = 0.0;
  double step_rad = 0.0;  ///< delta_i = arcsin(l_i / d)
  RayAxis rows, columns;
  std::uint32_t count() const { return rows.count() * columns.count(); }
  std::uint32_t index(std::uint32_t row, std::uint32_t column) const {
    return row * columns.count() + column;
  }
  std::uint32_t leaves(std::uint32_t row, std::uint32_t column) const {
    return rows.leaves[row] * columns.leaves[column];  // lf(r)
  }
  Eigen::Vector3d direction(std::uint32_t row, std::uint32_t column) const;
  /// The same as slopes x/z and y/z, in single precision as all casters use them; index() order.
  std::vector<float> slope_x, slope_y;
  RayFamilies families;
  RayTiles tiles;
};

/// All levels of rays of a sensor, coarse to fine linked by families; depends on the sensor and the
/// resolution alone (section 5).
class RayTree {
 public:
  RayTree() = default;
  /// \param coarse_levels m = dmax - k, 0..8. \throws std::invalid_argument naming field, value and range: a
  /// sensor out of range, or a level without two rays per axis (voxels above d sin(min(a_h, a_v, 90 deg))).
  RayTree(const RaySensor& sensor, double voxel_size_m, int coarse_levels);

  static constexpr int kMaxCoarseLevels = 8;

  const RaySensor& sensor() const { return sensor_; }
  int coarseLevels() const { return static_cast<int>(levels_.size()) - 1; }
  /// Level 0 is the finest (octree depth 16), coarseLevels() the start.
  const RayLevel& level(int i) const { return levels_[i]; }

 private:
  RaySensor sensor_;
  std::vector<RayLevel> levels_;
};

/// Coarsest level that a sensor allows at a resolution, at most 8; -1 if even the finest is too coarse.
int maxCoarseLevels(const RaySensor& sensor, double voxel_size_m);

}  // namespace vantage
