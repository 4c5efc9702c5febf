#include "core/planners/contour_groups.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace vantage {
namespace {

bool isDisappointing(const ViewSearchInput& input, const GainConfig& gain, const ContourPoint& point) {
  return gain.exclude_disappointing &&
         std::any_of(input.disappointing.begin(), input.disappointing.end(), [&](const Eigen::Vector3d& d) {
           return (d - point.position_m).norm() <= gain.disappointing_distance_m;
         });
}

std::vector<std::uint32_t> offeredPoints(const ViewSearchInput& input, const GainConfig& gain) {
  std::vector<std::uint32_t> offered;
  for (std::uint32_t p = 0; p < input.points.size(); ++p)
    if (!isDisappointing(input, gain, input.points[p])) offered.push_back(p);
  return offered;
}

/// Offered contour points by label, 0 first.
std::vector<std::vector<std::uint32_t>> pointsByLabel(const ViewSearchInput& input, const GainConfig& gain) {
  if (input.point_labels.size() != input.points.size())
    throw std::invalid_argument("view search: " + std::to_string(input.point_labels.size()) +
                                " point labels for " + std::to_string(input.points.size()) +
                                " contour points; one each is needed");
  std::vector<std::vector<std::uint32_t>> by_label(input.saliency.segments.size() + 1);
  for (const std::uint32_t p : offeredPoints(input, gain)) {
    const std::uint32_t label = input.point_labels[p];
    if (label >= by_label.size())
      throw std::invalid_argument("view search: contour point " + std::to_string(p) + " has label " +
                                  std::to_string(label) + "; there are " +
                                  std::to_string(input.saliency.segments.size()) + " segments");
    by_label[label].push_back(p);
  }
  return by_label;
}

SegmentSearch makeGroup(const ViewSearchInput& input, const ContourPlannerConfig& config,
                        std::int32_t segment, std::vector<std::uint32_t> points) {
  SegmentSearch group;
  group.segment = segment;
  group.contour_points = std::move(points);
  if (segment >= 0) group.saliency = input.saliency.segments[segment].saliency;
  if (const auto region = regionQuery(input, config, group); region.sphere) group.sphere = *region.sphere;
  group.poses_generated = static_cast<std::uint32_t>(positionsOf(input, group).size()) * config.views.rolls;
  return group;
}

}  // namespace

std::vector<SegmentSearch> contourGroups(const ViewSearchInput& input, const ContourPlannerConfig& config) {
  std::vector<SegmentSearch> groups;
  const auto add = [&](std::int32_t segment, std::vector<std::uint32_t> points) {
    if (!points.empty()) groups.push_back(makeGroup(input, config, segment, std::move(points)));
  };
  if (!config.segment_by_segment) {
    add(-1, offeredPoints(input, config.gain));
    return groups;
  }
  std::vector<std::vector<std::uint32_t>> by_label = pointsByLabel(input, config.gain);
  for (const std::uint32_t s : bySaliency(input.saliency.segments))
    add(static_cast<std::int32_t>(s), std::move(by_label[input.saliency.segments[s].label]));
  add(-1, std::move(by_label[0]));
  return groups;
}

Sphere boundingSphere(const ViewSearchInput& input, const SegmentSearch& search) {
  if (search.segment >= 0) {
    const Segment& segment = input.saliency.segments.at(search.segment);
    return {segment.center_m, segment.radius_m};
  }
  if (search.contour_points.empty()) return {};
  Box box;
  for (const std::uint32_t p : search.contour_points) box.extend(input.points[p].position_m);
  Sphere sphere{box.center(), 0.0};
  for (const std::uint32_t p : search.contour_points)
    sphere.radius = std::max(sphere.radius, (input.points[p].position_m - sphere.center).norm());
  return sphere;
}

VisibilityQuery regionQuery(const ViewSearchInput& input, const ContourPlannerConfig& config,
                            const SegmentSearch& search) {
  VisibilityQuery query;
  query.outside = config.gain.outside;
  if (!config.segment_by_segment) {
    query.bounds = input.workspace;
    return query;
  }
  const Sphere sphere = boundingSphere(input, search);
  query.sphere = Sphere{sphere.center, sphere.radius + config.gain.sphere_margin_m};
  query.histogram_bins = kHistogramBins;
  query.histogram_start_m = sphere.radius;
  query.histogram_width_m = kHistogramWidth_m;
  return query;
}

std::vector<std::uint32_t> positionsOf(const ViewSearchInput& input, const SegmentSearch& search) {
  std::vector<std::uint8_t> in_group(input.points.size(), 0);
  for (const std::uint32_t p : search.contour_points) in_group.at(p) = 1;
  std::vector<std::uint32_t> positions;
  for (std::uint32_t n = 0; n < input.positions.size(); ++n)
    if (in_group.at(input.positions[n].group)) positions.push_back(n);
  return positions;
}

}  // namespace vantage
