#include "core/motion/inverse_kinematics.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/geometry/check.h"
#include "core/motion/spherical_wrist.h"

namespace vantage {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxArmJoints>;
using Normal = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxArmJoints, kMaxArmJoints>;
using Twist = Eigen::Matrix<double, 6, 1>;

/// What is missing to the target: metres, then a rotation vector in rad, both in the base frame.
Twist missing(const Pose& reached, const Pose& target) {
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(target.linear() * reached.linear().transpose()));
  Twist error;
  error << target.translation() - reached.translation(), turn.axis() * turn.angle();
  return error;
}

/// Motion of the camera for a unit speed of each joint, in the base frame.
Jacobian jacobianAt(const RobotModel& model, const ArmFrames& frames) {
  Jacobian jacobian(6, model.jointCount());
  const Eigen::Vector3d tip = frames.T_base_camera.translation();
  for (int i = 0; i < model.jointCount(); ++i) {
    const Pose& frame = frames.T_base_joint[i];
    const Eigen::Vector3d axis = frame.linear() * model.joints[i].axis;
    if (model.joints[i].prismatic)
      jacobian.col(i) << axis, Eigen::Vector3d::Zero();
    else
      jacobian.col(i) << axis.cross(tip - frame.translation()), axis;
  }
  return jacobian;
}

/// Levenberg-Marquardt from one start; empty if it does not arrive. A metre weighs as much as a radian.
std::optional<JointVector> descend(const RobotModel& model, const Pose& target, JointVector q,
                                   const IkConfig& config) {
  ArmFrames frames = forwardKinematics(model, q);
  Twist error = missing(frames.T_base_camera, target);
  double damping = 1e-2;
  for (int i = 0; i < config.iterations; ++i) {
    if (error.norm() <= config.tolerance / 2) return q;
    const Jacobian jacobian = jacobianAt(model, frames);
    Normal normal = jacobian.transpose() * jacobian;
    normal.diagonal().array() += damping;
    const JointVector next = q + JointVector(normal.ldlt().solve(jacobian.transpose() * error));
    ArmFrames next_frames = forwardKinematics(model, next);
    const Twist next_error = missing(next_frames.T_base_camera, target);
    if (!(next_error.norm() < error.norm())) {
      damping *= 8.0;
      if (!(damping < 1e6)) return std::nullopt;
      continue;
    }
    damping = std::max(damping / 8.0, 1e-12);
    q = next;
    frames = std::move(next_frames);
    error = next_error;
  }
  if (error.norm() <= config.tolerance / 2) return q;
  return std::nullopt;
}

/// Points that fill [0,1) evenly, one dimension a prime (Halton 1960).
double halton(int index, int dimension) {
  constexpr int kPrimes[kMaxArmJoints] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
  double result = 0.0, share = 1.0;
  for (int n = index; n > 0; n /= kPrimes[dimension]) {
    share /= kPrimes[dimension];
    result += share * (n % kPrimes[dimension]);
  }
  return result;
}

/// Full turns added or taken away until the value is within the limits and nearest to `near`.
std::optional<double> turnedInto(const ArmJoint& joint, double value, double near) {
  constexpr double kRounding = 1e-9;
  if (joint.revolute()) {
    value += kTurn * std::round((near - value) / kTurn);
    if (value > joint.upper + kRounding)
      value -= kTurn * std::ceil((value - joint.upper - kRounding) / kTurn);
    if (value < joint.lower - kRounding)
      value += kTurn * std::ceil((joint.lower - kRounding - value) / kTurn);
  }
  if (!(value >= joint.lower - kRounding && value <= joint.upper + kRounding)) return std::nullopt;
  return std::clamp(value, joint.lower, joint.upper);
}

bool reaches(const RobotModel& model, const JointVector& q, const Pose& target, double tolerance) {
  const Pose pose = cameraPose(model, q);
  return (pose.translation() - target.translation()).norm() <= tolerance &&
         (pose.linear() - target.linear()).norm() <= std::numbers::sqrt2 * tolerance;
}

}  // namespace

void IkConfig::validate() const {
  requireInRange("robot.ik_seeds", seeds, 0, 100000);
  requireInRange("robot.ik_iterations", iterations, 1, 100000);
  requireInRange("robot.ik_tolerance", tolerance, 1e-12, 1e-2);
  requireInRange("robot.ik_distinct", distinct, 0.0, 1.0);
}

struct InverseKinematics::Data {
  RobotModel model;
  IkConfig config;
  std::optional<SphericalWrist> closed_form;

  /// Adds a configuration if it is within the limits, really gets there, and is new.
  void take(JointVector q, const Pose& target, const JointVector& near,
            std::vector<JointVector>& solutions) const;
  void solveNumerically(const Pose& target, const JointVector& near,
                        std::vector<JointVector>& solutions) const;
  /// Start `index` of the numeric search; 0 is the current configuration.
  JointVector start(int index, const JointVector& near) const;
};

void InverseKinematics::Data::take(JointVector q, const Pose& target, const JointVector& near,
                                   std::vector<JointVector>& solutions) const {
  for (int i = 0; i < model.jointCount(); ++i) {
    const auto value = turnedInto(model.joints[i], q[i], near[i]);
    if (!value) return;
    q[i] = *value;
  }
  // The closed form gives each solution once, or twice where two meet.
  const double tolerance = closed_form ? 1e-6 : config.tolerance;
  const double distinct = closed_form ? 1e-6 : config.distinct;
  if (!reaches(model, q, target, tolerance)) return;
  for (const JointVector& known : solutions)
    if ((known - q).cwiseAbs().maxCoeff() <= distinct) return;
  solutions.push_back(std::move(q));
}

JointVector InverseKinematics::Data::start(int index, const JointVector& near) const {
  JointVector q(model.jointCount());
  for (int i = 0; i < model.jointCount(); ++i) {
    const ArmJoint& joint = model.joints[i];
    // Full turns are added afterwards, so a wide joint needs starts on one turn only.
    double low = joint.lower, high = joint.upper;
    if (joint.revolute() && !(high - low <= kTurn)) low = -kTurn / 2, high = kTurn / 2;
    q[i] = index == 0 ? near[i] : low + halton(index, i) * (high - low);
  }
  return q;
}

void InverseKinematics::Data::solveNumerically(const Pose& target, const JointVector& near,
                                               std::vector<JointVector>& solutions) const {
  for (int s = 0; s <= config.seeds; ++s)
    if (const auto q = descend(model, target, start(s, near), config)) take(*q, target, near, solutions);
}

InverseKinematics::InverseKinematics(const RobotModel& model, const IkConfig& config) {
  config.validate();
  data_.reset(new Data{model, config, SphericalWrist::of(model)});
}
InverseKinematics::~InverseKinematics() = default;
InverseKinematics::InverseKinematics(InverseKinematics&&) noexcept = default;
InverseKinematics& InverseKinematics::operator=(InverseKinematics&&) noexcept = default;

const RobotModel& InverseKinematics::model() const {
  return data_->model;
}
bool InverseKinematics::analytic() const {
  return data_->closed_form.has_value();
}

std::vector<JointVector> InverseKinematics::solve(const Pose& T_base_camera, const JointVector& near) const {
  std::vector<JointVector> solutions;
  if (!T_base_camera.matrix().allFinite()) return solutions;
  if (data_->closed_form) {
    for (const JointVector& q : data_->closed_form->solve(T_base_camera, near))
      data_->take(q, T_base_camera, near, solutions);
  } else {
    data_->solveNumerically(T_base_camera, near, solutions);
  }
  std::stable_sort(solutions.begin(), solutions.end(), [&](const JointVector& a, const JointVector& b) {
    return jointTravel_s(data_->model, near, a) < jointTravel_s(data_->model, near, b);
  });
  return solutions;
}

double jointTravel_s(const RobotModel& model, const JointVector& from, const JointVector& to) {
  double longest = 0.0;
  for (int i = 0; i < model.jointCount(); ++i)
    longest = std::max(longest, std::abs(to[i] - from[i]) / model.joints[i].max_velocity);
  return longest;
}

}  // namespace vantage
