#pragma once

#include <Eigen/Core>

namespace vantage {

/// Joints of an arm at most.
inline constexpr int kMaxArmJoints = 12;

/// One value for each joint of an arm, in the order of RobotModel::joints: rad, or m for prismatic ones.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxArmJoints, 1>;

}  // namespace vantage
