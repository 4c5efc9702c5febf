#include "core/motion/spherical_wrist.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kTiny = 1e-9;

/// Angles of one joint: none, one or two; where any will do, a whole turn in steps of 30 deg.
struct Angles {
  static constexpr int kSteps = 12;
  std::array<double, kSteps> value = {};
  int count = 0;
  const double* begin() const { return value.data(); }
  const double* end() const { return value.data() + count; }
};

Angles oneAngle(double angle) {
  return {{angle}, 1};
}

Angles anyAngle(double from) {
  Angles angles;
  for (int i = 0; i < Angles::kSteps; ++i)
    angles.value[angles.count++] = from + i * 2.0 * std::numbers::pi / Angles::kSteps;
  return angles;
}

/// a cos x + b sin x = c. Where every angle solves it, they start at `free`. Where the two solutions meet,
/// rounding may put c a hair beyond the reach; one solution remains.
Angles solveTrigonometric(double a, double b, double c, double free) {
  const double reach = std::hypot(a, b);
  if (reach < kTiny) return std::abs(c) < kTiny ? anyAngle(free) : Angles{};
  const double ratio = c / reach;
  if (!(std::abs(ratio) <= 1.0 + 1e-10)) return {};
  const double middle = std::atan2(b, a), half = std::acos(std::clamp(ratio, -1.0, 1.0));
  return {{middle + half, middle - half}, half > 0.0 ? 2 : 1};
}

/// Angles about `axis` after which `moved` has the component `c` along `along`.
Angles turnToComponent(const Vector3d& axis, const Vector3d& moved, const Vector3d& along, double c,
                       double free) {
  const double fixed = axis.dot(moved) * axis.dot(along);
  return solveTrigonometric(along.dot(moved) - fixed, along.dot(axis.cross(moved)), c - fixed, free);
}

/// Angle about `axis` from one vector to another; any where one of them lies on the axis, from `free` on.
Angles turnBetween(const Vector3d& axis, const Vector3d& from, const Vector3d& to, double free) {
  const Vector3d a = from - axis * axis.dot(from), b = to - axis * axis.dot(to);
  if (a.norm() < kTiny || b.norm() < kTiny) return anyAngle(free);
  return oneAngle(std::atan2(axis.dot(a.cross(b)), a.dot(b)));
}

Matrix3d turn(const Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

/// Where two lines meet, if they do.
std::optional<Vector3d> meeting(const Vector3d& p, const Vector3d& a, const Vector3d& q, const Vector3d& b) {
  const Vector3d n = a.cross(b);
  if (n.norm() < 1e-3 || std::abs(n.dot(q - p)) > kTiny * n.norm()) return std::nullopt;
  return p + a * ((q - p).cross(b).dot(n) / n.squaredNorm());
}

}  // namespace

std::optional<SphericalWrist> SphericalWrist::of(const RobotModel& model) {
  if (model.jointCount() != 6) return std::nullopt;
  if (std::any_of(model.joints.begin(), model.joints.end(), [](const ArmJoint& j) { return j.prismatic; }))
    return std::nullopt;
  SphericalWrist arm;
  const ArmFrames zero = forwardKinematics(model, JointVector::Zero(6));
  for (int i = 0; i < 6; ++i) {
    arm.axis_[i] = {zero.T_base_joint[i].linear() * model.joints[i].axis, zero.T_base_joint[i].translation()};
  }
  const auto& axis = arm.axis_;
  if (axis[1].direction.cross(axis[2].direction).norm() > kTiny) return std::nullopt;
  const auto wrist = meeting(axis[3].point, axis[3].direction, axis[4].point, axis[4].direction);
  if (!wrist || (*wrist - axis[5].point).cross(axis[5].direction).norm() > kTiny ||
      axis[4].direction.cross(axis[5].direction).norm() < 1e-3)
    return std::nullopt;
  arm.wrist_ = *wrist;
  arm.T_camera_base_at_zero_ = zero.T_base_camera.inverse();
  return arm;
}

std::vector<JointVector> SphericalWrist::solve(const Pose& T_base_camera, const JointVector& near) const {
  std::vector<JointVector> solutions;
  // The motion of the whole arm, product of the six turns.
  const Pose motion = T_base_camera * T_camera_base_at_zero_;
  const Vector3d target = motion * wrist_;
  const auto& [a1, p1] = axis_[0];
  const auto& [a2, p2] = axis_[1];
  const auto& [a3, p3] = axis_[2];
  const Vector3d upper_arm = p3 - p2, forearm = wrist_ - p3;
  JointVector q(6);
  // Joints 2 and 3 leave the wrist's component along their common direction as it is, so joint 1 has to make
  // it.
  for (const double back : turnToComponent(a1, target - p1, a2, a2.dot(wrist_ - p1), -near[0])) {
    q[0] = -back;
    const Vector3d reached = p1 + turn(a1, back) * (target - p1);
    // Joint 2 leaves the distance from its axis as it is, so joint 3 has to make it.
    const double half_rest =
        ((reached - p2).squaredNorm() - upper_arm.squaredNorm() - forearm.squaredNorm()) / 2;
    for (const double elbow : turnToComponent(a3, forearm, upper_arm, half_rest, near[2])) {
      q[2] = elbow;
      const Vector3d bent = upper_arm + turn(a3, elbow) * forearm;
      for (const double shoulder : turnBetween(a2, bent, reached - p2, near[1])) {
        q[1] = shoulder;
        const Matrix3d arm = turn(a1, q[0]) * turn(a2, shoulder) * turn(a3, elbow);
        solveWrist(arm.transpose() * motion.linear(), near, q, solutions);
      }
    }
  }
  return solutions;
}

/// The last three joints make a rotation.
void SphericalWrist::solveWrist(const Matrix3d& rotation, const JointVector& near, JointVector& q,
                                std::vector<JointVector>& solutions) const {
  const Vector3d &a4 = axis_[3].direction, &a5 = axis_[4].direction, &a6 = axis_[5].direction;
  const Vector3d tool = rotation * a6;
  const Vector3d across = a6.unitOrthogonal();
  for (const double bend : turnToComponent(a5, a6, a4, a4.dot(tool), near[4])) {
    q[4] = bend;
    const Vector3d bent = turn(a5, bend) * a6;
    const bool stretched = bent.cross(a4).norm() < 1e-8;  // axes 4 and 6 are one: any share of the turn does
    for (const double roll : stretched ? anyAngle(near[3]) : turnBetween(a4, bent, tool, near[3])) {
      q[3] = roll;
      const Matrix3d rest = (turn(a4, roll) * turn(a5, bend)).transpose() * rotation;
      q[5] = *turnBetween(a6, across, rest * across, near[5]).begin();
      solutions.push_back(q);
    }
    if (stretched) break;
  }
}

}  // namespace vantage
