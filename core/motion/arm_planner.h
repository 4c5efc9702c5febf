#pragma once

#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/motion/arm_collision.h"
#include "core/motion/arm_path.h"
#include "core/motion/inverse_kinematics.h"
#include "core/motion/path_planner.h"
#include "core/motion/trajectory.h"

namespace vantage {

/// Where an arm stands, how it starts, and how it moves. The defaults are the robot of the experiments
/// (evaluation.md, B1) behind the table.
struct ArmConfig {
  Eigen::Vector3d base_m = {0.0, -0.85, 0.0};       ///< world
  double base_yaw_rad = 1.5707963267948966;         ///< about world z, radians
  std::vector<Box> clear_boxes = aroundTheTable();  ///< that the operator vouches for, see ArmPlace
  std::vector<double> start_rad;                    ///< joints at the start; empty = looked for (armStart())
  double start_arc_rad = 0.52359877559829887;       ///< turn of the first joint while it scans there, radians
  double cell_m = 0.04;                             ///< collision cell, metres
  ArmPathConfig path;
  MotionTiming timing;
  double body_margin_m = 0.02;  ///< the arm's own bodies are as much thicker in depth images, metres
  bool operator==(const ArmConfig& other) const;
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
  ArmPlace place() const;
  /// Boxes behind the table of the experiments, where the arm stands, above all that is on it, and where the
  /// arm's column turns above the table's edge.
  static std::vector<Box> aroundTheTable();
};

/// What a simulated arm gets wrong, to study drift; all 0 = nothing.
struct ArmErrors {
  double encoder_noise_rad = 0.0;  ///< standard deviation of every joint reading, rad or m
  double mount_error_m = 0.0;      ///< length by which the camera truly sits elsewhere on the hand
  double mount_error_rad = 0.0;    ///< angle by which it is truly turned
  std::uint64_t seed = 1;          ///< of the readings, and of the directions of the mount's error
  bool operator==(const ArmErrors&) const = default;
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// A motion that must not be sent, or a start that is none: what is wrong and what to do.
class ArmRefusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Plans joint trajectories that bring an arm's camera to a pose. plan() and check() wait for each other.
class ArmPlanner : public MotionPlanner {
 public:
  /// \throws std::invalid_argument as ArmConfig::validate().
  ArmPlanner(const RobotModel& model, const ArmConfig& config);

  const RobotModel& model() const { return inverse_.model(); }
  const ArmConfig& config() const { return config_; }
  const Pose& T_world_base() const { return T_world_base_; }
  Pose cameraPose(const JointVector& q) const { return T_world_base_ * vantage::cameraPose(model(), q); }

  void observe(const StateGrid& states) override;
  Reachability check(const Pose& T_world_camera) const override;
  /// The waypoints are camera poses along the trajectory. A start in contact is NotConnected.
  MotionPlan plan(const RobotState& from, const Pose& T_world_camera, std::uint64_t seed) const override;

  /// Solutions of a pose, nearest to `near` first, contact or not.
  std::vector<JointVector> solutions(const Pose& T_world_camera, const JointVector& near) const;
  ArmContact contact(const JointVector& q) const { return collision_.check(q); }
  /// The straight motion touches nothing.
  bool freeMotion(const JointVector& from, const JointVector& to) const;
  /// A straight motion from configuration to configuration as it is sent; nothing is checked.
  JointTrajectory timed(const std::vector<JointVector>& corners) const;

  /// Why a trajectory must not be sent, empty if it may: it begins where the arm is, stays within joint and
  /// velocity limits, and touches nothing at its points and between them, looked at as densely as paths are.
  std::string refusal(const JointTrajectory& trajectory, const JointVector& arm_is_at) const;
  /// \throws ArmRefusal with that reason
  void requireSafe(const JointTrajectory& trajectory, const JointVector& arm_is_at) const;

 private:
  ArmConfig config_;
  Pose T_world_base_;
  InverseKinematics inverse_;
  ArmCollision collision_;
  mutable std::mutex one_at_a_time_;  ///< FCL's objects are moved by every check
  GridGeometry cells_;                ///< of the last map
  Box mapped_;  ///< camera positions beyond it are out of reach; empty before the first map
};

/// What is wrong with a configuration, e.g. "forearm would touch occupied or unknown space".
std::string contactText(const ArmContact& contact);

}  // namespace vantage
