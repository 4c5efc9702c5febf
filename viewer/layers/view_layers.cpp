// Views: all candidate positions, the ranked frusta of the searched segment, the chosen view and the way
// there.
#include <vtkActor.h>
#include <vtkProperty.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "viewer/layers/layer.h"
#include "viewer/layers/shapes.h"
#include "viewer/view_words.h"

namespace vantage {
namespace {

/// "2 in collision, 1 beyond the joints".
std::string reasonsText(const std::map<Reachability, int>& refused) {
  std::string text;
  for (const auto& [verdict, count] : refused)
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + refusalWord(verdict);
  return text;
}

using Mark = LegendEntry::Mark;

struct GainRange {
  double low = 0.0, high = 1.0;
  double at(double gain) const { return (gain - low) / std::max(1e-9, high - low); }
};

/// From `low` to a round number above the best gain that can be had.
GainRange gainRange(double low, const std::vector<RankedPosition>& ranked) {
  double best = low;
  for (const RankedPosition& view : ranked) {
    if (!view.unreachable()) best = std::max(best, view.gain);
  }
  if (best <= low) return {low, low + 1.0};
  const double unit = std::pow(10.0, std::floor(std::log10(best)) - 1.0) * 5.0;
  return {low, std::ceil(best / unit - 1e-9) * unit};
}

void addCross(LineSet& lines, const Pose& pose, double half_m) {
  const Eigen::Vector3d c = pose.translation(), x = pose.linear().col(0) * half_m,
                        y = pose.linear().col(1) * half_m;
  lines.add(c - x - y, c + x + y);
  lines.add(c - x + y, c + x - y);
}

void addDashedFrustum(LineSet& lines, const PinholeCamera& camera, const Pose& pose, double depth_m) {
  const FrustumCorners corners = frustumCorners(camera, pose, depth_m);
  for (int i = 0; i < 4; ++i) {
    lines.addDashed(corners.apex, corners.image[i], 0.012);
    lines.addDashed(corners.image[i], corners.image[(i + 1) % 4], 0.012);
  }
}

}  // namespace

LayerContent candidatesLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  std::vector<Eigen::Vector3d> eyes;
  if (frame.record.positions) {
    for (const ViewPosition& position : *frame.record.positions)
      eyes.push_back(position.T_world_camera.translation());
  } else if (frame.record.utilities) {
    for (const ViewUtility& view : frame.record.utilities->views)
      eyes.push_back(view.T_world_camera.translation());
  }
  if (eyes.empty()) return content;
  content.props.push_back(dotActor(eyes, {}, palette::kCandidate, 4.0 * style.line_scale));
  content.legend.push_back({Mark::Dot, palette::kCandidate, 1.0, "positions of all candidate views"});
  return content;
}

LayerContent rankedViewsLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const SegmentSearch* search = shownSearch(frame.record);
  const UtilitySearch* utilities = frame.record.utilities.get();
  if (!search && !utilities) return content;
  const std::vector<RankedPosition> ranked =
      search ? rankedPositions(frame, *search) : rankedViews(*utilities);
  const GainRange range = gainRange(search ? frame.header.contour_config.gain.gain_threshold : 0.0, ranked);
  const PinholeCamera camera = viewCamera(frame);
  LineSet colored, barred;
  std::map<Reachability, int> refused;
  int shown = 0, unreachable = 0;
  for (const RankedPosition& view : ranked) {
    if (view.unreachable()) {
      // They stand where no sensor goes: they don't widen the picture.
      if (unreachable++ >= style.unreachable_views) continue;
      ++refused[view.reachability];
      addDashedFrustum(barred, camera, view.T_world_camera, style.frustum_length_m);
      addCross(barred, view.T_world_camera, 0.014);
    } else if (shown++ < style.ranked_views) {
      const std::size_t before = colored.pieces.size();
      const FrustumCorners corners = frustumCorners(camera, view.T_world_camera, style.frustum_length_m);
      content.must_see.push_back(corners.apex);
      content.must_see.insert(content.must_see.end(), corners.image.begin(), corners.image.end());
      addFrustum(colored, camera, view.T_world_camera, style.frustum_length_m);
      colored.colors.insert(colored.colors.end(), colored.pieces.size() - before,
                            colorAt(mapOf(style), range.at(view.gain)));
    }
  }
  if (!colored.pieces.empty()) {
    content.props.push_back(lineActor(colored, palette::kInk, 2.0 * style.line_scale));
    content.scale = ColorScale{
        mapOf(style),
        search ? "gain of the view, " + countUnit(frame) : "utility: surface factor × distance factor",
        range.low, range.high, false};
    content.legend.push_back(
        {Mark::Line, colorAt(mapOf(style), 0.5), 1.0,
         search ? "best positions above the threshold" : "views of the highest utility"});
  }
  if (!barred.pieces.empty()) {
    content.props.push_back(lineActor(barred, palette::kUnreachable, 1.2 * style.line_scale));
    content.legend.push_back(
        {Mark::Cross, palette::kUnreachable, 1.0, "better, but cannot be reached: " + reasonsText(refused)});
  }
  return content;
}

LayerContent chosenViewLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  if (!frame.record.hasView()) return content;
  const ChosenView& chosen = *frame.record.chosen();
  const double distance = lookDistance(frame), length = chosenFrustumLength(frame);
  const PinholeCamera camera = viewCamera(frame);
  LineSet frustum;
  addFrustum(frustum, camera, chosen.T_world_camera, length);
  content.props.push_back(lineActor(frustum, palette::kChosen, 3.5 * style.line_scale));
  LineSet axis;
  axis.addDashed(chosen.T_world_camera.translation(),
                 chosen.T_world_camera * Eigen::Vector3d(0.0, 0.0, distance), 0.012);
  content.props.push_back(lineActor(axis, palette::kChosen, 2.0 * style.line_scale));
  content.props.push_back(dotActor({chosen.T_world_camera * Eigen::Vector3d(0.0, 0.0, distance)}, {},
                                   palette::kChosen, 11.0 * style.line_scale));
  const FrustumCorners corners = frustumCorners(camera, chosen.T_world_camera, length);
  content.must_see.assign(corners.image.begin(), corners.image.end());
  content.must_see.push_back(corners.apex);
  content.legend.push_back({Mark::Line, palette::kChosen, 1.0, "chosen view"});
  content.legend.push_back(
      {Mark::Dashed, palette::kChosen, 1.0,
       frame.record.utilities ? "its optical axis" : "its optical axis to the contour point"});

  const SegmentSearch* search = shownSearch(frame.record);
  if (search && search->sphere.radius > 0.0) {
    LineSet sphere;
    const double radius = search->sphere.radius;
    for (int axis_index = 0; axis_index < 3; ++axis_index) {
      sphere.addCircle(search->sphere.center, radius, Eigen::Vector3d::Unit(axis_index));
    }
    content.props.push_back(lineActor(sphere, palette::kInk, 1.2 * style.line_scale));
    content.legend.push_back({Mark::Line, palette::kInk, 1.0, "sphere in which unknown counts"});
  }
  return content;
}

LayerContent pathLayer(const SceneFrame& frame, const LayerStyle&) {
  LayerContent content;
  if (!frame.record.hasView()) return content;
  const MotionPlan& plan = frame.record.chosen()->path;
  if (plan.waypoints.size() < 2) return content;
  std::vector<Eigen::Vector3d> line;
  for (const Pose& pose : plan.waypoints) {
    if (line.empty() || (pose.translation() - line.back()).norm() > 1e-6) line.push_back(pose.translation());
  }
  if (line.size() < 2) return content;
  content.props.push_back(tubeActor(line, 0.006, palette::kPath));
  content.props.push_back(ballActor(line.front(), 0.014, palette::kPath));
  content.props.push_back(ballActor(line.back(), 0.014, palette::kChosen));
  content.legend.push_back({Mark::Line, palette::kPath, 1.0, "path of the sensor to it"});
  content.must_see = line;
  return content;
}

}  // namespace vantage
