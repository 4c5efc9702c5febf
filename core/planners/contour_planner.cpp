#include "core/planners/contour_planner.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/geometry/check.h"
#include "core/planners/nearest_point.h"

namespace vantage {

void GainConfig::validate() const {
  requireInRange("gain.sphere_margin_m", sphere_margin_m, 0.0, 100.0);
  requireInRange("gain.threshold", gain_threshold, 0.0, 1e9);
  requireInRange("gain.reduction", reduction, 1, 64);
  requireInRange("gain.executed_distance_m", executed_distance_m, 0.0, 100.0);
  requireInRange("gain.executed_angle_rad", executed_angle_rad, 0.0, std::numbers::pi);
  requireInRange("gain.disappointing_share", disappointing_share, 0.0, 1.0);
  requireInRange("gain.disappointing_distance_m", disappointing_distance_m, 0.0, 100.0);
}

void ContourPlannerConfig::validate() const {
  contours.validate();
  views.validate();
  segmentation.validate();
  saliency.validate();
  gain.validate();
}

std::optional<int> marginBins(double sphere_margin_m) {
  constexpr double kRounding = 1e-6;  // bins
  const double bins = sphere_margin_m / kHistogramWidth_m;
  const double whole = std::round(bins);
  if (!(whole >= 0.0 && whole <= std::round(kLargestKeptMargin_m / kHistogramWidth_m))) return std::nullopt;
  if (std::abs(bins - whole) > kRounding) return std::nullopt;
  return static_cast<int>(whole);
}

std::vector<std::uint32_t> assignContourPoints(const std::vector<ContourPoint>& points,
                                               const SurfaceCloud& cloud, const Labels& labels) {
  if (labels.of_point.size() != cloud.points.size())
    throw std::invalid_argument("assigning contour points: " + std::to_string(labels.of_point.size()) +
                                " labels for a cloud of " + std::to_string(cloud.points.size()) +
                                " points; one each is needed");
  std::vector<std::uint32_t> result(points.size(), 0);
  const NearestPoint nearest(cloud.points);
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t n) {
    if (const auto index = nearest(points[n].position_m)) result[n] = labels.of_point[*index];
  });
  return result;
}

}  // namespace vantage
