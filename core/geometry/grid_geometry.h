#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace vantage {

/// Axis-aligned box in world coordinates, metres.
using Box = Eigen::AlignedBox3d;

/// A regular grid of cubic voxels. `origin_m` is the *centre* of voxel (0,0,0); linear order is x fastest.
struct GridGeometry {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  double voxel_size_m = 0.01;
  Eigen::Vector3i size = Eigen::Vector3i::Zero();

  std::size_t count() const { return static_cast<std::size_t>(size.x()) * size.y() * size.z(); }

  bool contains(const Eigen::Vector3i& v) const {
    return (v.array() >= 0).all() && (v.array() < size.array()).all();
  }
  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * size.y() + j) * size.x() + i;
  }
  std::size_t index(const Eigen::Vector3i& v) const { return index(v.x(), v.y(), v.z()); }
  Eigen::Vector3i voxel(std::size_t index) const {
    const std::size_t row = index / size.x();
    return {static_cast<int>(index % size.x()), static_cast<int>(row % size.y()),
            static_cast<int>(row / size.y())};
  }

  /// World position of a voxel centre.
  Eigen::Vector3d center(const Eigen::Vector3i& v) const {
    return origin_m + voxel_size_m * v.cast<double>();
  }
  /// Continuous voxel coordinates of a world point: integers at voxel centres.
  Eigen::Vector3d toGrid(const Eigen::Vector3d& p_world) const { return (p_world - origin_m) / voxel_size_m; }
  /// Voxel that contains a world point; may lie outside the grid.
  Eigen::Vector3i voxelAt(const Eigen::Vector3d& p_world) const {
    const Eigen::Vector3d g = toGrid(p_world);
    return {static_cast<int>(std::floor(g.x() + 0.5)), static_cast<int>(std::floor(g.y() + 0.5)),
            static_cast<int>(std::floor(g.z() + 0.5))};
  }
  /// Space covered by the voxels, half a voxel beyond the outer centres.
  Box bounds() const {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(voxel_size_m / 2);
    return {origin_m - half, center(size - Eigen::Vector3i::Ones()) + half};
  }

  bool operator==(const GridGeometry& o) const {
    return origin_m == o.origin_m && voxel_size_m == o.voxel_size_m && size == o.size;
  }
};

}  // namespace vantage
