#pragma once

#include <array>

#include "core/raycasting/bundle.h"
#include "core/raycasting/hierarchical_caster.h"

namespace vantage::casting {

/// One view of the pyramid as the kernels see it: a bundle a level, all from the same origin.
struct HierarchicalView {
  std::array<Bundle, StatePyramid::kMaxCoarseLevels + 1> bundles;
  std::array<float, StatePyramid::kMaxCoarseLevels + 1> step_back_m{};  ///< D-A11
  int coarse_levels = 0;
  bool reaches = false;  ///< the origin is near enough for rays to meet the grid
  bool blocked = false;  ///< the sensor's own finest voxel is not free (D-A12)

  HierarchicalView(const StatePyramid& pyramid, const RayTree& tree, int levels, const Pose& T_world_camera,
                   const HierarchicalQuery& query);
};

/// Bundle of one level.
bool makeLevelBundle(const StateGrid& grid, int level, const RaySensor& sensor, const Pose& T_world_camera,
                     const HierarchicalQuery& query, Bundle& bundle);

/// True if the sensor stands in a voxel of the grid that is not free.
bool sensorIsBlocked(const Bundle& finest);

/// \throws std::invalid_argument if rays and grid are of different resolutions
void requireSameResolution(const StateGrid& finest, const RayTree& tree);

/// castHierarchical() and castUniformRays() on a chosen path.
RayCounts castHierarchicalOn(CpuPath path, const StatePyramid& pyramid, const RayTree& tree,
                             int coarse_levels, const Pose& T_world_camera, const HierarchicalQuery& query);
RayCounts castUniformRaysOn(CpuPath path, const StateGrid& grid, const RayTree& tree,
                            const Pose& T_world_camera, const HierarchicalQuery& query);

}  // namespace vantage::casting
