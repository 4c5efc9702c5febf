#include "core/perception/saliency.h"

#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "core/geometry/check.h"
#include "core/perception/other_label_distance.h"

namespace vantage {

namespace {

/// Point indices of every label, ascending.
std::vector<std::vector<std::uint32_t>> pointsOfLabels(const Labels& labels) {
  std::vector<std::vector<std::uint32_t>> members(labels.count + 1);
  for (std::uint32_t i = 0; i < labels.of_point.size(); ++i) {
    if (labels.of_point[i] != 0) members[labels.of_point[i]].push_back(i);
  }
  return members;
}

/// Oriented box and bounding sphere: axes from the covariance about the mean, extents along them (eq. 8-10,
/// D-B17, D-B19).
void measureShape(const SurfaceCloud& cloud, const std::vector<std::uint32_t>& members, Segment& segment) {
  segment.points = static_cast<std::uint32_t>(members.size());
  if (members.empty()) return;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t i : members) sum += cloud.points[i].cast<double>();
  segment.mean_m = sum / static_cast<double>(members.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : members) {
    const Eigen::Vector3d d = cloud.points[i].cast<double>() - segment.mean_m;
    covariance += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance /
                                                              static_cast<double>(members.size()));
  const Eigen::Matrix3d axes = solver.eigenvectors();

  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
  for (const std::uint32_t i : members) {
    const Eigen::Vector3d d = axes.transpose() * (cloud.points[i].cast<double>() - segment.mean_m);
    low = low.cwiseMin(d);
    high = high.cwiseMax(d);
  }
  segment.center_m = segment.mean_m + axes * ((low + high) / 2.0);
  for (const std::uint32_t i : members) {
    segment.radius_m = std::max(segment.radius_m, (cloud.points[i].cast<double>() - segment.center_m).norm());
  }

  std::array<int, 3> order{2, 1, 0};
  const Eigen::Vector3d extent = high - low;
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return extent[a] > extent[b]; });
  for (int k = 0; k < 3; ++k) {
    segment.extent_m[k] = extent[order[k]];
    segment.axes.col(k) = axes.col(order[k]);
  }
}

/// Points of every label that keep their distance from all others, eq. (11); capped distances count as
/// isolated.
std::vector<std::uint32_t> isolatedPoints(const std::vector<float>& distances, const Labels& labels,
                                          const SaliencyConfig& config) {
  std::vector<std::uint32_t> isolated(labels.count + 1, 0);
  const auto cap = static_cast<float>(config.max_distance_m);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const bool far = distances[i] > config.isolation_distance_m || distances[i] >= cap;  // D-B18
    if (far) ++isolated[labels.of_point[i]];
  }
  return isolated;
}

/// Eq. (12) from a segment's shape and its number of isolated points.
void score(Segment& segment, std::uint32_t isolated, const SaliencyConfig& config) {
  const double d_max = segment.extent_m[0], d_min = segment.extent_m[2];
  segment.isolation = segment.points > 0 ? static_cast<double>(isolated) / segment.points : 0.0;
  segment.roundness = d_max > 0.0 ? d_min / d_max : 0.0;
  const bool too_small = segment.points < static_cast<std::uint32_t>(config.min_points) || !(d_max > 0.0);
  segment.saliency =
      (config.use_isolation ? segment.isolation : 1.0) * (config.use_roundness ? segment.roundness : 1.0);
  if (too_small) segment.saliency = 0.0;  // D-B17
}

void requireLabels(std::size_t points, const Labels& labels) {
  if (labels.of_point.size() != points) {
    throw std::invalid_argument("saliency: " + std::to_string(labels.of_point.size()) + " labels for " +
                                std::to_string(points) + " points; there must be one each");
  }
  for (const std::uint32_t label : labels.of_point) {
    if (label > labels.count) {
      throw std::invalid_argument("saliency: label " + std::to_string(label) +
                                  " is above the number of segments " + std::to_string(labels.count));
    }
  }
}

}  // namespace

void SaliencyConfig::validate() const {
  requireInRange("saliency.max_distance_m", max_distance_m, 1e-6, 10.0);
  requireInRange("saliency.isolation_distance_m", isolation_distance_m, 1e-9, max_distance_m);
  requireInRange("saliency.min_points", min_points, 1, 1000000000);
}

Saliency computeSaliency(const SurfaceCloud& cloud, const Labels& labels, const SaliencyConfig& config) {
  config.validate();
  requireLabels(cloud.points.size(), labels);
  Saliency saliency;
  saliency.distance_to_other_m =
      otherLabelDistances(cloud.points, labels.of_point, static_cast<float>(config.max_distance_m));
  const auto members = pointsOfLabels(labels);
  saliency.segments.resize(labels.count);
  tbb::parallel_for(0u, labels.count, [&](std::uint32_t k) {
    saliency.segments[k].label = k + 1;
    measureShape(cloud, members[k + 1], saliency.segments[k]);
  });
  saliency.segments = rescoreSegments(saliency, labels, config);
  return saliency;
}

std::vector<Segment> rescoreSegments(const Saliency& saliency, const Labels& labels,
                                     const SaliencyConfig& config) {
  config.validate();
  requireLabels(saliency.distance_to_other_m.size(), labels);
  const auto isolated = isolatedPoints(saliency.distance_to_other_m, labels, config);
  std::vector<Segment> segments = saliency.segments;
  for (Segment& segment : segments) score(segment, isolated[segment.label], config);
  return segments;
}

std::vector<std::uint32_t> bySaliency(const std::vector<Segment>& segments) {
  std::vector<std::uint32_t> order(segments.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (segments[a].saliency != segments[b].saliency) return segments[a].saliency > segments[b].saliency;
    return segments[a].label < segments[b].label;
  });
  return order;
}

}  // namespace vantage
