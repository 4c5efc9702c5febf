#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "core/exploration/explorer.h"
#include "core/geometry/check.h"

namespace vantage {

PlannerKind ExplorationConfig::plannerOf(int step) const {
  return planners[std::min<std::size_t>(static_cast<std::size_t>(step), planners.size()) - 1];
}
bool ExplorationConfig::needsVolume() const {
  return !std::ranges::all_of(planners, usesOctree);
}
bool ExplorationConfig::needsOctree() const {
  return std::ranges::any_of(planners, usesOctree);
}
bool ExplorationConfig::serves(const std::vector<ScanPose>& left, const Pose& view) const {
  return serve_distance_m <= 0.0 || std::ranges::any_of(left, [&](const ScanPose& frame) {
           return isNear(frame.T_world_camera, view, serve_distance_m, serve_angle_rad);
         });
}
Box ExplorationConfig::objectBox() const {
  return octree.object_box.volume() > 0.0 ? octree.object_box : workspace;
}

WorldConfig ExplorationConfig::world() const {
  return {.keep_volume = needsVolume(),
          .keep_octree = needsOctree(),
          .volume = volume,
          .fusion = fusion,
          .octree = octree,
          .object_box = objectBox(),
          .coarse_levels = hierarchical.coarse_levels};
}

void ExplorationConfig::validate() const {
  if (planners.empty()) throw std::invalid_argument("exploration.planner is empty; name at least one");
  contour.validate();
  hierarchical.validate();
  octree.validate();
  if (needsOctree()) {
    const int most = maxCoarseLevels(hierarchical.sensor, octree.voxel_size_m);
    requireInRange("rays.coarse_levels", hierarchical.coarse_levels, 0, most);
  }
  requireInRange("dataset.serve_distance_m", serve_distance_m, 0.0, 1000.0);
  requireInRange("dataset.serve_angle_rad", serve_angle_rad, 0.0, std::numbers::pi);
  requireInRange("volume.voxel_size_m", volume.voxel_size_m, 1e-4, 1.0);
  for (int a = 0; a < 3; ++a) {
    requireInRange("volume.size", volume.size[a], 2, 1 << 20);
    requireInRange("workspace.max_m", workspace.max()[a], workspace.min()[a], 1e6);
  }
  fusion.validate(volume.voxel_size_m);
  filter.validate();
  scan.validate();
  requireInRange("exploration.steps", steps, 0, 100000);
}

}  // namespace vantage
