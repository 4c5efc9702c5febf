#pragma once

#include <string>
#include <vector>

#include "core/motion/joint_vector.h"

namespace vantage {

struct RobotModel;

/// How fast an arm moves.
struct MotionTiming {
  double speed_share = 0.25;  ///< of every joint's greatest velocity, (0, 1]
  double ramp_s = 0.25;       ///< from rest to that speed, seconds, > 0
  double period_s = 0.02;     ///< control period: spacing of the points, seconds, > 0
  bool operator==(const MotionTiming&) const = default;
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// What an arm is sent: where every joint is at which time. The first point is at 0 s, at rest, and so is the
/// last.
struct JointTrajectory {
  std::vector<double> time_s;           ///< ascending
  std::vector<JointVector> positions;   ///< rad or m, one per time
  std::vector<JointVector> velocities;  ///< rad/s or m/s, one per time

  std::size_t size() const { return time_s.size(); }
  double duration_s() const { return time_s.empty() ? 0.0 : time_s.back(); }
};

/// Straight joint motions from corner to corner, stopping at each: all joints start and arrive together, with
/// a trapezoid of speed whose top is that of the slowest joint. \param corners at least one
JointTrajectory timedTrajectory(const RobotModel& model, const std::vector<JointVector>& corners,
                                const MotionTiming& timing);

/// What of a trajectory the arm itself can't do: numbers that are none, times that do not ascend, joints
/// beyond their limits, velocities (also those between the points) beyond the greatest ones. Empty if
/// nothing.
std::string limitViolation(const RobotModel& model, const JointTrajectory& trajectory);

}  // namespace vantage
