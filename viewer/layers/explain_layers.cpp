// What a view sees: the voxels that its rays count, and what stands before others.
#include <algorithm>

#include "viewer/captions.h"
#include "viewer/layers/layer.h"
#include "viewer/layers/shapes.h"
#include "viewer/view_hits.h"
#include "viewer/view_trace.h"

namespace vantage {
namespace {

using Mark = LegendEntry::Mark;

constexpr double kPeriod_voxels = 3.0;  ///< of the stripes

/// "1 204 rays on 310 voxels"
std::string countText(const RayGroup& group) {
  return grouped(group.rays) + (group.rays == 1 ? " ray on " : " rays on ") + grouped(group.voxels.size()) +
         (group.voxels.size() == 1 ? " voxel" : " voxels");
}

/// Voxels that shine: found even where a voxel is smaller than a pixel.
void addLit(LayerContent& content, const GridGeometry& grid, const std::vector<std::size_t>& voxels,
            double line_scale) {
  const FaceMesh faces = facesOf(grid, voxels);
  LineSet edges;
  addEdges(edges, faces);
  std::vector<Eigen::Vector3d> centers;
  for (const std::size_t index : voxels) centers.push_back(grid.center(grid.voxel(index)));
  content.props.push_back(faceActor(faces, palette::kLit, 1.0));
  content.props.push_back(lineActor(edges, palette::kUnknownEdge, 1.0 * line_scale, 0.6));
  // A colour for each dot, which stays in every theme: they lie on the faces, not on the background.
  const std::vector<Rgb> colors(centers.size(), palette::kLit);
  content.props.push_back(dotActor(centers, colors, palette::kLit, 5.0 * line_scale));
}

/// Striped voxels with their legend.
void addHatched(LayerContent& content, const GridGeometry& grid, const std::vector<std::size_t>& voxels,
                double period_m, Rgb color, const std::string& text) {
  if (voxels.empty()) return;
  content.props.push_back(hatchedActor(facesOf(grid, voxels), color, period_m));
  const auto same = [&](const LegendEntry& entry) { return entry.text == text; };
  if (std::ranges::none_of(content.legend, same)) content.legend.push_back({Mark::Striped, color, 1.0, text});
}

/// The voxels and their neighbours of the same state: a ray of a reduced picture stands for those around it.
std::vector<std::size_t> withNeighbours(const StateGrid& states, const std::vector<std::size_t>& voxels) {
  const GridGeometry& grid = states.geometry();
  std::vector<std::size_t> all;
  for (const std::size_t index : voxels) {
    const Eigen::Vector3i voxel = grid.voxel(index);
    for (int n = 0; n < 27; ++n) {
      const Eigen::Vector3i near = voxel + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
      if (grid.contains(near) && states.at(near) == states.at(voxel)) all.push_back(grid.index(near));
    }
  }
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Nodes of a level on which rays with a fate end in or before the object's box, ascending.
std::vector<std::size_t> nodesBefore(const SceneFrame& frame, const ViewTrace& trace, int level,
                                     RayFate fate) {
  const GridGeometry& grid = frame.pyramid->level(level).geometry();
  const Pose& pose = trace.view->T_world_camera;
  std::vector<std::size_t> nodes;
  for (const TracedRay& ray : trace.rays) {
    if (ray.level != level || ray.fate != fate || (ray.node.array() < 0).any()) continue;
    const Eigen::Vector3d along = pose.linear() * directionOf(*frame.tree, ray);
    if (leavesAt(frame.header.octree->object_box, pose.translation(), along) > ray.end_m)
      nodes.push_back(grid.index(ray.node));
  }
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

LayerContent octreeOccluders(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const std::optional<ViewTrace> trace = traceView(frame, style);
  if (!trace) return content;
  struct Reason {
    RayFate fate;
    Rgb color;
    const char* text;
  };
  constexpr const char* kKnown = "known surface in or before the object's box that ends rays";
  constexpr Reason kReasons[] = {
      {RayFate::Occupied, palette::kOccluder, kKnown},
      {RayFate::Outside, palette::kOccluder, kKnown},
      {RayFate::OutsideUnknown, palette::kUnknown, "unknown that ends rays before the object's box"},
      {RayFate::TooNear, palette::kChosen, "ends rays nearer than the sensor sees"}};
  const double period_m = kPeriod_voxels * frame.pyramid->finest().geometry().voxel_size_m;
  for (const Reason& reason : kReasons) {
    for (int level = 0; level <= trace->coarse_levels; ++level)
      addHatched(content, frame.pyramid->level(level).geometry(),
                 nodesBefore(frame, *trace, level, reason.fate), period_m, reason.color, reason.text);
  }
  return content;
}

}  // namespace

LayerContent contourHitsLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const std::optional<ViewHits> hits = castView(frame, style);
  if (!hits) return content;
  if (!hits->counted.voxels.empty()) {
    addLit(content, frame.states.geometry(), hits->counted.voxels, style.line_scale);
    content.legend.push_back(
        {Mark::Fill, palette::kLit, 1.0,
         "unknown that view " + std::to_string(hits->view) + " counts: " + countText(hits->counted)});
  }
  if (hits->region.radius > 0.0) {
    LineSet sphere;
    for (int axis = 0; axis < 3; ++axis)
      sphere.addCircle(hits->region.center, hits->region.radius, Eigen::Vector3d::Unit(axis));
    content.props.push_back(lineActor(sphere, palette::kInk, 1.2 * style.line_scale));
    content.legend.push_back({Mark::Line, palette::kInk, 1.0, "sphere in which unknown counts"});
  }
  return content;
}

LayerContent occludersLayer(const SceneFrame& frame, const LayerStyle& style) {
  if (onOctree(frame)) return octreeOccluders(frame, style);
  LayerContent content;
  const std::optional<ViewHits> hits = castView(frame, style);
  if (!hits) return content;
  const GridGeometry& grid = frame.states.geometry();
  RayGroup occupied{hits->known.rays + hits->occluded.rays, {}};
  std::ranges::merge(hits->known.voxels, hits->occluded.voxels, std::back_inserter(occupied.voxels));
  const auto add = [&](const RayGroup& group, Rgb color, const std::string& text) {
    addHatched(content, grid, withNeighbours(frame.states, group.voxels), kPeriod_voxels * grid.voxel_size_m,
               color, text + countText(group));
  };
  add(occupied, palette::kOccluder, "known surface in or before the region, ends ");
  add(hits->unknown_before, palette::kUnknown, "unknown before the region, ends ");
  add(hits->too_near, palette::kChosen, "nearer than the camera sees, ends ");
  return content;
}

}  // namespace vantage
