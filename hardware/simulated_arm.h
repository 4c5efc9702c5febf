#pragma once

#include <memory>
#include <random>
#include <vector>

#include "core/exploration/ports.h"
#include "core/motion/arm_planner.h"
#include "io/config_file.h"

namespace vantage {

/// Arm that carries out joint trajectories point by point. Time is modelled, not waited for. What it knows of
/// itself comes from its encoders and the nominal mount of the camera; where it truly is may differ.
class SimulatedArm : public Robot {
 public:
  /// \param planner has seen a map, at least one in which all is unknown
  /// \param start configurations of the initial scan, not empty; the arm stands at the first one (see
  /// armStart()). \throws std::invalid_argument as ArmErrors::validate().
  SimulatedArm(std::unique_ptr<ArmPlanner> planner, std::vector<JointVector> start,
               const ArmErrors& errors = {});

  std::string name() const override { return planner_->model().name; }
  /// As read from the encoders when the arm last came to rest.
  RobotState state() const override;
  std::vector<Pose> startPoses() const override;
  /// Goes straight to the nearest configuration for the pose if nothing is in the way.
  void adjust(const Pose& T_world_camera) override;
  void observe(const StateGrid& states) override { planner_->observe(states); }
  MotionPlan plan(const Pose& T_world_camera, std::uint64_t seed) override;
  /// Checks the trajectory once more and sends it, a point each control period. \throws ArmRefusal, also for
  /// a plan without trajectory; Cancelled as Robot::execute().
  double execute(const MotionPlan& plan, const RunControl& control) override;

  const ArmPlanner& planner() const { return *planner_; }
  const JointVector& trueJoints() const { return true_joints_; }
  const Pose& mountError() const { return mount_error_; }
  Pose trueCameraPose() const { return planner_->cameraPose(true_joints_) * mount_error_; }

 protected:
  /// Takes one point of a trajectory; the place where another arm would differ.
  virtual void moveTo(const JointVector& q) { true_joints_ = q; }

 private:
  void follow(const JointTrajectory& trajectory, const RunControl& control);
  void readEncoders();

  std::unique_ptr<ArmPlanner> planner_;
  std::vector<JointVector> start_;
  ArmErrors errors_;
  Pose mount_error_ = Pose::Identity();
  JointVector true_joints_, read_joints_;
  std::mt19937_64 random_;
};

/// Planner of an arm in the map that a run with these settings begins with, in which all is unknown. \throws
/// std::invalid_argument for an arm that is too long for the map's cells.
std::unique_ptr<ArmPlanner> startingPlanner(const RobotModel& model, const Settings& settings);

/// Arm at the start of its initial scan, with the errors of the settings. \throws ArmRefusal as armStart(),
/// std::invalid_argument as startingPlanner()
std::unique_ptr<SimulatedArm> startedArm(const RobotModel& model, const Settings& settings);

/// Simulated camera in the hand of a simulated arm. It looks from where the hand truly is, sees the arm's own
/// bodies, removes them by what the arm knows of itself, and delivers frames with the pose that the arm
/// believes.
class EyeInHandCamera : public DepthCamera {
 public:
  /// Refers to both.
  EyeInHandCamera(DepthCamera& camera, const SimulatedArm& arm) : camera_(camera), arm_(arm) {}
  const PinholeCamera& model() const override { return camera_.model(); }
  std::optional<DepthFrame> capture(const Pose& T_world_camera, std::uint64_t index) override;

 private:
  DepthCamera& camera_;
  const SimulatedArm& arm_;
};

}  // namespace vantage
