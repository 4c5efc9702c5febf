#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/pose.h"
#include "core/perception/contours.h"

namespace vantage {

/// Candidate poses of the contour planner (section 5, D-B6).
struct ContourViewConfig {
  std::vector<double> distances_m = {0.80};     ///< sensor to contour point, metres, each > 0
  double tilt_rad = 0.26179938779914941;        ///< of the four extra directions from the normal, radians; 15 deg
  int rolls = 8;                                ///< equal steps of a full turn, 1..64
  bool operator==(const ContourViewConfig&) const = default;
  void validate() const;
  /// Poses per contour point: 5 directions x rolls x distances.
  int posesPerPoint() const { return 5 * rolls * static_cast<int>(distances_m.size()); }
};

/// A candidate pose. Ids are dense: ((point * distances + distance) * 5 + direction) * rolls + roll.
struct CandidateView {
  std::uint32_t id = 0;
  std::uint32_t group = 0;  ///< contour point
  Pose T_world_camera = Pose::Identity();
};

/// Sensor position, axis and roll-0 pose shared by the `rolls` poses of one direction.
struct ViewPosition {
  std::uint32_t first_id = 0;  ///< id of roll 0; the others follow
  std::uint32_t group = 0;
  Pose T_world_camera = Pose::Identity();  ///< roll 0
};

/// The positions of all candidates in ascending id order; five per point and distance.
std::vector<ViewPosition> contourViewPositions(const std::vector<ContourPoint>& points,
                                               const ContourViewConfig& config);

/// Pose of candidate `position.first_id + roll`.
Pose rolledPose(const ViewPosition& position, int roll, const ContourViewConfig& config);

/// All poses: 40 per contour point with the defaults.
std::vector<CandidateView> contourViews(const std::vector<ContourPoint>& points, const ContourViewConfig& config);

}  // namespace vantage
