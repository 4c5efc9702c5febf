#pragma once

#include <optional>
#include <vector>

#include "core/perception/contours.h"
#include "core/perception/surface_cloud.h"
#include "viewer/scene_frame.h"
#include "viewer/view_settings.h"

namespace vantage {

inline constexpr double kNormalLength_m = 0.055;  ///< of normals in pictures

/// Where the normal of a contour point ends in pictures.
inline Eigen::Vector3d normalTip(const ContourPoint& point) {
  return point.position_m + kNormalLength_m * point.normal;
}

/// For each contour point the unit normal of the surface at the vertex nearest to it: the view direction that
/// eq. (4) gives instead of eq. (5) (D-B5, of the fused surface). Empty for a cloud without normals.
std::vector<Eigen::Vector3d> surfaceNormalsAt(const std::vector<ContourPoint>& points,
                                              const SurfaceCloud& surface);

/// One of the poses that a contour point generated.
struct PointPose {
  Pose T_world_camera = Pose::Identity();
  std::uint32_t id = 0;
  bool straight = false;    ///< from the direction of the normal, not tilted from it
  bool first_roll = false;  ///< image x axis as horizontal as can be
};

/// A contour point and all its poses, by id.
struct PointPoses {
  std::uint32_t point = 0;  ///< index into Contours::points
  std::uint32_t view = 0;   ///< the pose that the style or the planner chose
  std::vector<PointPose> poses;
};

/// Those of the contour point of shownView(); nothing without such a view. \throws InputError as shownView()
std::optional<PointPoses> shownPoses(const SceneFrame& frame, const LayerStyle& style);

}  // namespace vantage
