// Surfaces: the true scene, the fused surface, its segments by label and by saliency, and the order in which
// they are tried.
#include <vtkProperty.h>

#include <algorithm>

#include "viewer/layers/layer.h"
#include "viewer/layers/shapes.h"
#include "viewer/segment_scores.h"

namespace vantage {
namespace {

constexpr double kTruthMargin_m =
    0.10;  ///< around the mapped volume; what leaves it (walls of a room) would hide all
constexpr int kRankLabels = 5;

bool hasMesh(const StepRecord& record) {
  return record.surface && !record.surface->triangles.empty();
}

/// A colour for each label, 0 (no segment) first.
using LabelColors = std::vector<std::array<std::uint8_t, 3>>;

LabelColors saliencyColors(const std::vector<Segment>& segments, const LayerStyle& style) {
  LabelColors of_label(segments.size() + 1, palette::kNoSegment.bytes());
  for (const Segment& segment : segments) {
    if (segment.label < of_label.size()) {
      of_label[segment.label] = colorAt(mapOf(style), segment.saliency / style.saliency_max).bytes();
    }
  }
  return of_label;
}

/// Segments that are tried one after the other differ in lightness as well as in hue.
LabelColors distinctColors(const StepRecord& record) {
  const std::vector<Segment>& segments = record.saliency->segments;
  std::vector<std::uint32_t> order;  // labels; first those that are tried
  if (record.search)
    for (const SegmentSearch& tried : record.search->segments)
      if (tried.segment >= 0 && tried.segment < static_cast<int>(segments.size()))
        order.push_back(segments[tried.segment].label);
  for (const Segment& segment : segments)
    if (std::ranges::find(order, segment.label) == order.end()) order.push_back(segment.label);
  LabelColors of_label(segments.size() + 1, palette::kNoSegment.bytes());
  for (std::size_t i = 0; i < order.size(); ++i)
    if (order[i] < of_label.size())
      of_label[order[i]] = palette::kDistinct[i % palette::kDistinct.size()].bytes();
  return of_label;
}

std::vector<std::array<std::uint8_t, 3>> pointColors(const SurfaceCloud& surface, const Labels& labels,
                                                     const LabelColors& of_label) {
  std::vector<std::array<std::uint8_t, 3>> colors(surface.points.size(), palette::kNoSegment.bytes());
  for (std::size_t i = 0; i < std::min(colors.size(), labels.of_point.size()); ++i) {
    if (labels.of_point[i] < of_label.size()) colors[i] = of_label[labels.of_point[i]];
  }
  return colors;
}

bool hasSegments(const StepRecord& record) {
  return hasMesh(record) && record.labels && record.saliency;
}

vtkSmartPointer<vtkActor> segmentActor(const StepRecord& record, const LabelColors& of_label,
                                       const LayerStyle& style) {
  const SurfaceCloud& surface = *record.surface;
  return triangleActor(surface.points, surface.normals, surface.triangles,
                       pointColors(surface, *record.labels, of_label), palette::kSurface,
                       style.surface_opacity);
}

/// Where the number of a segment stands: on compact ones at the centre, on wide ones (table, wall) at the
/// point nearest to it that keeps clear of all other segments, so that it can't be taken for theirs.
Eigen::Vector3d numberPlace(const StepRecord& record, const Segment& segment) {
  constexpr double kCompact_m = 0.45, kClear_m = 0.35;
  constexpr std::size_t kMostOwn = 400, kMostOthers = 4000;
  if (segment.extent_m[0] <= kCompact_m || !record.surface || !record.labels) return segment.center_m;
  const std::vector<std::uint32_t>& label = record.labels->of_point;
  const std::size_t count = std::min(label.size(), record.surface->points.size());
  std::vector<Eigen::Vector3f> own, others;
  for (std::size_t i = 0; i < count; ++i) {
    if (label[i] != 0) (label[i] == segment.label ? own : others).push_back(record.surface->points[i]);
  }
  const std::size_t own_stride = own.size() / kMostOwn + 1, stride = others.size() / kMostOthers + 1;
  const Eigen::Vector3f center = segment.center_m.cast<float>();
  Eigen::Vector3f best = center;
  std::pair<double, double> best_rank{-1.0, 0.0};  // clearance first, then nearness to the centre
  for (std::size_t i = 0; i < own.size(); i += own_stride) {
    double clear_m = kClear_m;
    for (std::size_t j = 0; j < others.size(); j += stride)
      clear_m = std::min<double>(clear_m, (others[j] - own[i]).norm());
    const std::pair<double, double> rank{clear_m, -(own[i] - center).norm()};
    if (rank > best_rank) best_rank = rank, best = own[i];
  }
  return best.cast<double>();
}

}  // namespace

LayerContent truthLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  if (!frame.truth || frame.truth->empty()) return content;
  const TriangleMesh& mesh = *frame.truth;
  Box keep = frame.header.volume.bounds();
  keep.min().array() -= kTruthMargin_m;
  keep.max().array() += kTruthMargin_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint8_t, 3>> colors;
  const bool colored = mesh.colors.size() == mesh.triangles.size();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto inside = [&](std::uint32_t vertex) {
      return keep.contains(mesh.vertices[vertex].cast<double>());
    };
    if (!std::all_of(mesh.triangles[i].begin(), mesh.triangles[i].end(), inside)) continue;
    triangles.push_back(mesh.triangles[i]);
    if (colored) colors.push_back(mesh.colors[i]);
  }
  if (triangles.empty()) return content;
  const bool ghost = style.truth_opacity < 1.0;
  if (ghost) colors.clear();
  content.props.push_back(
      triangleActor(mesh.vertices, {}, triangles, colors, palette::kSurface, style.truth_opacity));
  content.legend.push_back({LegendEntry::Mark::Fill, palette::kSurface, ghost ? 0.4 : 1.0,
                            colored && !ghost ? "true scene, in its own colours" : "true scene"});
  return content;
}

/// Points that no triangles join.
LayerContent cloudLayer(const SurfaceCloud& cloud, const LayerStyle& style) {
  LayerContent content;
  std::vector<Eigen::Vector3d> points;
  points.reserve(cloud.points.size());
  for (const Eigen::Vector3f& p : cloud.points)
    if (p.allFinite()) points.push_back(p.cast<double>());
  if (points.empty()) return content;
  content.props.push_back(dotActor(points, {}, palette::kSurface, 3.0 * style.line_scale));
  content.legend.push_back({LegendEntry::Mark::Dot, palette::kSurface, 1.0, "points"});
  return content;
}

LayerContent surfaceLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  if (!frame.record.surface) return content;
  const SurfaceCloud& surface = *frame.record.surface;
  if (surface.triangles.empty()) return cloudLayer(surface, style);
  content.props.push_back(triangleActor(surface.points, surface.normals, surface.triangles, {},
                                        palette::kSurface, style.surface_opacity));
  content.legend.push_back({LegendEntry::Mark::Fill, palette::kSurface, 1.0, "fused surface"});
  return content;
}

LayerContent segmentLabelsLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const StepRecord& record = frame.record;
  if (!hasSegments(record)) return content;
  content.props.push_back(segmentActor(record, distinctColors(record), style));
  content.legend.push_back(
      {LegendEntry::Mark::Fill, palette::kDistinct[0], 1.0, "surface, a colour for each segment"});
  content.legend.push_back({LegendEntry::Mark::Fill, palette::kNoSegment, 1.0, "surface without a segment"});
  return content;
}

LayerContent segmentsLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const StepRecord& record = frame.record;
  if (!hasSegments(record)) return content;
  content.props.push_back(segmentActor(record, saliencyColors(shownSegments(frame, style), style), style));
  if (!record.saliency->segments.empty()) {
    const std::string title = asksOtherSaliency(style) ? saliencyWords(style) : "saliency of the segment";
    // Nothing is more salient than 1.
    content.scale = ColorScale{mapOf(style), title, 0.0, style.saliency_max, style.saliency_max < 1.0};
  }
  content.legend.push_back({LegendEntry::Mark::Fill, palette::kNoSegment, 1.0, "surface without a segment"});
  return content;
}

LayerContent segmentRanksLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const StepRecord& record = frame.record;
  if (!record.search || !record.saliency) return content;
  const std::vector<std::uint32_t> order = shownOrder(frame, style);
  const int numbered = std::min(kRankLabels, static_cast<int>(order.size()));
  for (int i = numbered - 1; i >= 0; --i) {  // the first one on top
    const std::int32_t of_segment = record.search->segments[order[i]].segment;
    if (of_segment < 0 || of_segment >= static_cast<int>(record.saliency->segments.size())) continue;
    const Segment& segment = record.saliency->segments[of_segment];
    content.props.push_back(plateProp(numberPlace(record, segment), std::to_string(i + 1),
                                      style.label_px * (i == 0 ? 1.4 : 1.1), palette::kInk));
  }
  if (!content.props.empty()) {
    content.legend.push_back({LegendEntry::Mark::Fill, rgb(255, 255, 255), 1.0,
                              asksOtherSaliency(style) ? "1 2 3 ...: order in which segments would be tried"
                                                       : "1 2 3 ...: order in which segments are tried"});
  }
  return content;
}

}  // namespace vantage
