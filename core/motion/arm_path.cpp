#include "core/motion/arm_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/check.h"
#include "core/motion/rrt_connect.h"
#include "core/motion/shortcut.h"

namespace vantage {
namespace {

constexpr double kSpacing_rad = 0.2;  // of the vertices that may be joined when a path is shortened

double extentOf(const LinkShape& shape) {
  return shape.kind == ShapeKind::Cuboid ? shape.size_m.norm() / 2 : shape.radius_m + shape.length_m / 2;
}

/// Farthest that anything moved by joint `first` can be from the joint's origin.
double reachBeyond(const RobotModel& model, int first) {
  double chain = 0.0, farthest = 0.0;
  for (int frame = first; frame < model.jointCount(); ++frame) {
    if (frame > first) chain += model.joints[frame].T_parent_joint.translation().norm();
    if (model.joints[frame].prismatic)
      chain += std::max(std::abs(model.joints[frame].lower), std::abs(model.joints[frame].upper));
    for (const LinkShape& shape : model.shapes)
      if (shape.frame == frame)
        farthest = std::max(farthest, chain + shape.T_frame_shape.translation().norm() + extentOf(shape));
  }
  return std::max(farthest, chain + model.T_tip_camera.translation().norm());
}

/// Ranges of the samples: joints of many turns stay near where the motion takes place.
void setRanges(const RobotModel& model, RrtQuery& query) {
  query.lower = query.start;
  query.upper = query.start;
  for (int i = 0; i < model.jointCount(); ++i) {
    const ArmJoint& joint = model.joints[i];
    const double low = std::min(query.start[i], query.goal[i]),
                 high = std::max(query.start[i], query.goal[i]);
    query.lower[i] = std::max(joint.lower, low - std::numbers::pi);
    query.upper[i] = std::min(joint.upper, high + std::numbers::pi);
  }
}

}  // namespace

void ArmPathConfig::validate() const {
  requireInRange("robot.check_step_m", check_step_m, 1e-4, 1.0);
  requireInRange("robot.goals", goals, 1, 1000);
  requireInRange("robot.rrt_iterations", rrt_iterations, 0, 10'000'000);
  requireInRange("robot.rrt_range_rad", rrt_range_rad, 1e-3, 1e3);
  requireInRange("robot.safety_time_s", safety_time_s, 1e-3, 1e6);
}

double sweepBound(const RobotModel& model, const JointVector& step) {
  double bound_m = 0.0;
  for (int i = 0; i < model.jointCount(); ++i)
    bound_m += std::abs(step[i]) * (model.joints[i].prismatic ? 1.0 : reachBeyond(model, i));
  return bound_m;
}

bool freeMotion(const RobotModel& model, const ArmCollision& collision, const JointVector& from,
                const JointVector& to, double check_step_m) {
  const JointVector step = to - from;
  const int parts = std::max(1, static_cast<int>(std::ceil(sweepBound(model, step) / check_step_m)));
  // The ends first: most motions that fail, fail there.
  if (!collision.check(to).free() || !collision.check(from).free()) return false;
  for (int p = 1; p < parts; ++p)
    if (!collision.check(from + step * (static_cast<double>(p) / parts)).free()) return false;
  return true;
}

ArmPath planArmPath(const InverseKinematics& inverse, const ArmCollision& collision, const JointVector& from,
                    const Pose& T_base_camera, const ArmPathConfig& config, std::uint64_t seed) {
  config.validate();
  const RobotModel& model = inverse.model();
  if (!model.withinLimits(from)) throw std::invalid_argument("the arm's start lies beyond its joint limits");
  ArmPath result;
  std::vector<JointVector> goals;
  const std::vector<JointVector> solutions = inverse.solve(T_base_camera, from);
  result.solutions = static_cast<int>(solutions.size());
  for (const JointVector& solution : solutions) {
    const ArmContact contact = collision.check(solution);
    if (contact.free())
      goals.push_back(solution);
    else if (result.contact.free())
      result.contact = contact;
  }
  result.free_solutions = static_cast<int>(goals.size());
  if (goals.empty()) return result;
  if (const ArmContact start = collision.check(from); !start.free()) {
    result.contact = start;
    return result;
  }
  if (static_cast<int>(goals.size()) > config.goals) goals.resize(config.goals);

  const auto segment_free = [&](const JointVector& a, const JointVector& b) {
    return freeMotion(model, collision, a, b, config.check_step_m);
  };
  for (const JointVector& goal : goals) {
    ++result.goals_tried;
    if (!segment_free(from, goal)) continue;
    result.straight = true;
    result.configurations = {from, goal};
    return result;
  }
  result.goals_tried = 0;
  for (const JointVector& goal : goals) {
    ++result.goals_tried;
    RrtQuery query;
    query.start = from;
    query.goal = goal;
    setRanges(model, query);
    query.valid = [&](const JointVector& q) { return collision.check(q).free(); };
    query.segment_valid = segment_free;
    query.range = config.rrt_range_rad;
    query.iterations = config.rrt_iterations;
    query.safety_time_s = config.safety_time_s;
    query.seed = seed;
    const RrtResult found = rrtConnect(query);
    result.iterations += found.iterations;
    result.timed_out = result.timed_out || found.timed_out;
    if (found.path.empty()) continue;
    result.configurations = shortened(found.path, segment_free, kSpacing_rad);
    break;
  }
  return result;
}

}  // namespace vantage
