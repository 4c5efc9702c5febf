#pragma once

// A block in free space, known on one side: what the hierarchical planner has to judge, made by hand.

#include <numbers>
#include <vector>

#include "core/planners/hierarchical_planner.h"

namespace vantage::test {

/// Map of 3 x 3 x 3 m with voxels of 5 cm, all free but for the block in the object's box: occupied at
/// x < 0, unknown from there on.
struct HalfKnownBlock {
  static constexpr double kVoxel_m = 0.05;
  Box object_box{Eigen::Vector3d(-0.3, -0.3, -0.3), Eigen::Vector3d(0.3, 0.3, 0.3)};
  StateGrid states = makeStates();

  HierarchicalPlannerConfig config() const {
    HierarchicalPlannerConfig c;
    c.sensor.min_range_m = 0.1;
    c.sensor.max_range_m = 2.0;
    c.coarse_levels = 1;
    c.min_occupied = 10;
    c.stop_gain = 5;
    return c;
  }
  StatePyramid pyramid(int coarse_levels = 3) const {
    return StatePyramid(states, firstVoxelOf(states.geometry()), coarse_levels);
  }
  RayTree tree(int coarse_levels = 3) const { return RayTree(config().sensor, kVoxel_m, coarse_levels); }

 private:
  StateGrid makeStates() const {
    GridGeometry geometry;
    geometry.voxel_size_m = kVoxel_m;
    geometry.origin_m.setConstant(-1.5 + kVoxel_m / 2);
    geometry.size.setConstant(60);
    StateGrid grid(geometry);
    for (std::size_t n = 0; n < geometry.count(); ++n) {
      const Eigen::Vector3i v = geometry.voxel(n);
      const Eigen::Vector3d p = geometry.center(v);
      const bool known = p.x() < 0;
      grid.set(v, !object_box.contains(p) ? VoxelState::Free
                  : known                 ? VoxelState::Occupied
                                          : VoxelState::Unknown);
    }
    grid.rebuildFreeRadius();
    return grid;
  }
};

/// Candidates with ids in order.
inline std::vector<ViewCandidate> candidatesOf(const std::vector<Pose>& poses) {
  std::vector<ViewCandidate> result;
  for (const Pose& pose : poses) result.push_back({static_cast<std::uint32_t>(result.size()), pose});
  return result;
}

/// Everything is reachable.
inline MotionPlan reachAll(const Pose&) {
  MotionPlan plan;
  plan.verdict = Reachability::Reachable;
  return plan;
}

}  // namespace vantage::test
