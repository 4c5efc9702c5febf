#include "core/motion/arm_path.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

#include "core/geometry/check.h"
#include "core/motion/rrt_connect.h"
#include "core/motion/shortcut.h"

namespace vantage {
namespace {

constexpr double kSpacing_rad = 0.2;  // of the vertices that may be joined when a path is shortened

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

JointVector clampedToLimits(const RobotModel& model, JointVector q) {
  for (int i = 0; i < model.jointCount(); ++i)
    q[i] = std::clamp(q[i], model.joints[i].lower, model.joints[i].upper);
  return q;
}

/// Solutions of the view without contact, nearest first; the facts go into `result`.
std::vector<JointVector> freeSolutions(const InverseKinematics& inverse, const ArmCollision& collision,
                                       const JointVector& start, const Pose& T_base_camera, ArmPath& result) {
  std::vector<JointVector> free;
  for (const JointVector& solution : inverse.solve(T_base_camera, start)) {
    ++result.solutions;
    const ArmContact contact = collision.check(solution);
    if (contact.free())
      free.push_back(solution);
    else if (result.contact.free())
      result.contact = contact;
  }
  result.free_solutions = static_cast<int>(free.size());
  return free;
}

/// Looks for a way to one of several configurations.
struct Search {
  const RobotModel& model;
  const ArmCollision& collision;
  const ArmPathConfig& config;
  std::uint64_t seed;

  bool segmentFree(const JointVector& a, const JointVector& b) const {
    return freeMotion(model, collision, a, b, config.check_step_m);
  }
  void goStraight(const JointVector& start, const std::vector<JointVector>& goals, ArmPath& result) const {
    const auto goal =
        std::find_if(goals.begin(), goals.end(), [&](const JointVector& q) { return segmentFree(start, q); });
    if (goal == goals.end()) return;
    result.straight = true;
    result.configurations = {start, *goal};
  }
  void goAround(const JointVector& start, const std::vector<JointVector>& goals, ArmPath& result) const {
    for (std::size_t g = 0; g < goals.size() && !result.found(); ++g) {
      const RrtResult found = rrtConnect(queryFor(start, goals[g], g));
      result.iterations += found.iterations;
      result.timed_out = result.timed_out || found.timed_out;
      if (found.path.empty()) continue;
      const auto segment_free = [&](const JointVector& a, const JointVector& b) { return segmentFree(a, b); };
      result.configurations = shortened(found.path, segment_free, kSpacing_rad);
    }
  }
  RrtQuery queryFor(const JointVector& start, const JointVector& goal, std::size_t index) const {
    RrtQuery query;
    query.start = start;
    query.goal = goal;
    setRanges(model, query);
    query.valid = [&](const JointVector& q) { return collision.check(q).free(); };
    query.segment_valid = [&](const JointVector& a, const JointVector& b) { return segmentFree(a, b); };
    query.range = config.rrt_range_rad;
    query.iterations = config.rrt_iterations;
    query.safety_time_s = config.safety_time_s;
    query.seed = seed + index * 0x9e3779b97f4a7c15u;  // a stream of its own for each goal
    return query;
  }
};

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
  const auto parts =
      std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(sweepBound(model, step) / check_step_m)));
  // The ends first: most motions that fail, fail there.
  if (!collision.check(to).free() || !collision.check(from).free()) return false;
  for (std::int64_t p = 1; p < parts; ++p)
    if (!collision.check(from + step * (static_cast<double>(p) / static_cast<double>(parts))).free())
      return false;
  return true;
}

ArmPath planArmPath(const InverseKinematics& inverse, const ArmCollision& collision, const JointVector& from,
                    const Pose& T_base_camera, const ArmPathConfig& config, std::uint64_t seed) {
  config.validate();
  if (!inverse.model().withinLimits(from))
    throw std::invalid_argument("the arm's start lies beyond its joint limits");
  const JointVector start = clampedToLimits(inverse.model(), from);
  ArmPath result;
  std::vector<JointVector> goals = freeSolutions(inverse, collision, start, T_base_camera, result);
  if (goals.empty()) return result;
  if (const ArmContact contact = collision.check(start); !contact.free()) {
    result.contact = contact;
    result.start_blocked = true;
    return result;
  }
  if (static_cast<int>(goals.size()) > config.goals) goals.resize(config.goals);
  const Search search{inverse.model(), collision, config, seed};
  search.goStraight(start, goals, result);
  if (!result.found()) search.goAround(start, goals, result);
  return result;
}

}  // namespace vantage
