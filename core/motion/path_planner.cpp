#include "core/motion/path_planner.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/check.h"
#include "core/motion/rrt_connect.h"
#include "core/motion/shortcut.h"

namespace vantage {
namespace {

using Path = std::vector<Eigen::Vector3d>;

constexpr double kSpacing_m = 0.05;  // of the vertices that may be joined when a path is shortened

/// Reach and height, without collision.
bool withinLimits(const Eigen::Vector3d& p, const FreeFlyerConfig& config) {
  return p.z() >= config.min_height_m &&
         (config.reach_m <= 0.0 || (p - config.reach_center_m).norm() <= config.reach_m);
}

/// The limits, widened so that they hold `start`.
FreeFlyerConfig limitsWith(const Eigen::Vector3d& start, FreeFlyerConfig config) {
  config.min_height_m = std::min(config.min_height_m, start.z());
  if (config.reach_m > 0.0)
    config.reach_m = std::max(config.reach_m, (start - config.reach_center_m).norm() * (1.0 + 1e-12));
  return config;
}

Box sampleBounds(const CollisionGrid& grid, const FreeFlyerConfig& limits) {
  Box bounds = grid.geometry().bounds();
  if (limits.reach_m > 0.0) {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(limits.reach_m);
    bounds = bounds.intersection(Box(limits.reach_center_m - reach, limits.reach_center_m + reach));
  }
  bounds.min().z() = std::max(bounds.min().z(), limits.min_height_m);
  return bounds;
}

/// Waypoints at the corners, orientations spread over the length.
void setWaypoints(MotionPlan& plan, const Path& path, const Pose& from, const Pose& to) {
  plan.length_m = lengthOf(path);
  const Eigen::Quaterniond first = orientationOf(from), last = orientationOf(to);
  double done = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0) done += (path[i] - path[i - 1]).norm();
    const double share = plan.length_m > 0.0 ? done / plan.length_m : 0.0;
    plan.waypoints.push_back(makePose(path[i], first.slerp(share, last)));
  }
  plan.waypoints.front() = from;
  plan.waypoints.back() = to;
}

}  // namespace

void FreeFlyerConfig::validate() const {
  requireInRange("robot.body_radius_m", body_radius_m, 0.0, 10.0);
  requireInRange("robot.cell_m", cell_m, 1e-4, 10.0);
  requireInRange("robot.reach_m", reach_m, 0.0, 1e3);
  for (int axis = 0; axis < 3; ++axis)
    requireInRange("robot.reach_center_m", reach_center_m[axis], -1e3, 1e3);
  requireInRange("robot.min_height_m", min_height_m, -1e3, 1e3);
  requireInRange("robot.check_step_m", check_step_m, 1e-4, cell_m);
  requireInRange("robot.rrt_iterations", rrt_iterations, 0, 10'000'000);
  requireInRange("robot.rrt_range_m", rrt_range_m, 1e-3, 1e3);
  requireInRange("robot.safety_time_s", safety_time_s, 1e-3, 1e6);
  requireInRange("robot.speed_m_per_s", speed_m_per_s, 1e-4, 1e3);
}

std::string_view tokenOf(Reachability r) {
  constexpr std::string_view kTokens[kReachabilityCount] = {
      "reachable", "out_of_reach", "in_collision", "not_connected", "no_path",
      "timed_out", "not_checked",  "no_frame",     "no_ik",         "self_collision"};
  return kTokens[static_cast<int>(r)];
}

std::string_view toString(Reachability r) {
  switch (r) {
    case Reachability::Reachable:
      return "reachable";
    case Reachability::OutOfReach:
      return "beyond the robot's reach, too low, or outside the mapped volume";
    case Reachability::InCollision:
      return "the body would touch occupied or unknown space";
    case Reachability::NotConnected:
      return "no free space leads there from the current position";
    case Reachability::NoPath:
      return "the path planner found no way within its iterations";
    case Reachability::NoFrame:
      return "no recorded frame that is left was taken near enough";
    case Reachability::NoIk:
      return "no joint configuration within the limits puts the camera there";
    case Reachability::SelfCollision:
      return "the arm would touch itself";
    case Reachability::TimedOut:
      return "path planning was stopped by the wall clock";
    case Reachability::NotChecked:
      return "not checked";
  }
  return "not checked";
}

Reachability checkPosition(const CollisionGrid& grid, const Eigen::Vector3d& position_world,
                           const FreeFlyerConfig& config) {
  if (!position_world.allFinite() || !withinLimits(position_world, config)) return Reachability::OutOfReach;
  if (!grid.geometry().bounds().contains(position_world)) return Reachability::OutOfReach;
  return grid.freeBall(position_world, config.body_radius_m) ? Reachability::Reachable
                                                             : Reachability::InCollision;
}

MotionPlan planPath(const CollisionGrid& grid, const Pose& from, const Pose& to,
                    const FreeFlyerConfig& config, std::uint64_t seed) {
  config.validate();
  const Eigen::Vector3d start = from.translation(), goal = to.translation();
  MotionPlan plan;
  plan.verdict = checkPosition(grid, goal, config);
  if (plan.verdict != Reachability::Reachable) return plan;
  plan.verdict = Reachability::NotConnected;
  const FreeFlyerConfig limits = limitsWith(start, config);
  if (checkPosition(grid, start, limits) != Reachability::Reachable) return plan;
  if (grid.component(start) != grid.component(goal)) return plan;

  // Reach and height are convex: a segment between two points within them stays within.
  const auto segment_free = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return grid.freeSegment(a, b, config.body_radius_m, config.check_step_m);
  };
  plan.verdict = Reachability::Reachable;
  plan.straight = segment_free(start, goal);
  if (plan.straight) {
    setWaypoints(plan, {start, goal}, from, to);
    return plan;
  }
  const Box samples = sampleBounds(grid, limits);
  const RrtQuery query{
      .start = start,
      .goal = goal,
      .lower = samples.min(),
      .upper = samples.max(),
      .valid =
          [&](const JointVector& p) { return checkPosition(grid, p, limits) == Reachability::Reachable; },
      .segment_valid = segment_free,
      .range = config.rrt_range_m,
      .iterations = config.rrt_iterations,
      .safety_time_s = config.safety_time_s,
      .seed = seed};
  const RrtResult found = rrtConnect(query);
  plan.iterations = found.iterations;
  if (found.path.empty())
    plan.verdict = found.timed_out ? Reachability::TimedOut : Reachability::NoPath;
  else
    setWaypoints(plan, shortened(Path(found.path.begin(), found.path.end()), segment_free, kSpacing_m), from,
                 to);
  return plan;
}

FreeFlyerPlanner::FreeFlyerPlanner(const FreeFlyerConfig& config) : config_(config) {
  config_.validate();
}

void FreeFlyerPlanner::observe(const StateGrid& states) {
  grid_ = CollisionGrid(states, config_.cell_m, config_.body_radius_m);
}

Reachability FreeFlyerPlanner::check(const Pose& T_world_camera) const {
  return checkPosition(grid_, T_world_camera.translation(), config_);
}

MotionPlan FreeFlyerPlanner::plan(const RobotState& from, const Pose& T_world_camera,
                                  std::uint64_t seed) const {
  return planPath(grid_, from.T_world_camera, T_world_camera, config_, seed);
}

}  // namespace vantage
