#pragma once

#include <cstdint>
#include <vector>

#include "core/exploration/ports.h"
#include "core/exploration/step_record.h"

namespace vantage {

/// Margin around the true objects in which unknown voxels are counted (U_tau and U_box), metres.
inline constexpr double kObjectMargin_m = 0.05;
/// Largest distance from a true surface point to the nearest mesh vertex for it to be covered, metres.
inline constexpr double kCoverageDistance_m = 0.01;

/// Counts what is still unknown near the true objects. The voxels to look at are found once, from the ground
/// truth.
class MapMetricsCounter {
 public:
  /// \param truth may be null: then only unknown_voxels is counted.
  MapMetricsCounter(const GridGeometry& geometry, const Box& workspace, const GroundTruth* truth);

  /// Everything but coverage.
  MapMetrics count(const StateGrid& states) const;

 private:
  Box workspace_;
  bool has_truth_ = false;
  std::vector<std::uint32_t> near_objects_;  ///< linear voxel indices
  std::vector<std::uint32_t> in_boxes_;
};

/// Share of `truth` points that have a point of `seen` within `distance_m`; 0 if there are none.
double surfaceCoverage(const std::vector<Eigen::Vector3f>& truth, const std::vector<Eigen::Vector3f>& seen,
                       double distance_m);

/// Centres of the occupied voxels in a box grown by one voxel, ascending by index: what an octree knows of
/// the surface.
std::vector<Eigen::Vector3f> occupiedCenters(const StateGrid& states, const Box& box);

/// Unknown voxels whose centre lies in the ball.
std::uint64_t countUnknown(const StateGrid& states, const Sphere& sphere);

}  // namespace vantage
