#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/motion/robot_model.h"

namespace vantage {

/// Closed-form inverse kinematics of six revolute joints whose axes 2 and 3 are parallel and whose axes 4, 5
/// and 6 meet in one point. Axes and points in the base frame with all joints at 0.
class SphericalWrist {
 public:
  /// Empty if the arm is not of this kind, to 1e-9 m and rad.
  static std::optional<SphericalWrist> of(const RobotModel& model);

  /// Joint angles for a camera pose, limits not asked, any full turns. Where a joint is free, every 30 deg
  /// from its value in `near`.
  std::vector<JointVector> solve(const Pose& T_base_camera, const JointVector& near) const;

 private:
  void solveWrist(const Eigen::Matrix3d& rotation, const JointVector& near, JointVector& q,
                  std::vector<JointVector>& solutions) const;

  /// A joint's axis: unit direction and a point on it.
  struct Line {
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
  };
  std::array<Line, 6> axis_;
  Eigen::Vector3d wrist_ = Eigen::Vector3d::Zero();
  Pose T_camera_base_at_zero_ = Pose::Identity();
};

}  // namespace vantage
