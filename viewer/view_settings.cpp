#include "viewer/view_settings.h"

#include <algorithm>
#include <stdexcept>

#include "core/geometry/check.h"
#include "core/volume/state_pyramid.h"

namespace vantage {
namespace {

struct LayerWords {
  std::string_view name, title;
};
constexpr std::array<LayerWords, kLayerCount> kLayers = {{{"workspace", "workspace"},
                                                          {"object-box", "object's box"},
                                                          {"axes", "axes"},
                                                          {"truth", "true scene"},
                                                          {"occupied", "occupied voxels"},
                                                          {"unknown", "frontier of unknown space"},
                                                          {"free", "free space"},
                                                          {"slices", "slices"},
                                                          {"octree", "octree nodes"},
                                                          {"surface", "fused surface"},
                                                          {"segment-labels", "segments, each its colour"},
                                                          {"segments", "segments by saliency"},
                                                          {"segment-ranks", "order of the segments"},
                                                          {"contour-voxels", "contour voxels"},
                                                          {"contour-points", "contour points"},
                                                          {"surface-normals", "surface normals"},
                                                          {"contour-poses", "poses of a contour point"},
                                                          {"candidates", "candidate positions"},
                                                          {"utility-sphere", "utility of candidates"},
                                                          {"hit-voxels", "voxels that a view counts"},
                                                          {"occluders", "occluders of a view"},
                                                          {"coarse-rays", "coarse rays"},
                                                          {"refined-rays", "refined rays"},
                                                          {"ranked-views", "ranked views"},
                                                          {"chosen-view", "chosen view"},
                                                          {"path", "path"},
                                                          {"arm", "arm"},
                                                          {"arm-motion", "motion of the arm"},
                                                          {"clear-boxes", "space vouched for"},
                                                          {"sensor", "sensor"},
                                                          {"depth-image", "depth image"},
                                                          {"filtered-depth", "what the filters removed"}}};

constexpr std::array<std::string_view, 4> kFactors = {"utility", "unknown", "occupied", "distance"};
constexpr std::array<std::string_view, 3> kFocuses = {"workspace", "object", "segment"};
constexpr std::array<std::string_view, 3> kParts = {"saliency", "roundness", "isolation"};

/// The value of that name; the names stand in the order of the values.
template <class Value, std::size_t N>
std::optional<Value> valueNamed(const std::array<std::string_view, N>& names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Value>(found - names.begin());
}

}  // namespace

std::string_view factorName(UtilityFactor factor) {
  return kFactors[static_cast<std::size_t>(factor)];
}

std::optional<UtilityFactor> factorNamed(std::string_view name) {
  return valueNamed<UtilityFactor>(kFactors, name);
}

std::vector<std::string_view> factorNames() {
  return {kFactors.begin(), kFactors.end()};
}

std::string_view focusName(CameraFocus focus) {
  return kFocuses[static_cast<std::size_t>(focus)];
}

std::optional<CameraFocus> focusNamed(std::string_view name) {
  return valueNamed<CameraFocus>(kFocuses, name);
}

std::vector<std::string_view> focusNames() {
  return {kFocuses.begin(), kFocuses.end()};
}

std::string_view partName(SaliencyPart part) {
  return kParts[static_cast<std::size_t>(part)];
}

std::optional<SaliencyPart> partNamed(std::string_view name) {
  return valueNamed<SaliencyPart>(kParts, name);
}

std::vector<std::string_view> partNames() {
  return {kParts.begin(), kParts.end()};
}

std::string_view layerName(Layer layer) {
  return kLayers[static_cast<std::size_t>(layer)].name;
}

std::string_view layerTitle(Layer layer) {
  return kLayers[static_cast<std::size_t>(layer)].title;
}

std::optional<Layer> layerNamed(std::string_view name) {
  for (int i = 0; i < kLayerCount; ++i) {
    if (kLayers[i].name == name) return static_cast<Layer>(i);
  }
  return std::nullopt;
}

std::vector<std::string_view> layerNames() {
  std::vector<std::string_view> names;
  for (const LayerWords& layer : kLayers) names.push_back(layer.name);
  return names;
}

void LayerStyle::validate() const {
  requireInRange("unknown_opacity", unknown_opacity, 0.001, 0.15);
  requireInRange("free_opacity", free_opacity, 0.001, 0.15);
  requireInRange("saliency_max", saliency_max, 1e-6, 1e6);
  if (isolation_distance_m) requireInRange("isolation_distance_m", *isolation_distance_m, 1e-6, 10.0);
  requireInRange("ranked_views", ranked_views, 0, 500);
  requireInRange("unreachable_views", unreachable_views, 0, 500);
  requireInRange("frustum_length_m", frustum_length_m, 1e-3, 10.0);
  for (const SlicePlane& slice : slices)
    if (slice.at_m) requireInRange("slice_at_m", *slice.at_m, -1e6, 1e6);
  if (octree_level) requireInRange("octree_level", *octree_level, 0, StatePyramid::kMaxCoarseLevels);
  if (view_id) requireInRange("view_id", *view_id, 0, 100'000'000);
  requireInRange("coarse_rays", coarse_rays, 1, 100'000);
  requireInRange("truth_opacity", truth_opacity, 0.001, 1.0);
  requireInRange("surface_opacity", surface_opacity, 0.001, 1.0);
  requireInRange("label_px", label_px, 4.0, 200.0);
  requireInRange("line_scale", line_scale, 0.01, 20.0);
}

void CameraView::validate() const {
  constexpr double kSteepest_rad = 1.55;  // straight down there is no "up" in the picture
  requireInRange("azimuth_rad", azimuth_rad, -100.0, 100.0);
  requireInRange("elevation_rad", elevation_rad, -kSteepest_rad, kSteepest_rad);
  requireInRange("fov_rad", fov_rad, 0.01, 2.5);
  requireInRange("zoom", zoom, 0.01, 100.0);
  if (front_m) requireInRange("front_m", *front_m, 0.0, 10.0);
  if (height_share) requireInRange("height_share", *height_share, 0.01, 1.0);
  if (eye) requireInRange("eye.fov_rad", eye->fov_rad, 0.01, 2.5);
}

void LayerLook::validate() const {
  requireInRange("opacity", opacity, 0.0, 1.0);
  requireInRange("size", size, 0.2, 5.0);
}

bool ViewSettings::operator==(const ViewSettings& other) const {
  const bool same_clip = clip.has_value() == other.clip.has_value() &&
                         (!clip || (clip->min() == other.clip->min() && clip->max() == other.clip->max()));
  return layers == other.layers && style == other.style && camera == other.camera && looks == other.looks &&
         same_clip;
}

void ViewSettings::validate() const {
  style.validate();
  camera.validate();
  for (const LayerLook& each : looks) each.validate();
  if (clip && (clip->isEmpty() || !clip->min().allFinite() || !clip->max().allFinite()))
    throw std::invalid_argument("clip has no inside; its lower corner must lie below its upper one");
}

}  // namespace vantage
