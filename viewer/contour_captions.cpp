// Figures of the contour planner's views, before they are scored.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "viewer/captions.h"
#include "viewer/contour_marks.h"
#include "viewer/view_words.h"

namespace vantage {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr const char* kNoPoints = "There are no contour points.";

/// Angles between the normals that pictures show, degrees, ascending.
std::vector<double> anglesBetween(const std::vector<ContourPoint>& points,
                                  const std::vector<Eigen::Vector3d>& surface_normals) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < surface_normals.size(); ++i)
    angles.push_back(std::acos(std::clamp(points[i].normal.normalized().dot(surface_normals[i]), -1.0, 1.0)) *
                     kDegrees);
  std::ranges::sort(angles);
  return angles;
}

}  // namespace

std::string normalFigures(const SceneFrame& frame, const LayerStyle&) {
  const StepRecord& record = frame.record;
  if (!record.contours || record.contours->points.empty() || !record.surface) return kNoPoints;
  const std::vector<double> angles =
      anglesBetween(record.contours->points, surfaceNormalsAt(record.contours->points, *record.surface));
  if (angles.empty()) return "The surface has no normals.";
  const auto wide = std::ranges::count_if(angles, [](double angle) { return angle > 45.0; });
  return "A surface normal looks again at the face that was seen; a frontier normal looks over its border. "
         "At " +
         plural(angles.size(), "contour point") + " they are " + fixed(angles[angles.size() / 2], 0) +
         " deg apart (median), more than 45 deg at " + grouped(static_cast<std::uint64_t>(wide)) + ".";
}

std::string poseFigures(const SceneFrame& frame, const LayerStyle& style) {
  const auto shown = shownPoses(frame, style);
  if (!shown) return kNoPoints;
  const ContourViewConfig& config = frame.header.contour_config.views;
  std::string text = "Contour point " + std::to_string(shown->point) + " generates " +
                     plural(shown->poses.size(), "pose") + ": its normal and 4 directions tilted by " +
                     fixed(config.tilt_rad * kDegrees, 0) + " deg, each with " +
                     plural(static_cast<std::uint64_t>(config.rolls), "roll") + ", from";
  for (std::size_t i = 0; i < config.distances_m.size(); ++i)
    text += (i > 0 ? ", " : " ") + lengthText(config.distances_m[i]);
  return text + ". View " + std::to_string(shown->view) + " is one of them.";
}

}  // namespace vantage
