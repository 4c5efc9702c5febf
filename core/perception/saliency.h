#pragma once

#include <cstdint>
#include <vector>

#include "core/perception/segmentation.h"

namespace vantage {

struct SaliencyConfig {
  double isolation_distance_m = 0.02;  ///< B_th, metres in (0, 0.2]
  double max_distance_m = 0.20;        ///< distances to other segments are kept up to here, metres
  int min_points = 10;                 ///< smaller segments have saliency 0 (D-B17)
  bool use_isolation = true;           ///< ablation: F = 1
  bool use_roundness = true;           ///< ablation: d_min / d_max = 1
  bool operator==(const SaliencyConfig&) const = default;
  void validate() const;
};

/// A segment with everything its saliency is made of (eq. 8-12, D-B17, D-B19).
struct Segment {
  std::uint32_t label = 0;
  std::uint32_t points = 0;
  double saliency = 0.0;                               ///< F * d_min / d_max
  double isolation = 0.0;                              ///< F, eq. (11)
  double roundness = 0.0;                              ///< d_min / d_max
  Eigen::Vector3d extent_m = Eigen::Vector3d::Zero();  ///< d1 >= d2 >= d3 along the principal axes
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, in the order of extent_m
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d center_m =
      Eigen::Vector3d::Zero();  ///< centre of the oriented box = of the bounding sphere
  double radius_m = 0.0;        ///< to the farthest point
};

struct Saliency {
  std::vector<Segment> segments;  ///< one per label 1..count, in label order
  /// Distance of each point to the nearest point of another label (label 0 counts as other), metres, capped
  /// at max_distance_m: F for every B_th is a lookup.
  std::vector<float> distance_to_other_m;
};

/// Saliency of every segment; points at the cap count as isolated. `labels.of_point` has one entry per point
/// of the cloud. \throws std::invalid_argument if labels and points do not fit, or a setting is out of range.
Saliency computeSaliency(const SurfaceCloud& cloud, const Labels& labels, const SaliencyConfig& config);

/// The segments with the saliency they have under another isolation distance or weighting, from the distances
/// kept in `saliency`; equal to a fresh computation. `config.max_distance_m` is the one the distances were
/// kept with.
std::vector<Segment> rescoreSegments(const Saliency& saliency, const Labels& labels,
                                     const SaliencyConfig& config);

/// Indices into `segments` by decreasing saliency; ties go to the lower label.
std::vector<std::uint32_t> bySaliency(const std::vector<Segment>& segments);

}  // namespace vantage
