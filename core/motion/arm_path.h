#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/arm_collision.h"
#include "core/motion/inverse_kinematics.h"

namespace vantage {

struct ArmPathConfig {
  double check_step_m = 0.01;   ///< farthest that any part of the arm moves between two checks, metres, > 0
  int goals = 4;                ///< free solutions of the view that are tried, nearest first, >= 1
  int rrt_iterations = 4000;    ///< of RRT-Connect, for each goal, 0 = straight joint motions only
  double rrt_range_rad = 1.0;   ///< longest tree edge, > 0
  double safety_time_s = 30.0;  ///< wall clock abort of each search, recorded when it strikes, > 0
  bool operator==(const ArmPathConfig&) const = default;
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// A motion of the arm to a camera pose, or the facts that say why there is none: no solution (out of reach),
/// no free one or a start that is not (the contact tells with what), or no way to any of them.
struct ArmPath {
  std::vector<JointVector> configurations;  ///< corners of a path of straight joint motions; empty if none
  int solutions = 0;                        ///< of the inverse kinematics, within the limits
  int free_solutions = 0;                   ///< of them, without contact
  ArmContact contact;          ///< of the start if that is not free, else of the first such solution
  bool start_blocked = false;  ///< the start is not free; the solutions were not looked at any further
  bool straight = false;       ///< one joint motion does it
  int iterations = 0;          ///< of RRT-Connect, all goals together
  bool timed_out = false;      ///< the wall clock struck a search
  bool found() const { return !configurations.empty(); }
};

/// Largest distance that any part of the arm can move when each joint turns by `step`, metres: the sum over
/// the joints of the turn times the farthest reach of what hangs on it. A bound, whatever the configuration.
double sweepBound(const RobotModel& model, const JointVector& step);

/// No contact anywhere on the straight joint motion, looked at every `check_step_m` of sweepBound().
bool freeMotion(const RobotModel& model, const ArmCollision& collision, const JointVector& from,
                const JointVector& to, double check_step_m);

/// Straight joint motion to one of the nearest solutions, else RRT-Connect (seeded, bounded iterations) and
/// shortcutting. Joints stay within their limits; `from` has to, to 1e-9 rad or m. The same arguments give
/// the same path, unless the wall clock struck. \param T_base_camera in the frame of the arm's base.
ArmPath planArmPath(const InverseKinematics& inverse, const ArmCollision& collision, const JointVector& from,
                    const Pose& T_base_camera, const ArmPathConfig& config, std::uint64_t seed);

}  // namespace vantage
