// Contours: voxels where known surface ends at unknown space, and the points they are reduced to.
#include <algorithm>

#include "viewer/contour_marks.h"
#include "viewer/layers/layer.h"
#include "viewer/layers/shapes.h"

namespace vantage {
LayerContent contourVoxelsLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  if (!frame.record.contours || frame.record.contours->voxels.empty()) return content;
  std::vector<Eigen::Vector3d> centers;
  for (const ContourVoxel& voxel : frame.record.contours->voxels)
    centers.push_back(frame.header.volume.center(voxel.voxel));
  content.props.push_back(dotActor(centers, {}, palette::kContour, 3.0 * style.line_scale));
  content.legend.push_back(
      {LegendEntry::Mark::Dot, palette::kContour, 1.0, "contour voxels: free, touch surface and unknown"});
  return content;
}

LayerContent contourPointsLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  if (!frame.record.contours || frame.record.contours->points.empty()) return content;
  LineSet normals;
  std::vector<Eigen::Vector3d> tips;
  for (const ContourPoint& point : frame.record.contours->points) {
    const Eigen::Vector3d tip = normalTip(point);
    normals.add(point.position_m, tip);
    tips.push_back(tip);
  }
  content.props.push_back(lineActor(normals, palette::kNormal, 1.6 * style.line_scale));
  content.props.push_back(dotActor(tips, {}, palette::kNormal, 4.0 * style.line_scale));
  content.legend.push_back({LegendEntry::Mark::Line, palette::kNormal, 1.0,
                            "contour normal; the dot is its tip: views come from there"});
  return content;
}

LayerContent surfaceNormalsLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  if (!frame.record.contours || !frame.record.surface) return content;
  const std::vector<ContourPoint>& points = frame.record.contours->points;
  const std::vector<Eigen::Vector3d> normals = surfaceNormalsAt(points, *frame.record.surface);
  if (normals.empty()) return content;
  LineSet lines;
  for (std::size_t i = 0; i < normals.size(); ++i)
    lines.add(points[i].position_m, points[i].position_m + kNormalLength_m * normals[i]);
  content.props.push_back(lineActor(lines, palette::kSurfaceNormal, 1.6 * style.line_scale));
  content.legend.push_back(
      {LegendEntry::Mark::Line, palette::kSurfaceNormal, 1.0, "surface normal at the contour point"});
  return content;
}

LayerContent contourPosesLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const auto shown = shownPoses(frame, style);
  if (!shown) return content;
  const Eigen::Vector3d& target = frame.record.contours->points[shown->point].position_m;
  const PinholeCamera camera = viewCamera(frame);
  LineSet straight, tilted, rolled, axes, view;
  for (const PointPose& pose : shown->poses) {
    const FrustumCorners corners = frustumCorners(camera, pose.T_world_camera, style.frustum_length_m);
    content.must_see.insert(content.must_see.end(), corners.image.begin(), corners.image.end());
    content.must_see.push_back(corners.apex);
    if (pose.id == shown->view) addFrustum(view, camera, pose.T_world_camera, style.frustum_length_m);
    if (pose.first_roll) {
      addFrustum(pose.straight ? straight : tilted, camera, pose.T_world_camera, style.frustum_length_m);
      axes.addDashed(corners.apex, target, 0.012);
    } else {
      for (std::size_t i = 0; i < 4; ++i) rolled.add(corners.image[i], corners.image[(i + 1) % 4]);
    }
  }
  const auto draw = [&](const LineSet& lines, Rgb color, double width, LegendEntry::Mark mark,
                        const std::string& text) {
    if (lines.pieces.empty()) return;
    content.props.push_back(lineActor(lines, color, width * style.line_scale));
    content.legend.push_back({mark, color, 1.0, text});
  };
  using Mark = LegendEntry::Mark;
  constexpr double kPointRadius_m = 0.012;
  draw(rolled, palette::kCandidate, 1.2, Mark::Line, "images of the other rolls");
  draw(axes, palette::kInk, 1.6, Mark::Dashed, "optical axes to the contour point");
  draw(tilted, palette::kInk, 2.0, Mark::Line, "first roll from a tilted direction");
  draw(straight, palette::kContour, 3.0, Mark::Line, "first roll from the direction of the normal");
  draw(view, palette::kChosen, 4.0, Mark::Line, "view " + std::to_string(shown->view));
  content.props.push_back(ballActor(target, kPointRadius_m, palette::kNormal));
  content.legend.push_back(
      {Mark::Dot, palette::kNormal, 1.0, "contour point " + std::to_string(shown->point)});
  return content;
}

}  // namespace vantage
