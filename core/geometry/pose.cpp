#include "core/geometry/pose.h"

#include <cmath>
#include <stdexcept>

namespace vantage {

Pose lookAlong(const Eigen::Vector3d& eye_world, const Eigen::Vector3d& axis_world, double roll_rad) {
  const double length = axis_world.norm();
  if (!(length > 0.0)) throw std::invalid_argument("lookAlong: the viewing axis has no length");
  const Eigen::Vector3d z = axis_world / length;
  Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ());
  x = x.norm() < 1e-9 ? Eigen::Vector3d::UnitX() : x.normalized();
  const Eigen::Vector3d y = z.cross(x);
  const double c = std::cos(roll_rad), s = std::sin(roll_rad);
  Pose pose = Pose::Identity();
  pose.linear().col(0) = c * x + s * y;
  pose.linear().col(1) = c * y - s * x;
  pose.linear().col(2) = z;
  pose.translation() = eye_world;
  return pose;
}

Pose lookAt(const Eigen::Vector3d& eye_world, const Eigen::Vector3d& target_world, double roll_rad) {
  return lookAlong(eye_world, target_world - eye_world, roll_rad);
}

Pose makePose(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation) {
  Pose pose = Pose::Identity();
  pose.linear() = orientation.normalized().toRotationMatrix();
  pose.translation() = position;
  return pose;
}

Eigen::Quaterniond orientationOf(const Pose& pose) {
  Eigen::Quaterniond q(pose.linear());
  q.normalize();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  return q;
}

bool isRigid(const Eigen::Matrix4d& matrix, double tolerance) {
  if (!matrix.allFinite()) return false;
  if ((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > tolerance) return false;
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  const Eigen::Matrix3d residual = R.transpose() * R - Eigen::Matrix3d::Identity();
  return residual.cwiseAbs().maxCoeff() <= tolerance && R.determinant() > 0.0;
}

double angleBetween(const Pose& a, const Pose& b) {
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
}

bool isNear(const Pose& a, const Pose& b, double distance_m, double angle_rad) {
  return (a.translation() - b.translation()).norm() <= distance_m && angleBetween(a, b) <= angle_rad;
}

}  // namespace vantage
