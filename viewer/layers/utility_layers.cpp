// The factors of eq. 1 per candidate: as faces of the view sphere, or as frusta where candidates lie
// anywhere.
#include <vtkActor.h>
#include <vtkProperty.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/geometry/icosphere.h"
#include "viewer/layers/layer.h"
#include "viewer/layers/shapes.h"
#include "viewer/view_words.h"

namespace vantage {
namespace {

using Mark = LegendEntry::Mark;

/// Why a candidate has no colour.
enum class Fallen { No, Position, Registration, Executed, Path };
constexpr Fallen kReasons[] = {Fallen::Position, Fallen::Registration, Fallen::Executed, Fallen::Path};

Fallen fallenOf(const ViewUtility& view) {
  if (view.rejection == ViewRejection::Position) return Fallen::Position;
  if (view.rejection == ViewRejection::Registration) return Fallen::Registration;
  if (view.rejection == ViewRejection::Executed) return Fallen::Executed;
  return isUnreachable(view.reachability) ? Fallen::Path : Fallen::No;
}

Rgb colorOf(Fallen fallen) {
  return fallen == Fallen::Position       ? palette::kRejectedPosition
         : fallen == Fallen::Registration ? palette::kRejectedRegistration
         : fallen == Fallen::Executed     ? palette::kRejectedExecuted
                                          : palette::kRejectedPath;
}

double factorOf(const ViewUtility& view, UtilityFactor factor) {
  switch (factor) {
    case UtilityFactor::Unknown:
      return view.unknown;
    case UtilityFactor::Occupied:
      return view.occupied;
    case UtilityFactor::Distance:
      return view.distance;
    case UtilityFactor::Utility:
      break;
  }
  return view.utility;
}

/// Scale over the survivors of the cascade: from 0 to a round number above the largest.
ColorScale scaleOf(const SceneFrame& frame, const LayerStyle& style) {
  const UtilityFactor factor = style.utility_factor;
  const std::string unit = countUnit(frame);
  ColorScale scale;
  scale.map = mapOf(style);
  double most = 0.0;
  for (const ViewUtility& view : frame.record.utilities->views)
    if (fallenOf(view) == Fallen::No) most = std::max(most, factorOf(view, factor));
  const double step = most > 0.0 ? std::pow(10.0, std::floor(std::log10(most)) - 1.0) * 5.0 : 1.0;
  scale.high = most > 0.0 ? std::ceil(most / step - 1e-9) * step : 1.0;
  switch (factor) {
    case UtilityFactor::Unknown:
      scale.title = "unknown in view, " + unit;
      break;
    case UtilityFactor::Occupied:
      scale.title = "known surface in view, " + unit;
      break;
    case UtilityFactor::Distance:
      scale.title = "distance factor, 1 = no motion";
      break;
    case UtilityFactor::Utility:
      scale.title = "utility: surface factor × distance factor";
      break;
  }
  return scale;
}

/// Triangles with one colour each.
struct Patches {
  std::vector<Eigen::Vector3f> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Rgb> colors;

  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, Rgb color) {
    const auto first = static_cast<std::uint32_t>(points.size());
    for (const Eigen::Vector3d& p : {a, b, c}) points.push_back(p.cast<float>());
    triangles.push_back({first, first + 1, first + 2});
    colors.push_back(color);
  }
  /// A straight mark of some width in the plane with that normal.
  void addStroke(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& normal,
                 double width_m, Rgb color) {
    const Eigen::Vector3d side = normal.cross(to - from).normalized() * width_m / 2;
    add(from - side, to - side, to + side, color);
    add(from - side, to + side, from + side, color);
  }
};

/// A face of the view sphere.
struct SphereFace {
  std::array<Eigen::Vector3d, 3> corners;  ///< counter-clockwise seen from outside
  Eigen::Vector3d middle, normal;

  SphereFace shrunk(double share) const {
    SphereFace small = *this;
    for (Eigen::Vector3d& corner : small.corners) corner = middle + share * (corner - middle);
    return small;
  }
  double size() const { return (corners[0] - middle).norm(); }
};

SphereFace faceOf(const Icosphere& sphere, std::size_t face, const Eigen::Vector3d& center, double radius_m) {
  SphereFace out;
  for (int c = 0; c < 3; ++c) out.corners[c] = center + radius_m * sphere.vertices[sphere.faces[face][c]];
  out.middle = (out.corners[0] + out.corners[1] + out.corners[2]) / 3.0;
  out.normal = (out.middle - center).normalized();
  return out;
}

/// A ring as strokes between its corners: (1, 0) turned.
constexpr int kRingCorners = 10;
std::pair<double, double> ringCorner(int n) {
  const double angle_rad = 2.0 * std::numbers::pi * n / kRingCorners;
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

/// Reasons differ by mark, not by colour alone: a cross, stripes, a ring, a diamond.
void addReason(Patches& marks, const SphereFace& face, Fallen fallen) {
  constexpr Rgb kMark = rgb(96, 98, 104);
  const double size = face.size(), width = 0.08 * size;
  const Eigen::Vector3d u = (face.corners[0] - face.middle).normalized(), v = face.normal.cross(u);
  const auto at = [&](double x, double y) { return Eigen::Vector3d(face.middle + size * (x * u + y * v)); };
  if (fallen == Fallen::Position) {
    marks.addStroke(at(-0.18, -0.18), at(0.18, 0.18), face.normal, width, kMark);
    marks.addStroke(at(-0.18, 0.18), at(0.18, -0.18), face.normal, width, kMark);
  } else if (fallen == Fallen::Registration) {
    for (const double x : {-0.24, 0.0, 0.24})
      marks.addStroke(at(x, -0.2), at(x, 0.2), face.normal, width, rgb(150, 152, 156));
  } else if (fallen == Fallen::Executed) {
    for (int n = 0; n < kRingCorners; ++n) {
      const auto [x0, y0] = ringCorner(n);
      const auto [x1, y1] = ringCorner(n + 1);
      marks.addStroke(at(0.2 * x0, 0.2 * y0), at(0.2 * x1, 0.2 * y1), face.normal, width, kMark);
    }
  } else if (fallen == Fallen::Path) {
    marks.add(at(-0.2, 0.0), at(0.0, -0.2), at(0.2, 0.0), kMark);
    marks.add(at(-0.2, 0.0), at(0.2, 0.0), at(0.0, 0.2), kMark);
  }
}

void addReasonLegend(LayerContent& content, Fallen fallen) {
  switch (fallen) {
    case Fallen::Position:
      content.legend.push_back(
          {Mark::Crossed, colorOf(fallen), 1.0, "rejected: the sensor does not fit there"});
      break;
    case Fallen::Registration:
      content.legend.push_back(
          {Mark::Striped, colorOf(fallen), 1.0, "rejected: too little known surface in view"});
      break;
    case Fallen::Executed:
      content.legend.push_back({Mark::Ringed, colorOf(fallen), 1.0, "rejected: near a view taken before"});
      break;
    case Fallen::Path:
      content.legend.push_back({Mark::Diamond, colorOf(fallen), 1.0, "better, but cannot be reached"});
      break;
    case Fallen::No:
      break;
  }
}

void addReasonLegends(LayerContent& content, const UtilitySearch& search) {
  for (const Fallen fallen : kReasons) {
    if (std::ranges::any_of(search.views, [&](const ViewUtility& v) { return fallenOf(v) == fallen; }))
      addReasonLegend(content, fallen);
  }
}

/// A face of the view sphere, not a recorded pose or one drawn in the workspace.
bool onSphere(const SceneFrame& frame, const ViewUtility& view) {
  return frame.header.octree->planner.generator == CandidateGenerator::Icosphere && view.frame < 0;
}

/// The far half in full, seen from inside; of the near half small patches, so that the scene shows between
/// them.
void addSphere(LayerContent& content, const SceneFrame& frame, const LayerStyle& style) {
  constexpr double kFar = 0.90, kNear = 0.34;
  const OctreeHeader& octree = *frame.header.octree;
  const UtilitySearch& search = *frame.record.utilities;
  const Icosphere sphere = makeIcosphere(octree.planner.icosphere_subdivisions);
  const Eigen::Vector3d center = octree.object_box.center();
  const double radius_m = octree.planner.sphere_radius_m;
  Patches far, near, marks;
  for (const ViewUtility& view : search.views) {
    if (!onSphere(frame, view) || view.id >= sphere.faces.size()) continue;
    const Fallen fallen = fallenOf(view);
    const Rgb color = fallen == Fallen::No
                          ? colorAt(mapOf(style), factorOf(view, style.utility_factor) / content.scale->high)
                          : colorOf(fallen);
    const SphereFace face = faceOf(sphere, view.id, center, radius_m);
    const SphereFace large = face.shrunk(kFar), small = face.shrunk(kNear);
    far.add(large.corners[0], large.corners[1], large.corners[2], color);
    if (fallen == Fallen::No) near.add(small.corners[0], small.corners[1], small.corners[2], color);
    SphereFace lifted = large;  // seen from inside: the marks lie before the faces
    lifted.middle -= 0.004 * radius_m * face.normal;
    addReason(marks, lifted, fallen);
    for (const Eigen::Vector3d& corner : face.corners) content.must_see.push_back(corner);
  }
  if (far.triangles.empty()) return;
  content.props.push_back(
      flatTriangleActor(far.points, far.triangles, far.colors, FaceSide::AwayFromEye, 1.0));
  if (!near.triangles.empty()) {
    content.legend.push_back({Mark::Fill, colorAt(mapOf(style), 0.5), 1.0,
                              "candidate view: a face of the far side, a small triangle of the near side"});
    content.props.push_back(
        flatTriangleActor(near.points, near.triangles, near.colors, FaceSide::TowardEye, 1.0));
  }
  if (!marks.triangles.empty())
    content.props.push_back(
        flatTriangleActor(marks.points, marks.triangles, marks.colors, FaceSide::AwayFromEye, 1.0));
  const ViewUtility* chosen = chosenUtility(search);
  if (chosen && onSphere(frame, *chosen) && chosen->id < sphere.faces.size()) {
    const SphereFace face = faceOf(sphere, chosen->id, center, radius_m);
    for (int c = 0; c < 3; ++c)
      content.props.push_back(
          tubeActor({face.corners[c], face.corners[(c + 1) % 3]}, 0.008 * radius_m, palette::kChosen));
    content.legend.push_back({Mark::Line, palette::kChosen, 1.0, "chosen view"});
  }
}

/// Short frusta of the best views in the colours of the scale; the chosen one stands out.
void addBestFrusta(LayerContent& content, const SceneFrame& frame, const LayerStyle& style) {
  const UtilitySearch& search = *frame.record.utilities;
  const PinholeCamera camera = viewCamera(frame);
  LineSet lines;
  int drawn = 0;
  for (const std::uint32_t index : search.ranking) {
    const ViewUtility& view = search.views[index];
    if (onSphere(frame, view) || fallenOf(view) != Fallen::No || drawn++ >= style.ranked_views) continue;
    addFrustum(lines, camera, view.T_world_camera, style.frustum_length_m / 2);
    lines.colors.resize(lines.pieces.size(),
                        colorAt(mapOf(style), factorOf(view, style.utility_factor) / content.scale->high));
  }
  if (!lines.pieces.empty()) content.props.push_back(lineActor(lines, palette::kInk, 1.5 * style.line_scale));
  const ViewUtility* chosen = chosenUtility(search);
  if (!chosen || onSphere(frame, *chosen)) return;
  LineSet frustum;
  addFrustum(frustum, camera, chosen->T_world_camera, style.frustum_length_m);
  content.props.push_back(lineActor(frustum, palette::kChosen, 3.5 * style.line_scale));
  content.legend.push_back({Mark::Line, palette::kChosen, 1.0, "chosen view"});
}

/// Candidates off the sphere: dots in colours, frusta for the best, marks for those that fell out.
void addScattered(LayerContent& content, const SceneFrame& frame, const LayerStyle& style) {
  const UtilitySearch& search = *frame.record.utilities;
  std::vector<Eigen::Vector3d> eyes, few_known;
  std::vector<Rgb> colors;
  LineSet crosses, diamonds, rings;
  for (const ViewUtility& view : search.views) {
    if (onSphere(frame, view)) continue;
    const Eigen::Vector3d eye = view.T_world_camera.translation();
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX() * 0.008, z = Eigen::Vector3d::UnitZ() * 0.008;
    switch (fallenOf(view)) {
      case Fallen::No:
        eyes.push_back(eye);
        colors.push_back(colorAt(mapOf(style), factorOf(view, style.utility_factor) / content.scale->high));
        break;
      case Fallen::Position:
        crosses.add(eye - x - z, eye + x + z);
        crosses.add(eye - x + z, eye + x - z);
        break;
      case Fallen::Registration:
        few_known.push_back(eye);
        break;
      case Fallen::Executed:
        for (int n = 0; n < kRingCorners; ++n) {
          const auto [x0, z0] = ringCorner(n);
          const auto [x1, z1] = ringCorner(n + 1);
          rings.add(eye + x0 * x + z0 * z, eye + x1 * x + z1 * z);
        }
        break;
      case Fallen::Path:
        for (const auto& [a, b] : {std::pair{x, z}, {z, -x}, {-x, -z}, {-z, x}})
          diamonds.add(eye + 1.5 * a, eye + 1.5 * b);
        break;
    }
  }
  const double line = style.line_scale;
  addBestFrusta(content, frame, style);
  if (!eyes.empty()) {
    content.props.push_back(dotActor(eyes, colors, palette::kInk, 7.0 * line));
    content.legend.push_back(
        {Mark::Dot, colorAt(mapOf(style), 0.5), 1.0, "candidate views, with frusta of the best"});
  }
  if (!few_known.empty()) {
    content.props.push_back(dotActor(few_known, {}, palette::kRule, 2.5 * line));
    content.legend.push_back({Mark::Dot, palette::kRule, 1.0, "rejected: too little known surface in view"});
  }
  if (!crosses.pieces.empty()) {
    content.props.push_back(lineActor(crosses, palette::kUnreachable, 1.2 * line));
    content.legend.push_back(
        {Mark::Cross, palette::kUnreachable, 1.0, "rejected: the sensor does not fit there"});
  }
  if (!rings.pieces.empty()) {
    content.props.push_back(lineActor(rings, palette::kUnreachable, 1.2 * line));
    content.legend.push_back({Mark::Ringed, palette::kPaper, 1.0, "rejected: near a view taken before"});
  }
  if (!diamonds.pieces.empty()) {
    content.props.push_back(lineActor(diamonds, palette::kUnreachable, 1.5 * line));
    content.legend.push_back({Mark::Diamond, palette::kPaper, 1.0, "better, but cannot be reached"});
  }
}

}  // namespace

LayerContent utilitySphereLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  if (!frame.record.utilities || frame.record.utilities->views.empty() || !frame.header.octree)
    return content;
  const UtilitySearch& search = *frame.record.utilities;
  content.scale = scaleOf(frame, style);
  const auto on_sphere = [&](const ViewUtility& view) { return onSphere(frame, view); };
  if (std::ranges::any_of(search.views, on_sphere)) {
    addSphere(content, frame, style);
    addReasonLegends(content, search);
  }
  if (!std::ranges::all_of(search.views, on_sphere)) addScattered(content, frame, style);
  return content;
}

}  // namespace vantage
