// What each layer depends on, in two tables: products and fields of the style.
#include "viewer/layers/layer_inputs.h"

#include <array>
#include <bit>

namespace vantage {
namespace {

// What a layer reads of a frame, beside workspace, volume, camera and octree settings.
enum Product : unsigned {
  kNothing = 0,
  kMap = 1 << 0,
  kTruth = 1 << 1,
  kScan = 1 << 2,
  kContours = 1 << 3,
  kSurface = 1 << 4,
  kLabels = 1 << 5,
  kSaliency = 1 << 6,
  kPositions = 1 << 7,
  kSearch = 1 << 8,
  kUtilities = 1 << 9,
  kGain = 1 << 10,  ///< settings of gains and candidate views
  kArm = 1 << 11,
  kTrajectory = 1 << 12,
};

// What a layer reads of a style.
enum Field : unsigned {
  kNone = 0,
  kUnknownOpacity = 1 << 0,
  kFreeOpacity = 1 << 1,
  kTruthOpacity = 1 << 2,
  kSurfaceOpacity = 1 << 3,
  kSaliencyMax = 1 << 4,
  kBestViews = 1 << 5,  ///< how many, and how long their frusta are
  kSlices = 1 << 6,
  kOctreeLevel = 1 << 7,
  kViewId = 1 << 8,
  kRays = 1 << 9,
  kFactor = 1 << 10,
  kLabels_px = 1 << 11,
  kLines = 1 << 12,
  kColors = 1 << 13,
  kSaliencyPart = 1 << 14,  ///< and the isolation distance
};

struct Reads {
  unsigned products, fields;
};

constexpr Reads readsOf(Layer layer) {
  switch (layer) {
    case Layer::Workspace:
    case Layer::ObjectBox:
      return {kNothing, kLines};
    case Layer::Axes:
      return {kNothing, kLabels_px};
    case Layer::Truth:
      return {kTruth, kTruthOpacity};
    case Layer::Occupied:
      return {kMap, kNone};
    case Layer::Unknown:
      return {kMap, kUnknownOpacity};
    case Layer::Free:
      return {kMap, kFreeOpacity};
    case Layer::Slices:
      return {kMap, kSlices};
    case Layer::Octree:
      return {kMap, kOctreeLevel | kUnknownOpacity | kLines};
    case Layer::Surface:
      return {kSurface, kSurfaceOpacity};
    case Layer::SegmentLabels:
      return {kSurface | kLabels | kSaliency | kSearch, kSurfaceOpacity};
    case Layer::Segments:
      return {kSurface | kLabels | kSaliency, kSurfaceOpacity | kSaliencyMax | kSaliencyPart | kColors};
    case Layer::SegmentRanks:
      return {kSurface | kLabels | kSaliency | kSearch, kSaliencyPart | kLabels_px};
    case Layer::ContourVoxels:
    case Layer::ContourPoints:
      return {kContours, kLines};
    case Layer::SurfaceNormals:
      return {kContours | kSurface, kLines};
    case Layer::ContourPoses:
      return {kContours | kPositions | kSearch | kGain, kViewId | kBestViews | kLines};
    case Layer::Candidates:
      return {kPositions | kUtilities, kLines};
    case Layer::UtilitySphere:
      return {kUtilities, kFactor | kBestViews | kLines | kColors};
    case Layer::HitVoxels:
      return {kMap | kPositions | kSearch | kUtilities | kGain, kViewId | kUnknownOpacity | kLines};
    case Layer::Occluders:
      return {kMap | kPositions | kSearch | kUtilities | kGain, kViewId};
    case Layer::CoarseRays:
    case Layer::RefinedRays:
      return {kMap | kUtilities, kViewId | kRays | kLines};
    case Layer::RankedViews:
      return {kPositions | kSearch | kUtilities | kGain, kBestViews | kLines | kColors};
    case Layer::ChosenView:
      return {kContours | kSearch | kUtilities, kLines};
    case Layer::Path:
      return {kSearch | kUtilities, kNone};
    case Layer::Arm:
      return {kScan | kArm, kNone};
    case Layer::ArmMotion:
      return {kScan | kArm | kTrajectory, kNone};
    case Layer::ClearBoxes:
      return {kArm, kLines};
    case Layer::Sensor:
      return {kScan, kLines};
    case Layer::DepthImage:
      return {kScan, kColors};
    case Layer::FilteredDepth:
      return {kScan, kColors | kLines};
  }
  return {~0u, ~0u};
}

/// Sizes and some hundred values of a mesh in one number; headers are copied, so its address says nothing.
std::uint64_t fingerprint(const TriangleMesh* mesh) {
  if (!mesh) return 0;
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  const auto add = [&](std::uint32_t value) { hash = (hash ^ value) * 1099511628211u; };
  add(static_cast<std::uint32_t>(mesh->triangles.size()));
  add(static_cast<std::uint32_t>(mesh->colors.size()));
  const std::size_t stride = mesh->vertices.size() / 256 + 1;
  for (std::size_t i = 0; i < mesh->vertices.size(); i += stride)
    for (int axis = 0; axis < 3; ++axis) add(std::bit_cast<std::uint32_t>(mesh->vertices[i][axis]));
  return hash;
}

bool sameBox(const Box& a, const Box& b) {
  return (a.isEmpty() && b.isEmpty()) || (a.min() == b.min() && a.max() == b.max());
}

bool sameCamera(const PinholeCamera& a, const PinholeCamera& b) {
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy && a.cx == b.cx &&
         a.cy == b.cy && a.min_range_m == b.min_range_m && a.max_range_m == b.max_range_m;
}

/// What is fixed for a run.
bool sameRun(const LayerInputs& a, const LayerInputs& b) {
  return a.volume == b.volume && sameBox(a.workspace, b.workspace) && sameCamera(a.camera, b.camera) &&
         a.octree == b.octree && sameBox(a.object_box, b.object_box) && a.planner == b.planner;
}

}  // namespace

LayerInputs::LayerInputs(const SceneFrame& frame)
    : map(frame.map),
      truth(fingerprint(frame.truth)),
      step(frame.record.step),
      scan_poses(frame.record.scan.size()),
      depth(frame.record.depth),
      contours(frame.record.contours),
      surface(frame.record.surface),
      labels(frame.record.labels),
      saliency(frame.record.saliency),
      positions(frame.record.positions),
      search(frame.record.search),
      utilities(frame.record.utilities),
      joints(frame.record.joints),
      trajectory(frame.record.trajectory),
      planner(plannerOf(frame)),
      camera(frame.header.camera),
      volume(frame.header.volume),
      workspace(frame.header.workspace),
      views(frame.header.contour_config.views),
      gain(frame.header.contour_config.gain),
      saliency_config(frame.header.contour_config.saliency) {
  arm = frame.header.arm ? frame.header.arm->model.name : "";
  if (!onOctree(frame)) return;
  octree = frame.header.octree->planner;
  object_box = frame.header.octree->object_box;
}

bool stillStands(Layer layer, const LayerInputs& a, const LayerInputs& b) {
  const unsigned reads = readsOf(layer).products;
  const auto same = [&](unsigned product, bool equal) { return !(reads & product) || equal; };
  return sameRun(a, b) && same(kMap, a.map && a.map == b.map) && same(kTruth, a.truth == b.truth) &&
         same(kScan, a.depth == b.depth && a.step == b.step && a.scan_poses == b.scan_poses) &&
         same(kContours, a.contours == b.contours) && same(kSurface, a.surface == b.surface) &&
         same(kLabels, a.labels == b.labels) &&
         same(kSaliency, a.saliency == b.saliency && a.saliency_config == b.saliency_config) &&
         same(kPositions, a.positions == b.positions) && same(kSearch, a.search == b.search) &&
         same(kUtilities, a.utilities == b.utilities) && same(kArm, a.joints == b.joints && a.arm == b.arm) &&
         same(kTrajectory, a.trajectory == b.trajectory) &&
         same(kGain, a.gain == b.gain && a.views == b.views);
}

bool sameStyle(Layer layer, const LayerStyle& a, const LayerStyle& b) {
  const unsigned reads = readsOf(layer).fields;
  const auto same = [&](unsigned field, bool equal) { return !(reads & field) || equal; };
  return same(kUnknownOpacity, a.unknown_opacity == b.unknown_opacity) &&
         same(kFreeOpacity, a.free_opacity == b.free_opacity) &&
         same(kTruthOpacity, a.truth_opacity == b.truth_opacity) &&
         same(kSurfaceOpacity, a.surface_opacity == b.surface_opacity) &&
         same(kSaliencyMax, a.saliency_max == b.saliency_max) &&
         same(kSaliencyPart,
              a.saliency_part == b.saliency_part && a.isolation_distance_m == b.isolation_distance_m) &&
         same(kBestViews, a.ranked_views == b.ranked_views && a.unreachable_views == b.unreachable_views &&
                              a.frustum_length_m == b.frustum_length_m) &&
         same(kSlices, a.slices == b.slices) && same(kOctreeLevel, a.octree_level == b.octree_level) &&
         same(kViewId, a.view_id == b.view_id) && same(kRays, a.coarse_rays == b.coarse_rays) &&
         same(kFactor, a.utility_factor == b.utility_factor) && same(kLabels_px, a.label_px == b.label_px) &&
         same(kLines, a.line_scale == b.line_scale) && same(kColors, a.color_map == b.color_map);
}

}  // namespace vantage
