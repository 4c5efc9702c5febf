#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/volume/tsdf_volume.h"

namespace vantage {

/// Triangle mesh of the zero crossing with one normal per vertex; its vertices are the planner's point cloud.
struct SurfaceCloud {
  std::vector<Eigen::Vector3f> points;   ///< world, metres
  std::vector<Eigen::Vector3f> normals;  ///< unit, outward
  std::vector<std::array<std::uint32_t, 3>>
      triangles;  ///< counter-clockwise seen from outside; empty for a plain cloud
};

/// Marching cubes at the zero crossing. Cells with a corner of weight below `weight_threshold` give no
/// triangles (D-B34); vertices are shared between cells, in an order that does not depend on the number of
/// threads; normals are the TSDF gradient (eq. 4, D-B32) interpolated at the vertex, and where that cancels
/// the voxel axis the vertex lies on. Empty for a map without a surface. \throws std::invalid_argument if
/// `weight_threshold` is below 1.
SurfaceCloud extractSurface(const TsdfVolume& volume, int weight_threshold);

}  // namespace vantage
