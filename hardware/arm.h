#pragma once

#include <memory>
#include <vector>

#include "core/exploration/ports.h"
#include "core/motion/arm_planner.h"
#include "io/config_file.h"

namespace vantage {

/// An arm with the camera in its hand. How a trajectory is carried out and where the joints are read is what
/// arms differ in; every motion is checked here just before it goes there.
class Arm : public Robot {
 public:
  /// \param planner has seen a map, at least one in which all is unknown
  /// \param start configurations of the initial scan, not empty (see armStart()); the arm stands near the
  /// first one, or where the straight way to it is free. \throws std::invalid_argument without start
  Arm(std::unique_ptr<ArmPlanner> planner, std::vector<JointVector> start);

  std::string name() const override { return planner_->model().name; }
  /// As read from the encoders.
  RobotState state() const override;
  std::vector<Pose> startPoses() const override;
  /// Goes straight to the nearest configuration for the pose if nothing is in the way.
  void adjust(const Pose& T_world_camera, const RunControl& control) override;
  void observe(const StateGrid& states) override { planner_->observe(states); }
  MotionPlan plan(const Pose& T_world_camera, std::uint64_t seed) override;
  /// Checks the trajectory once more and sends it. \throws ArmRefusal, also for a plan without trajectory;
  /// Cancelled and DeviceLost as Robot::execute().
  double execute(const MotionPlan& plan, const RunControl& control) override;

  const ArmPlanner& planner() const { return *planner_; }
  const std::vector<JointVector>& start() const { return start_; }

 protected:
  /// Where the joints are, as far as the arm knows.
  virtual JointVector joints() const = 0;
  /// Carries out a trajectory that was found safe; returns when the arm is at rest. \throws as execute()
  virtual void follow(const JointTrajectory& trajectory, const RunControl& control) = 0;

 private:
  std::unique_ptr<ArmPlanner> planner_;
  std::vector<JointVector> start_;
};

/// Planner of an arm in the map that a run with these settings begins with, in which all is unknown. \throws
/// std::invalid_argument for an arm that is too long for the map's cells.
std::unique_ptr<ArmPlanner> startingPlanner(const RobotModel& model, const Settings& settings);

/// Camera in the hand of an arm: removes the arm's own bodies from the images, and delivers them with the
/// pose that the arm believes.
class EyeInHandCamera : public DepthCamera {
 public:
  /// Refers to both.
  EyeInHandCamera(DepthCamera& camera, const Arm& arm) : camera_(camera), arm_(arm) {}
  const PinholeCamera& model() const override { return camera_.model(); }
  std::optional<DepthFrame> capture(const Pose& T_world_camera, std::uint64_t index) override;

 protected:
  /// The image as the camera takes it, the arm in it.
  virtual std::optional<DepthFrame> look(const Pose& T_world_camera, std::uint64_t index) {
    return camera_.capture(T_world_camera, index);
  }
  DepthCamera& camera() { return camera_; }

 private:
  DepthCamera& camera_;
  const Arm& arm_;
};

}  // namespace vantage
