// What orients the eye: the workspace box and the axes of the world.
#include "viewer/layers/layer.h"
#include "viewer/layers/shapes.h"

namespace vantage {
namespace {

bool boxesAgree(const Box& a, const Box& b) {
  constexpr double kSame_m = 1e-3;
  return !a.isEmpty() && !b.isEmpty() && (a.min() - b.min()).norm() < kSame_m &&
         (a.max() - b.max()).norm() < kSame_m;
}

}  // namespace

LayerContent workspaceLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const Box& box = frame.header.workspace;
  if (box.isEmpty()) return content;
  if (onOctree(frame) && boxesAgree(box, frame.header.octree->object_box))
    return objectBoxLayer(frame, style);
  LineSet edges;
  addBox(edges, box);
  content.props.push_back(lineActor(edges, palette::kRule, 1.2 * style.line_scale));
  content.legend.push_back({LegendEntry::Mark::Line, palette::kRule, 1.0, "workspace"});
  return content;
}

LayerContent objectBoxLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  if (!onOctree(frame) || frame.header.octree->object_box.isEmpty()) return content;
  const Box& box = frame.header.octree->object_box;
  LineSet edges;
  addBox(edges, box);
  content.props.push_back(lineActor(edges, palette::kObjectBox, 1.6 * style.line_scale));
  content.legend.push_back({LegendEntry::Mark::Line, palette::kObjectBox, 1.0,
                            boxesAgree(box, frame.header.workspace) ? "object's box, also the workspace"
                                                                    : "object's box: what is to be seen"});
  return content;
}

LayerContent axesLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const Box& box = frame.header.workspace;
  if (box.isEmpty()) return content;
  const double length = 0.12 * box.sizes().maxCoeff();
  const Eigen::Vector3d origin = box.min() + Eigen::Vector3d(0.0, 0.0, 0.02);  // clear of the floor
  const char* names[3] = {"x", "y", "z"};
  const Rgb colors[3] = {rgb(190, 50, 40), rgb(20, 130, 80), rgb(30, 80, 190)};
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d end = origin + length * Eigen::Vector3d::Unit(axis);
    content.props.push_back(tubeActor({origin, end}, 0.03 * length, colors[axis]));
    content.props.push_back(
        labelProp(origin + 1.25 * length * Eigen::Vector3d::Unit(axis) + Eigen::Vector3d(0.0, 0.0, 0.03),
                  names[axis], style.label_px, colors[axis]));
  }
  return content;
}

}  // namespace vantage
