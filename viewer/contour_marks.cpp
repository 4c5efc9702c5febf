#include "viewer/contour_marks.h"

#include "core/planners/nearest_point.h"
#include "viewer/view_hits.h"

namespace vantage {

std::vector<Eigen::Vector3d> surfaceNormalsAt(const std::vector<ContourPoint>& points,
                                              const SurfaceCloud& surface) {
  std::vector<Eigen::Vector3d> normals;
  if (surface.points.empty() || surface.normals.size() != surface.points.size()) return normals;
  const NearestPoint nearest(surface.points);
  for (const ContourPoint& point : points)
    if (const auto index = nearest(point.position_m))
      normals.push_back(surface.normals[*index].cast<double>());
  return normals;
}

std::optional<PointPoses> shownPoses(const SceneFrame& frame, const LayerStyle& style) {
  const auto view = shownView(frame, style);
  const auto& contours = frame.record.contours;
  const ViewPosition* shown = view ? positionOf(frame, *view) : nullptr;
  if (!shown || !contours || shown->group >= contours->points.size()) return std::nullopt;
  const ContourViewConfig& config = frame.header.contour_config.views;
  const auto rolls = static_cast<int>(rollsOf(frame.header));
  PointPoses all{shown->group, *view, {}};
  const Eigen::Vector3d normal = contours->points[shown->group].normal.normalized();
  for (const ViewPosition& position : *frame.record.positions) {
    if (position.group != shown->group) continue;
    const bool straight = position.T_world_camera.linear().col(2).dot(-normal) > 1.0 - 1e-9;
    for (int roll = 0; roll < rolls; ++roll)
      all.poses.push_back({rolledPose(position, roll, config),
                           position.first_id + static_cast<std::uint32_t>(roll), straight, roll == 0});
  }
  return all;
}

}  // namespace vantage
