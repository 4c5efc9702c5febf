#pragma once

#include <cstdint>
#include <vector>

#include "viewer/voxel_faces.h"

namespace vantage {

/// Half-open range of voxels.
struct VoxelRange {
  Eigen::Vector3i begin = Eigen::Vector3i::Zero(), end = Eigen::Vector3i::Zero();
  bool empty() const { return (end.array() <= begin.array()).any(); }
};

/// Voxels whose centres lie in a box.
VoxelRange voxelsIn(const GridGeometry& grid, const Box& box);

/// A face of voxel (i, j) of some layer; sides in the order -x +x -y +y -z +z.
struct VoxelFace {
  std::int32_t i, j;
  std::int32_t side;
};

/// Faces of the voxels of one state in layer k of a range, by row, column and side.
std::vector<VoxelFace> facesOfLayer(const StateGrid& grid, VoxelState of, FaceRule rule,
                                    const VoxelRange& range, int k);

}  // namespace vantage
