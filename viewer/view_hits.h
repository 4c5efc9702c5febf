#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "viewer/scene_frame.h"
#include "viewer/view_settings.h"

namespace vantage {

/// Rays that share a fate and the voxels on which they end.
struct RayGroup {
  std::uint64_t rays = 0;
  std::vector<std::size_t> voxels;  ///< GridGeometry::index(), ascending, each once
};

/// Where the rays of one candidate of the contour planner (or its baseline) end, cast at the planner's
/// resolution with the rays that its score counts. With GainMeasure::Volume the score counts more: what lies
/// behind the voxels given here.
struct ViewHits {
  std::uint32_t view = 0;  ///< candidate id
  Pose T_world_camera = Pose::Identity();
  Sphere region;            ///< in which unknown counts; radius 0 = the workspace
  std::uint64_t rays = 0;   ///< cast
  RayGroup counted;         ///< end on unknown in the region: PoseScore::unknown
  RayGroup known;           ///< end on occupied voxels in the region: PoseScore::occupied
  RayGroup occluded;        ///< aim at the region and end on occupied voxels before it
  RayGroup unknown_before;  ///< aim at it and end on unknown before it, which stops rays (D-B9)
  RayGroup too_near;        ///< aim at it and end nearer than the camera sees
};

/// The candidate that a picture of one view is about: the style's, else the chosen one, else the best that
/// was scored; nothing for steps of other planners or without candidates. \throws InputError naming the range
/// if the style asks for a view that is no candidate.
std::optional<std::uint32_t> shownView(const SceneFrame& frame, const LayerStyle& style);

/// The rays of shownView(); nothing without one or without a region for it. \throws InputError as shownView()
std::optional<ViewHits> castView(const SceneFrame& frame, const LayerStyle& style);

/// Distance at which a ray leaves a ball or a box for good; negative if it never enters it. \param direction
/// of unit length
double leavesAt(const Sphere& ball, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);
double leavesAt(const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

}  // namespace vantage
