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

/// "1 204 rays on 310 voxels"
std::string countText(const RayGroup& group) {
  return grouped(group.rays) + (group.rays == 1 ? " ray on " : " rays on ") + grouped(group.voxels.size()) +
         (group.voxels.size() == 1 ? " voxel" : " voxels");
}

void addEdgedFaces(LayerContent& content, const FaceMesh& faces, Rgb fill, Rgb edge, double width_px) {
  LineSet edges;
  addEdges(edges, faces);
  content.props.push_back(faceActor(faces, fill, 1.0));
  content.props.push_back(lineActor(edges, edge, width_px, 0.6));
}

/// Striped voxels with their legend.
void addHatched(LayerContent& content, const GridGeometry& grid, const std::vector<std::size_t>& voxels,
                Rgb color, const std::string& text) {
  if (voxels.empty()) return;
  content.props.push_back(hatchedActor(facesOf(grid, voxels), color, 3.0 * grid.voxel_size_m));
  content.legend.push_back({Mark::Striped, color, 1.0, text});
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
  constexpr Reason kReasons[] = {
      {RayFate::Outside, palette::kOccluder, "occluder: a ray ends on it outside the object's box"},
      {RayFate::OutsideUnknown, palette::kUnknown, "unknown outside the object's box that ends rays"},
      {RayFate::TooNear, palette::kChosen, "nearer than the sensor sees"}};
  for (const Reason& reason : kReasons) {
    for (int level = 0; level <= trace->coarse_levels; ++level) {
      const std::vector<std::size_t> nodes = nodesHit(*trace, *frame.pyramid, level, reason.fate);
      const bool first = std::ranges::none_of(
          content.legend, [&](const LegendEntry& entry) { return entry.text == reason.text; });
      addHatched(content, frame.pyramid->level(level).geometry(), nodes, reason.color, reason.text);
      if (!nodes.empty() && !first) content.legend.pop_back();
    }
  }
  return content;
}

}  // namespace

LayerContent contourHitsLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const std::optional<ViewHits> hits = castView(frame, style);
  if (!hits) return content;
  if (!hits->counted.voxels.empty()) {
    const FaceMesh faces = facesOf(frame.states.geometry(), hits->counted.voxels);
    addEdgedFaces(content, faces, palette::kLit, palette::kUnknownEdge, 1.0 * style.line_scale);
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
  // Known surface ends rays wherever it lies; outside the region it hides what would count.
  RayGroup occupied{hits->known.rays + hits->occluded.rays, {}};
  std::ranges::merge(hits->known.voxels, hits->occluded.voxels, std::back_inserter(occupied.voxels));
  addHatched(content, grid, occupied.voxels, palette::kOccluder,
             "known surface that ends " + countText(occupied));
  addHatched(content, grid, hits->unknown_before.voxels, palette::kUnknown,
             "unknown outside the region that ends " + countText(hits->unknown_before));
  addHatched(content, grid, hits->too_near.voxels, palette::kChosen,
             "nearer than the camera sees, ends " + countText(hits->too_near));
  return content;
}

}  // namespace vantage
