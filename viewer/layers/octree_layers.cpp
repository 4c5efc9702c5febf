// The octree at one depth, and the rays of a view through it.
#include <vtkActor.h>
#include <vtkProperty.h>

#include <algorithm>

#include "viewer/captions.h"
#include "viewer/layers/layer.h"
#include "viewer/layers/shapes.h"
#include "viewer/view_trace.h"

namespace vantage {
namespace {

using Mark = LegendEntry::Mark;

struct FateStyle {
  RayFate fate;
  Rgb color;
  double width;    ///< pixels
  double opacity;  ///< rays that count for nothing stand back
  const char* text;
};
constexpr const char* kNothing = "ray that counts for nothing: missed, or ended outside the object's box";
constexpr FateStyle kFates[] = {
    {RayFate::Missed, palette::kRayMissed, 1.0, 0.35, kNothing},
    {RayFate::Outside, palette::kRayMissed, 1.0, 0.35, kNothing},
    {RayFate::OutsideUnknown, palette::kRayMissed, 1.0, 0.35, kNothing},
    {RayFate::TooNear, palette::kInk, 1.0, 0.5, "ray that ended nearer than the sensor sees"},
    {RayFate::Refined, palette::kRayRefined, 1.2, 0.7, "ray that hit an occupied node: refined"},
    {RayFate::Unknown, palette::kUnknown, 1.2, 0.7, "ray that ended on unknown: counted"},
    {RayFate::Occupied, palette::kRayOccupied, 1.2, 0.8, "ray that ended on an occupied voxel: counted"}};

/// What must be seen of a view's rays and the part of space in which those that hit nothing are drawn.
Box raySpace(const SceneFrame& frame, const ViewTrace& trace) {
  Box space = frame.header.octree->object_box;
  if (!frame.header.workspace.isEmpty()) space.extend(frame.header.workspace);
  space.extend(trace.view->T_world_camera.translation());
  return space;
}

/// The part of a ray before it leaves a box that holds its origin, metres.
double lengthInside(const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& along) {
  double leave = 1e9;
  for (int a = 0; a < 3; ++a) {
    if (std::abs(along[a]) < 1e-12) continue;
    leave = std::min(leave, ((along[a] > 0.0 ? box.max()[a] : box.min()[a]) - origin[a]) / along[a]);
  }
  return std::max(0.0, leave);
}

/// The rays with one fate as lines from where they began to where they ended.
LineSet rayLines(const SceneFrame& frame, const ViewTrace& trace, const std::vector<std::size_t>& drawn,
                 RayFate fate) {
  const Box space = raySpace(frame, trace);
  const Pose& pose = trace.view->T_world_camera;
  LineSet lines;
  for (const std::size_t index : drawn) {
    const TracedRay& ray = trace.rays[index];
    if (ray.fate != fate) continue;
    const Eigen::Vector3d along = pose.linear() * directionOf(*frame.tree, ray);
    double end_m = ray.end_m;
    const bool counts = fate == RayFate::Refined || fate == RayFate::Unknown || fate == RayFate::Occupied;
    if (!counts) end_m = std::min(end_m, lengthInside(space, pose.translation(), along));
    if (end_m > ray.start_m)
      lines.add(pose.translation() + ray.start_m * along, pose.translation() + end_m * along);
  }
  return lines;
}

void addRays(LayerContent& content, const SceneFrame& frame, const LayerStyle& style, const ViewTrace& trace,
             const std::vector<std::size_t>& drawn) {
  for (const FateStyle& fate : kFates) {
    const LineSet lines = rayLines(frame, trace, drawn, fate.fate);
    if (lines.pieces.empty()) continue;
    content.props.push_back(lineActor(lines, fate.color, fate.width * style.line_scale, fate.opacity));
    content.legend.push_back({Mark::Line, fate.color, 1.0, fate.text});
  }
}

/// Translucent cubes with edges, which fade where they are so many that they would cover all.
void addNodes(LayerContent& content, const FaceMesh& faces, Rgb fill, double opacity, Rgb edge,
              double width_px, double edge_opacity) {
  constexpr double kFewEdges = 2500.0, kFaintest = 0.06;
  if (faces.empty()) return;
  if (opacity > 0.0) content.props.push_back(faceActor(faces, fill, opacity));
  if (edge_opacity <= 0.0) return;
  LineSet edges;
  addEdges(edges, faces);
  const double share = std::min(1.0, kFewEdges / static_cast<double>(edges.pieces.size()));
  content.props.push_back(lineActor(edges, edge, width_px, std::max(kFaintest, edge_opacity * share)));
}

std::string edgeText(const StatePyramid& pyramid, int level) {
  return lengthText(pyramid.level(level).geometry().voxel_size_m);
}

/// The faces whose middle lies in a box, and the others.
std::pair<FaceMesh, FaceMesh> splitFaces(const FaceMesh& faces, const Box& box) {
  std::pair<FaceMesh, FaceMesh> parts;
  parts.first.corners = parts.second.corners = faces.corners;
  for (const auto& quad : faces.quads) {
    const Eigen::Vector3f middle = (faces.corners[quad[0]] + faces.corners[quad[2]]) / 2.0f;
    (box.contains(middle.cast<double>()) ? parts.first : parts.second).quads.push_back(quad);
  }
  return parts;
}

}  // namespace

LayerContent octreeLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  if (!onOctree(frame)) return content;
  const StatePyramid& pyramid = *frame.pyramid;
  const int level = std::min(style.octree_level.value_or(coarseLevels(frame)), pyramid.coarseLevels());
  const StateGrid& nodes = pyramid.level(level);
  const Box clip = occupiedBox(frame);
  const Box node_clip = nodesInBox(frame, level);  // only these count
  for (int c = 0; !node_clip.isEmpty() && c < 8; ++c)
    content.must_see.push_back(node_clip.corner(static_cast<Box::CornerType>(c)));

  const FaceMesh solid = extractFaces(pyramid.finest(), VoxelState::Occupied, FaceRule::TowardOther, clip);
  const double half_m = pyramid.finest().geometry().voxel_size_m / 2;
  const Box& object = frame.header.octree->object_box;
  const auto [inside, around] =
      splitFaces(solid, Box(object.min().array() - half_m, object.max().array() + half_m));
  if (!around.empty()) {
    content.props.push_back(faceActor(around, palette::kAround, 1.0));
    content.legend.push_back({Mark::Fill, palette::kAround, 1.0, "occupied, outside the object's box"});
  }
  if (!inside.empty()) {
    content.props.push_back(faceActor(inside, palette::kOccupied, 1.0));
    content.legend.push_back(
        {Mark::Fill, palette::kOccupied, 1.0, "occupied voxels in the box, " + edgeText(pyramid, 0)});
  }
  if (level > 0) {
    const FaceMesh cubes = extractFaces(nodes, VoxelState::Occupied, FaceRule::TowardOther, node_clip);
    addNodes(content, cubes, palette::kNode, 0.10, palette::kNode, 1.2 * style.line_scale, 0.7);
    if (!cubes.empty())
      content.legend.push_back(
          {Mark::Line, palette::kNode, 1.0,
           "occupied nodes of " + edgeText(pyramid, level) + " that meet the object's box"});
  }
  const FaceMesh frontier = extractFaces(nodes, VoxelState::Unknown, FaceRule::TowardFree, node_clip);
  if (frontier.empty()) return content;
  addNodes(content, frontier, palette::kUnknown, style.unknown_opacity, palette::kUnknownEdge,
           1.0 * style.line_scale, level > 0 ? 0.6 : 0.0);
  content.legend.push_back(
      {Mark::Fill, palette::kUnknown, 0.45,
       "frontier of unknown " + std::string(level > 0 ? "nodes, " : "voxels, ") + edgeText(pyramid, level)});
  return content;
}

LayerContent coarseRaysLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const std::optional<ViewTrace> trace = traceView(frame, style);
  if (!trace) return content;
  const DrawnRays drawn = thinned(*trace, *frame.tree, style.coarse_rays);
  content.legend.push_back({Mark::Dot, palette::kChosen, 1.0, "eye of the view"});
  addRays(content, frame, style, *trace, drawn.coarse);
  content.props.push_back(
      dotActor({trace->view->T_world_camera.translation()}, {}, palette::kChosen, 12.0 * style.line_scale));
  content.must_see.push_back(trace->view->T_world_camera.translation());
  return content;
}

LayerContent refinedRaysLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const std::optional<ViewTrace> trace = traceView(frame, style);
  if (!trace) return content;
  const DrawnRays drawn = thinned(*trace, *frame.tree, style.coarse_rays);
  addRays(content, frame, style, *trace, drawn.refined);
  return content;
}

LayerContent hitVoxelsLayer(const SceneFrame& frame, const LayerStyle& style) {
  if (!onOctree(frame)) return contourHitsLayer(frame, style);
  LayerContent content;
  const std::optional<ViewTrace> trace = traceView(frame, style);
  if (!trace) return content;
  const StatePyramid& pyramid = *frame.pyramid;
  const auto hit = [&](int level, RayFate fate) {
    return facesOf(pyramid.level(level).geometry(), nodesHit(*trace, pyramid, level, fate));
  };
  const FaceMesh occupied = hit(0, RayFate::Occupied);  // coarser ones are refined
  if (!occupied.empty()) {
    content.props.push_back(faceActor(occupied, palette::kOccupied, 1.0));
    content.legend.push_back(
        {Mark::Fill, palette::kOccupied, 1.0, "known surface in view, voxels of " + edgeText(pyramid, 0)});
  }
  const int start = trace->coarse_levels;
  const FaceMesh refined = hit(start, RayFate::Refined);
  if (!refined.empty()) {
    addNodes(content, refined, palette::kRayRefined, 0.0, palette::kRayRefined, 1.0 * style.line_scale, 0.4);
    content.legend.push_back(
        {Mark::Fill, palette::kRayRefined, 0.25, "refined node, " + edgeText(pyramid, start)});
  }
  bool any_unknown = false;
  for (int level = 0; level <= start; ++level) {
    const FaceMesh unknown = hit(level, RayFate::Unknown);
    addNodes(content, unknown, palette::kUnknown, style.unknown_opacity, palette::kUnknownEdge,
             1.0 * style.line_scale, level > 0 ? 0.45 : 0.15);
    any_unknown = any_unknown || !unknown.empty();
  }
  if (any_unknown) {
    const std::string sizes =
        start > 0 ? "nodes of " + edgeText(pyramid, start) + " to " : std::string("voxels of ");
    content.legend.push_back(
        {Mark::Fill, palette::kUnknown, 0.45, "unknown in view, " + sizes + edgeText(pyramid, 0)});
  }
  return content;
}

}  // namespace vantage
