#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viewer/voxel_faces.h"

namespace vantage {

/// Faces of voxels with those that lie in one plane merged to rectangles. Covers exactly what the single
/// faces cover, without cracks: where a corner of one rectangle lies on the edge of another it is a vertex of
/// both.
struct MergedFaces {
  std::vector<Eigen::Vector3f> corners;  ///< world, metres
  /// Counter-clockwise seen from the side that the voxels face.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::size_t faces = 0;       ///< single faces that they stand for
  std::size_t rectangles = 0;  ///< after merging
  bool empty() const { return triangles.empty(); }
};

/// The faces of extractFaces(), merged. Parallel; the result does not depend on the number of threads. Empty
/// for an empty grid or box.
MergedFaces extractMergedFaces(const StateGrid& grid, VoxelState of, FaceRule rule, const Box& clip_world);

}  // namespace vantage
