#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/volume/tsdf_volume.h"

namespace vantage {

/// Triangle mesh of the zero crossing with one normal per vertex; its vertices are the planner's point cloud.
struct SurfaceCloud {
  std::vector<Eigen::Vector3f> points;                 ///< world, metres
  std::vector<Eigen::Vector3f> normals;                ///< unit, outward
  std::vector<std::array<std::uint32_t, 3>> triangles; ///< counter-clockwise seen from outside; empty for a plain cloud
};

/// Marching cubes at the zero crossing. Cells with a corner of weight below `weight_threshold` give no
/// triangles (D-B34); vertices are shared between cells, in a fixed order; normals are the interpolated TSDF
/// gradient (eq. 4, D-B32).
SurfaceCloud extractSurface(const TsdfVolume& volume, int weight_threshold);

}  // namespace vantage
