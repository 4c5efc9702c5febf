#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/volume/state_grid.h"

namespace vantage {

/// Quads with shared corners; each quad counter-clockwise seen from the side that its voxel faces.
struct FaceMesh {
  std::vector<Eigen::Vector3f> corners;  ///< world, metres
  std::vector<std::array<std::uint32_t, 4>> quads;
  bool empty() const { return quads.empty(); }
};

/// Which faces of a voxel are drawn.
enum class FaceRule {
  TowardOther,  ///< toward any voxel of another state and toward the outside of the clip box or the grid
  TowardFree,   ///< toward free voxels only: the frontier, if the voxels are unknown
};

/// Faces of the voxels of one state whose centres lie in `clip_world`. Parallel; the result does not depend
/// on the number of threads. Empty for an empty grid or box.
FaceMesh extractFaces(const StateGrid& grid, VoxelState of, FaceRule rule, const Box& clip_world);

/// Outer faces of a set of voxels: those toward voxels that are not in it. \param voxels
/// GridGeometry::index(), ascending, each once
FaceMesh facesOf(const GridGeometry& grid, const std::vector<std::size_t>& voxels);

/// Every edge of the faces once, as pairs of corners.
std::vector<std::array<std::uint32_t, 2>> edgesOf(const FaceMesh& faces);

}  // namespace vantage
