#include "core/motion/robot_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vantage {

std::string_view toString(ShapeKind kind) {
  constexpr std::string_view kNames[] = {"box", "cylinder", "capsule", "sphere"};
  return kNames[static_cast<int>(kind)];
}

double extentOf(const LinkShape& shape) {
  const double half =
      shape.kind == ShapeKind::Cuboid ? shape.size_m.norm() / 2 : shape.radius_m + shape.length_m / 2;
  return shape.T_frame_shape.translation().norm() + half;
}

bool RobotModel::withinLimits(const JointVector& q, double tolerance) const {
  if (q.size() != jointCount()) return false;
  for (int i = 0; i < jointCount(); ++i)
    if (!std::isfinite(q[i]) || q[i] < joints[i].lower - tolerance || q[i] > joints[i].upper + tolerance)
      return false;
  return true;
}

Pose jointMotion(const ArmJoint& joint, double value) {
  Pose motion = Pose::Identity();
  if (joint.prismatic)
    motion.translation() = joint.axis * value;
  else
    motion.linear() = Eigen::AngleAxisd(value, joint.axis).toRotationMatrix();
  return motion;
}

ArmFrames forwardKinematics(const RobotModel& model, const JointVector& q) {
  assert(q.size() == model.jointCount());
  ArmFrames frames;
  frames.T_base_joint.reserve(model.joints.size());
  Pose T_base_joint = Pose::Identity();
  for (int i = 0; i < model.jointCount(); ++i) {
    T_base_joint = T_base_joint * model.joints[i].T_parent_joint * jointMotion(model.joints[i], q[i]);
    frames.T_base_joint.push_back(T_base_joint);
  }
  frames.T_base_camera = T_base_joint * model.T_tip_camera;
  return frames;
}

Pose cameraPose(const RobotModel& model, const JointVector& q) {
  Pose pose = Pose::Identity();
  for (int i = 0; i < model.jointCount(); ++i)
    pose = pose * model.joints[i].T_parent_joint * jointMotion(model.joints[i], q[i]);
  return pose * model.T_tip_camera;
}

double reachBeyond(const RobotModel& model, int first) {
  double chain = 0.0, farthest = 0.0;
  for (int frame = first; frame < model.jointCount(); ++frame) {
    const ArmJoint& joint = model.joints[frame];
    if (frame > first) chain += joint.T_parent_joint.translation().norm();
    // The frame of a sliding joint slides with it; that of the first one is where the distance is taken from.
    if (frame > first && joint.prismatic) chain += std::max(std::abs(joint.lower), std::abs(joint.upper));
    for (const LinkShape& shape : model.shapes)
      if (shape.frame == frame) farthest = std::max(farthest, chain + extentOf(shape));
  }
  return std::max(farthest, chain + model.T_tip_camera.translation().norm());
}

}  // namespace vantage
