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

}  // namespace vantage
