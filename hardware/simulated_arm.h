#pragma once

#include <memory>
#include <random>
#include <vector>

#include "hardware/arm.h"

namespace vantage {

/// Arm that carries out joint trajectories point by point. Time is modelled, not waited for. What it knows of
/// itself comes from its encoders and the nominal mount of the camera; where it truly is may differ.
class SimulatedArm : public Arm {
 public:
  /// It stands at the first configuration of the start. \throws std::invalid_argument as Arm and
  /// ArmErrors::validate().
  SimulatedArm(std::unique_ptr<ArmPlanner> planner, std::vector<JointVector> start,
               const ArmErrors& errors = {});

  const JointVector& trueJoints() const { return true_joints_; }
  const Pose& mountError() const { return mount_error_; }
  Pose trueCameraPose() const { return planner().cameraPose(true_joints_) * mount_error_; }

 protected:
  /// As read when the arm last came to rest.
  JointVector joints() const override { return read_joints_; }
  /// A point each control period.
  void follow(const JointTrajectory& trajectory, const RunControl& control) override;
  /// Takes one point of a trajectory; the place where another arm would differ.
  virtual void moveTo(const JointVector& q) { true_joints_ = q; }

 private:
  void readEncoders();

  ArmErrors errors_;
  Pose mount_error_ = Pose::Identity();
  JointVector true_joints_, read_joints_;
  std::mt19937_64 random_;
};

/// Arm at the start of its initial scan, with the errors of the settings. \throws ArmRefusal as armStart(),
/// std::invalid_argument as startingPlanner()
std::unique_ptr<SimulatedArm> startedArm(const RobotModel& model, const Settings& settings);

/// Simulated camera in the hand of a simulated arm. It looks from where the hand truly is, and sees the arm's
/// own bodies where they truly are.
class SimulatedHandCamera : public EyeInHandCamera {
 public:
  /// Refers to both.
  SimulatedHandCamera(DepthCamera& scene, const SimulatedArm& arm) : EyeInHandCamera(scene, arm), arm_(arm) {}

 protected:
  std::optional<DepthFrame> look(const Pose& T_world_camera, std::uint64_t index) override;

 private:
  const SimulatedArm& arm_;
};

}  // namespace vantage
