#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/geometry/grid_geometry.h"
#include "viewer/color.h"

namespace vantage {

/// Everything that can be switched on in a view, in drawing order.
enum class Layer : std::uint8_t {
  Workspace,      ///< box of the workspace
  ObjectBox,      ///< what the hierarchical planner reconstructs (OBB)
  Axes,           ///< axes of the world at a lower corner of the workspace
  Truth,          ///< true scene
  Occupied,       ///< occupied voxels
  Unknown,        ///< frontier of unknown space: its faces toward free voxels
  Free,           ///< boundary of free space
  Slices,         ///< voxel states on planes
  Octree,         ///< occupied nodes and the frontier of unknown ones at one depth of the octree
  Surface,        ///< fused surface
  SegmentLabels,  ///< the same, a colour for each segment
  Segments,       ///< the same, coloured by saliency of its segments
  SegmentRanks,   ///< the order in which segments are tried, as numbers beside them
  ContourVoxels,
  ContourPoints,   ///< with their normals
  SurfaceNormals,  ///< normals of the surface at the contour points
  ContourPoses,    ///< all view poses of one contour point
  Candidates,      ///< positions of all candidate views
  UtilitySphere,   ///< utility of the hierarchical planner's candidates, on their sphere
  HitVoxels,       ///< what a view's score counts: unknown voxels; on the octree also known ones and nodes
  Occluders,       ///< what ends the rays of a view and is not counted as unknown, hatched
  CoarseRays,      ///< rays of a view at the level where tracing starts
  RefinedRays,     ///< their finer rays, in refined nodes
  RankedViews,     ///< frusta of the best views: of the searched segment, or by utility
  ChosenView,
  Path,           ///< motion to the chosen view
  Arm,            ///< the arm after the last scan
  ArmMotion,      ///< the arm on its way to the chosen view
  ClearBoxes,     ///< space around an arm that is vouched to be free
  Sensor,         ///< the sensor where the last scan was taken
  DepthImage,     ///< last depth image, beside the scene
  FilteredDepth,  ///< what the filters removed of it, in the scene and beside it
};
inline constexpr int kLayerCount = 32;

/// Name of a layer in files and on the command line, e.g. "contour-points".
std::string_view layerName(Layer layer);
/// What it is called where it is switched on and off, e.g. "frontier of unknown space".
std::string_view layerTitle(Layer layer);
std::optional<Layer> layerNamed(std::string_view name);
std::vector<std::string_view> layerNames();

/// Layers that are shown.
class LayerSet {
 public:
  LayerSet() = default;
  LayerSet(std::initializer_list<Layer> layers) {
    for (const Layer layer : layers) set(layer, true);
  }
  bool has(Layer layer) const { return shown_[static_cast<std::size_t>(layer)]; }
  void set(Layer layer, bool shown) { shown_[static_cast<std::size_t>(layer)] = shown; }
  bool operator==(const LayerSet&) const = default;

 private:
  std::array<bool, kLayerCount> shown_{};
};

/// What colours the candidates of the hierarchical planner (eq. 1).
enum class UtilityFactor : std::uint8_t { Utility, Unknown, Occupied, Distance };
/// `utility`, `unknown`, `occupied`, `distance`.
std::string_view factorName(UtilityFactor factor);
std::optional<UtilityFactor> factorNamed(std::string_view name);
std::vector<std::string_view> factorNames();

/// What colours the segments (eq. 12).
enum class SaliencyPart : std::uint8_t {
  Whole,      ///< saliency as the planner took it
  Roundness,  ///< d_min / d_max alone
  Isolation   ///< F alone
};
/// `saliency`, `roundness`, `isolation`.
std::string_view partName(SaliencyPart part);
std::optional<SaliencyPart> partNamed(std::string_view name);
std::vector<std::string_view> partNames();

/// A slice through the voxel states.
struct SlicePlane {
  bool shown = false;
  std::optional<double> at_m;  ///< on the axis of its normal, world, metres; empty = middle of the workspace
  bool operator==(const SlicePlane&) const = default;
};

/// How layers are drawn.
struct LayerStyle {
  double unknown_opacity = 0.15;  ///< of the unknown frontier, (0, 0.15]: what is behind must stay visible
  double free_opacity = 0.06;     ///< (0, 0.15]
  double saliency_max = 0.8;      ///< upper end of the saliency scale, the same for all steps, > 0
  SaliencyPart saliency_part = SaliencyPart::Whole;
  /// Segments are coloured and numbered as under this isolation distance B_th, metres, > 0 and at most the
  /// run's saliency.max_distance_m; empty = the run's.
  std::optional<double> isolation_distance_m;
  int ranked_views = 24;           ///< best positions that are drawn, 0..500
  int unreachable_views = 12;      ///< better ones that could not be reached, 0..500
  double frustum_length_m = 0.10;  ///< of ranked views, metres
  /// Slices with the normals x, y and z.
  std::array<SlicePlane, 3> slices = {SlicePlane{}, SlicePlane{true, {}}, SlicePlane{}};
  /// Nodes of the octree layer have edges of 2^level finest voxels, 0..8; empty = where tracing starts.
  std::optional<int> octree_level;
  std::optional<int>
      view_id;            ///< whose rays or poses are drawn, >= 0; empty = the chosen view, else the best
  int coarse_rays = 300;  ///< at most, evenly thinned, and their refined rays, 1..100000
  UtilityFactor utility_factor = UtilityFactor::Utility;
  double truth_opacity = 1.0;         ///< (0, 1]; below 1 the true scene is a ghost
  double surface_opacity = 1.0;       ///< (0, 1]
  double label_px = 15.0;             ///< text in the scene, pixels
  double line_scale = 1.0;            ///< widths of lines and points are multiplied by it, > 0
  std::optional<ColorMap> color_map;  ///< of layers with a scale; empty = each layer's own
  bool operator==(const LayerStyle&) const = default;
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// Colours of a layer with a scale. \param own those it has unless the style says otherwise
inline ColorMap mapOf(const LayerStyle& style, ColorMap own = ColorMap::Viridis) {
  return style.color_map.value_or(own);
}

inline constexpr double kUsualFov_rad = 0.4363323129985824;  ///< 25 deg

/// Where a scene is looked at from: world, metres.
struct Eye {
  Eigen::Vector3d position = Eigen::Vector3d(1.0, -1.0, 1.0);
  Eigen::Vector3d focus = Eigen::Vector3d::Zero();  ///< what it looks at and turns about
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();    ///< upward in the picture
  double fov_rad = kUsualFov_rad;                   ///< vertical aperture
  bool operator==(const Eye&) const = default;
  double distance() const { return (focus - position).norm(); }
};

/// What must be seen.
enum class CameraFocus : std::uint8_t {
  Workspace,
  Object,  ///< the object's box, if the step has one, else the workspace
  Segment  ///< the sphere of the segment that was tried, if there is one, else the workspace
};
/// `workspace`, `object`, `segment`.
std::string_view focusName(CameraFocus focus);
std::optional<CameraFocus> focusNamed(std::string_view name);
std::vector<std::string_view> focusNames();

/// Where the scene is looked at from; the same for every step, so that pictures can be compared (unless
/// the focus is another one in each). Sensors, views and paths that are shown and leave what must be seen
/// make the picture wider.
struct CameraView {
  double azimuth_rad = -1.0297442586766543;   ///< of the eye from +x about z; -59 deg, the robot is at -y
  double elevation_rad = 0.6806784082777885;  ///< above the horizon; 39 deg
  double fov_rad = kUsualFov_rad;             ///< vertical aperture
  CameraFocus focus = CameraFocus::Workspace;
  double zoom = 1.0;  ///< 1: what must be seen fills the picture
  /// Space before the workspace (-y) that must be seen too, metres, 0..10; empty = 0.2 in a known scene, else
  /// 0.
  std::optional<double> front_m;
  /// Share of the workspace's height that must be seen, (0, 1]; empty = 0.8 in a known scene, whose upper
  /// part is empty, else all of it.
  std::optional<double> height_share;
  std::optional<Eye> eye;  ///< exactly this one; then nothing else of the view counts
  bool operator==(const CameraView&) const = default;
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// What is adjusted of one layer.
struct LayerLook {
  double opacity = 1.0;               ///< multiplies that of the layer, [0, 1]
  double size = 1.0;                  ///< multiplies widths of lines, points and letters, [0.2, 5]
  std::optional<ColorMap> color_map;  ///< empty = that of the style, else the layer's own
  bool operator==(const LayerLook&) const = default;
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// A view of a step: layers, style, eye. Scene::show() and Scene::arrange() draw it.
struct ViewSettings {
  LayerSet layers;
  LayerStyle style;
  CameraView camera;
  std::array<LayerLook, kLayerCount> looks = {};
  /// What fills space (maps, surfaces, contours) is drawn only in this box, world, metres; empty =
  /// everywhere. Frusta, rays, paths, axes and the boxes of workspace and object are always whole.
  std::optional<Box> clip;

  LayerLook& look(Layer layer) { return looks[static_cast<std::size_t>(layer)]; }
  const LayerLook& look(Layer layer) const { return looks[static_cast<std::size_t>(layer)]; }
  bool operator==(const ViewSettings& other) const;
  /// Style, eye, looks and clip box. \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

}  // namespace vantage
