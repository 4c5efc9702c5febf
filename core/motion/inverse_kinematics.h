#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/motion/robot_model.h"

namespace vantage {

/// Of the numeric solver; the closed form has no choices.
struct IkConfig {
  int seeds = 24;           ///< starts beside the current configuration, 0 ..
  int iterations = 60;      ///< per start, >= 1
  double tolerance = 1e-7;  ///< a solution's error, m and rad, > 0
  double distinct = 1e-3;   ///< solutions at most that far apart in every joint, rad or m, are one, >= 0
  bool operator==(const IkConfig&) const = default;
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// Joint configurations that put the camera at a pose. Six revolute joints with a spherical wrist behind two
/// parallel ones (the usual industrial arm) are solved in closed form: every solution is found, up to eight,
/// by rotations about axes alone, so that any such URDF fits (Paden-Kahan subproblems). Where a joint is
/// free, because the wrist lies on its axis or the wrist is stretched, a whole line of solutions exists; of
/// it every 30 deg from `near` are given. Other arms are solved by Levenberg-Marquardt from many starts.
class InverseKinematics {
 public:
  /// Keeps a copy of the model. \throws std::invalid_argument as IkConfig::validate().
  explicit InverseKinematics(const RobotModel& model, const IkConfig& config = {});
  ~InverseKinematics();
  InverseKinematics(InverseKinematics&&) noexcept;
  InverseKinematics& operator=(InverseKinematics&&) noexcept;

  const RobotModel& model() const;
  /// Closed form.
  bool analytic() const;
  /// All solutions found within the joint limits, nearest to `near` first: the one whose slowest joint
  /// arrives earliest. Of the full turns that a joint may add, the one nearest to `near` is taken. Empty if
  /// there is none. `near` has one value a joint. Same arguments, same result; may run on many threads.
  std::vector<JointVector> solve(const Pose& T_base_camera, const JointVector& near) const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

/// Time that the slowest joint needs from one configuration to another at full speed, seconds.
double jointTravel_s(const RobotModel& model, const JointVector& from, const JointVector& to);

}  // namespace vantage
