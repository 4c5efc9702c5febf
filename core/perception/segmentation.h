#pragma once

#include <cstdint>
#include <vector>

#include "core/perception/surface_cloud.h"

namespace vantage {

/// Supervoxels (VCCS) and locally convex connected patches (LCCP) through PCL; defaults of D-B34.
struct SegmentationConfig {
  double voxel_m = 0.0075;                               ///< VCCS voxel, metres; above the vertex spacing
  double seed_m = 0.03;                                  ///< VCCS seed spacing, metres, > voxel_m
  double spatial_weight = 1.0;                           ///< >= 0
  double normal_weight = 4.0;                            ///< >= 0
  double concavity_tolerance_rad = 0.17453292519943295;  ///< radians, 10 deg
  bool smoothness_check = true;
  double smoothness = 0.1;  ///< share of the seed spacing allowed as step, >= 0
  int k_convexity = 0;      ///< 0..3
  bool sanity_check = true;
  int min_segment_supervoxels = 4;  ///< smaller or equal segments join their largest neighbour, 0 = off
  bool operator==(const SegmentationConfig&) const = default;
  void validate() const;
};

/// Segment label of each point: 0 = no segment, else 1..count without gaps, in the order of first appearance.
struct Labels {
  std::vector<std::uint32_t> of_point;
  std::uint32_t count = 0;
  std::uint32_t supervoxels = 0;
};

/// LCCP segments of a cloud with normals; empty for an empty cloud. Points without a finite position or a
/// usable normal, and points that no supervoxel reaches (specks smaller than a supervoxel seed), have label
/// 0. The same input gives the same labels in every run and process. \throws std::invalid_argument if there
/// is not one normal a point or a setting is out of range,
///         std::runtime_error if the points lie more than 2^20 voxels apart.
Labels segmentSurface(const SurfaceCloud& cloud, const SegmentationConfig& config);

/// One supervoxel for convexEdge().
struct Patch {
  Eigen::Vector3f centroid_m;
  Eigen::Vector3f normal;
};

/// LCCP's decision for two adjacent patches: true = convex, they merge (section 12.6). Taken by the same code
/// that segmentSurface() uses; k-convexity does not apply to a pair.
bool convexEdge(const Patch& a, const Patch& b, const SegmentationConfig& config);

}  // namespace vantage
