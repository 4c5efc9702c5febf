#pragma once

#include <vector>

#include "core/raycasting/uniform_caster.h"

namespace vantage {

/// Where one ray of an image ends, and whether it counts.
struct FirstHit {
  int u = 0, v = 0;         ///< pixel of the ray
  double distance_m = 0.0;  ///< from the camera to the entry into the voxel
  std::size_t voxel = 0;    ///< GridGeometry::index()
  VoxelState state = VoxelState::Unknown;
  bool too_near = false;  ///< nearer than the camera sees: it ends the ray and counts nothing
  bool counts = false;    ///< not too near, and its voxel lies in the region of the query
};

/// The first hits behind the counts of castUniform() with the same arguments, in pixel order; rays that hit
/// nothing are left out. One voxel at a time: for showing one view, not for scoring many.
std::vector<FirstHit> firstHits(const StateGrid& grid, const PinholeCamera& camera,
                                const Pose& T_world_camera, const VisibilityQuery& query);

}  // namespace vantage
