#pragma once

#include <cstdint>
#include <functional>

#include "core/motion/path_planner.h"

namespace vantage {

/// Machine-independent work of a search for views and why views fell out.
struct SearchCounts {
  std::uint64_t poses_generated = 0;
  std::uint64_t poses_scored = 0;
  std::uint64_t poses_above_threshold = 0;
  std::uint64_t poses_unreachable = 0;  ///< above the threshold, tried before the chosen one and skipped
  /// Skipped since they were taken before: contour planner: above the threshold and better than the chosen
  /// one (D-B15); hierarchical planner: all.
  std::uint64_t poses_executed_before = 0;
  std::uint64_t rays = 0;            ///< rays cast to score poses; shared ones once
  std::uint64_t voxels_visited = 0;  ///< by a plain walk of those rays
  std::uint64_t paths_planned = 0;   ///< calls of the path planner
};

/// The next best view, whoever chose it.
struct ChosenView {
  std::uint32_t id = 0;
  Pose T_world_camera = Pose::Identity();
  double gain = 0.0;              ///< rays that end on unknown and count
  std::uint64_t gain_voxels = 0;  ///< distinct first-hit unknown voxels that count, full resolution
  MotionPlan path;
};

/// Answers whether the robot can take a pose and how. Called in rank order, from the calling thread.
using ReachPose = std::function<MotionPlan(const Pose& T_world_camera)>;

}  // namespace vantage
