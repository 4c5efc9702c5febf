#include "core/motion/arm_planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "core/geometry/check.h"

namespace vantage {
namespace {

constexpr double kWaypointSpacing_m = 0.02;  // of the camera poses that show the way
constexpr double kStart_rad = 0.01;          // joints may be that far from where a motion begins

/// Camera poses along a trajectory, and the length of the way.
void setWaypoints(const ArmPlanner& planner, const Pose& goal, MotionPlan& plan) {
  const JointTrajectory& trajectory = *plan.trajectory;
  double since_last_m = 0.0;
  Pose previous;
  for (std::size_t p = 0; p < trajectory.size(); ++p) {
    const Pose pose = planner.cameraPose(trajectory.positions[p]);
    const double step_m = p > 0 ? (pose.translation() - previous.translation()).norm() : 0.0;
    plan.length_m += step_m;
    since_last_m += step_m;
    previous = pose;
    if (p > 0 && since_last_m < kWaypointSpacing_m) continue;
    plan.waypoints.push_back(pose);
    since_last_m = 0.0;
  }
  if (plan.waypoints.size() > 1 && since_last_m > 0.0)
    plan.waypoints.push_back(goal);
  else if (plan.waypoints.size() > 1)
    plan.waypoints.back() = goal;
  else
    plan.waypoints = {plan.waypoints.front(), goal};
}

Reachability verdictOf(const ArmPath& path) {
  if (path.found()) return Reachability::Reachable;
  if (path.solutions == 0) return Reachability::NoIk;
  if (path.start_blocked) return Reachability::NotConnected;
  if (path.free_solutions == 0)
    return path.contact.with == ArmContact::With::Itself ? Reachability::SelfCollision
                                                         : Reachability::InCollision;
  return path.timed_out ? Reachability::TimedOut : Reachability::NoPath;
}

}  // namespace

bool ArmConfig::operator==(const ArmConfig& other) const {
  const auto same_box = [](const Box& a, const Box& b) { return a.min() == b.min() && a.max() == b.max(); };
  return base_m == other.base_m && base_yaw_rad == other.base_yaw_rad && start_rad == other.start_rad &&
         start_arc_rad == other.start_arc_rad && cell_m == other.cell_m && path == other.path &&
         timing == other.timing && body_margin_m == other.body_margin_m &&
         std::ranges::equal(clear_boxes, other.clear_boxes, same_box);
}

void ArmConfig::validate() const {
  for (int axis = 0; axis < 3; ++axis) requireInRange("arm.base_m", base_m[axis], -1e3, 1e3);
  requireInRange("arm.base_yaw", base_yaw_rad, -7.0, 7.0);
  for (const Box& box : clear_boxes)
    if (!(box.min().array() < box.max().array()).all())
      throw std::invalid_argument("arm.clear_boxes_m: a box needs three lower and three greater upper ends");
  requireInRange("arm.start_arc", start_arc_rad, 0.0, 2.0 * std::numbers::pi);
  requireInRange("robot.cell_m", cell_m, 1e-3, 10.0);
  path.validate();
  timing.validate();
  requireInRange("arm.body_margin_m", body_margin_m, 0.0, 1.0);
}

void ArmErrors::validate() const {
  requireInRange("arm.encoder_noise", encoder_noise_rad, 0.0, 1.0);
  requireInRange("arm.mount_error_m", mount_error_m, 0.0, 1.0);
  requireInRange("arm.mount_error", mount_error_rad, 0.0, 3.2);
}

std::vector<Box> ArmConfig::aroundTheTable() {
  return {{Eigen::Vector3d(-1.5, -2.4, -0.05), Eigen::Vector3d(1.5, -0.66, 2.4)},
          {Eigen::Vector3d(-1.5, -0.66, 0.8), Eigen::Vector3d(1.5, 1.0, 2.4)},
          {Eigen::Vector3d(-0.3, -0.66, 0.2), Eigen::Vector3d(0.3, -0.57, 0.8)}};
}

ArmPlace ArmConfig::place() const {
  ArmPlace place;
  place.T_world_base =
      makePose(base_m, Eigen::Quaterniond(Eigen::AngleAxisd(base_yaw_rad, Eigen::Vector3d::UnitZ())));
  place.clear_boxes = clear_boxes;
  return place;
}

std::string contactText(const ArmContact& contact) {
  switch (contact.with) {
    case ArmContact::With::Nothing:
      return "touches nothing";
    case ArmContact::With::Obstacle:
      return contact.link + " would touch occupied or unknown space";
    case ArmContact::With::Itself:
      return contact.link + " would touch " + contact.other;
  }
  return "";
}

ArmPlanner::ArmPlanner(const RobotModel& model, const ArmConfig& config)
    : config_((config.validate(), config)),
      T_world_base_(config.place().T_world_base),
      inverse_(model),
      collision_(model, config.place()) {}

void ArmPlanner::observe(const StateGrid& states) {
  const CollisionGrid cells(states, config_.cell_m);
  if (!(cells.geometry() == cells_)) collision_ = ArmCollision(model(), config_.place());
  collision_.update(cells);
  cells_ = cells.geometry();
  mapped_ = states.geometry().bounds();
}

Reachability ArmPlanner::check(const Pose& T_world_camera) const {
  const std::lock_guard lock(one_at_a_time_);
  if (!mapped_.contains(T_world_camera.translation())) return Reachability::OutOfReach;
  Reachability verdict = Reachability::NoIk;
  for (const JointVector& q : solutions(T_world_camera, JointVector::Zero(model().jointCount()))) {
    const ArmContact found = contact(q);
    if (found.free()) return Reachability::Reachable;
    if (verdict == Reachability::NoIk)
      verdict =
          found.with == ArmContact::With::Itself ? Reachability::SelfCollision : Reachability::InCollision;
  }
  return verdict;
}

MotionPlan ArmPlanner::plan(const RobotState& from, const Pose& T_world_camera, std::uint64_t seed) const {
  const std::lock_guard lock(one_at_a_time_);
  MotionPlan plan;
  plan.verdict = Reachability::OutOfReach;
  plan.by_orientation = true;
  if (!mapped_.contains(T_world_camera.translation())) return plan;
  const ArmPath path = planArmPath(inverse_, collision_, from.joints,
                                   T_world_base_.inverse() * T_world_camera, config_.path, seed);
  plan.verdict = verdictOf(path);
  plan.straight = path.straight;
  plan.iterations = path.iterations;
  if (!path.found()) return plan;
  JointTrajectory trajectory = timed(path.configurations);
  // Its points lie elsewhere than those that were looked at on the way here: it may graze something there.
  if (!refusal(trajectory, from.joints).empty()) {
    plan.verdict = Reachability::NoPath;
    return plan;
  }
  plan.trajectory = std::make_shared<const JointTrajectory>(std::move(trajectory));
  setWaypoints(*this, T_world_camera, plan);
  return plan;
}

std::vector<JointVector> ArmPlanner::solutions(const Pose& T_world_camera, const JointVector& near) const {
  return inverse_.solve(T_world_base_.inverse() * T_world_camera, near);
}

bool ArmPlanner::freeMotion(const JointVector& from, const JointVector& to) const {
  return vantage::freeMotion(model(), collision_, from, to, config_.path.check_step_m);
}

JointTrajectory ArmPlanner::timed(const std::vector<JointVector>& corners) const {
  return timedTrajectory(model(), corners, config_.timing);
}

std::string ArmPlanner::refusal(const JointTrajectory& trajectory, const JointVector& arm_is_at) const {
  if (std::string violation = limitViolation(model(), trajectory); !violation.empty()) return violation;
  if (const double away = (trajectory.positions.front() - arm_is_at).cwiseAbs().maxCoeff();
      !(away <= kStart_rad))
    return fmt::format("a joint is {:.3f} rad away from where it begins", away);
  for (std::size_t p = 0; p < trajectory.size(); ++p) {
    const JointVector& q = trajectory.positions[p];
    const JointVector& before = trajectory.positions[p > 0 ? p - 1 : 0];
    if (freeMotion(before, q)) continue;
    const ArmContact found = contact(q);
    return fmt::format("{} {:.2f} s {}", found.free() ? "just before" : "at", trajectory.time_s[p],
                       found.free() ? "the arm would touch something" : contactText(found));
  }
  return {};
}

void ArmPlanner::requireSafe(const JointTrajectory& trajectory, const JointVector& arm_is_at) const {
  if (const std::string reason = refusal(trajectory, arm_is_at); !reason.empty())
    throw ArmRefusal("the motion is not sent: " + reason);
}

}  // namespace vantage
