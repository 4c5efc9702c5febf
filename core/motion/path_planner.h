#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/geometry/pose.h"
#include "core/motion/collision_grid.h"

namespace vantage {

/// Free-flying sensor: a ball that must stay in free cells and inside a ball of reach (D-B26, section 10).
struct FreeFlyerConfig {
  double body_radius_m = 0.08;                         ///< metres, >= 0
  double cell_m = 0.04;                                ///< collision cell, metres
  double reach_m = 1.4;                                ///< metres, 0 = no limit
  Eigen::Vector3d reach_center_m = {0.0, -0.85, 0.3};  ///< world
  double min_height_m = 0.05;                          ///< sensor stays above, world z, metres
  double check_step_m = 0.01;   ///< along straight segments, metres, > 0, at most a cell
  int rrt_iterations = 4000;    ///< of RRT-Connect, per query, 0 = straight lines only
  double rrt_range_m = 0.3;     ///< longest tree edge, metres, > 0
  double safety_time_s = 30.0;  ///< wall clock abort, recorded when it strikes, > 0
  double speed_m_per_s = 0.25;  ///< of the simulated motion, metres a second
  bool operator==(const FreeFlyerConfig&) const = default;
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// Why a pose can or cannot be taken.
enum class Reachability : std::uint8_t {
  Reachable,     ///< a path was found
  OutOfReach,    ///< outside the ball of reach, below the minimum height, or outside the mapped volume
  InCollision,   ///< the body touches occupied or unknown cells
  NotConnected,  ///< no free space connects it with the current position
  NoPath,        ///< the path planner gave up
  TimedOut,      ///< the wall clock abort struck
  NotChecked,
  NoFrame,  ///< recorded data: no frame left that was taken near enough
};
/// The reason as a person reads it, e.g. "the body would touch occupied or unknown space".
std::string_view toString(Reachability r);
/// One word for tables: `reachable`, `out_of_reach`, `in_collision`, `not_connected`, `no_path`, `timed_out`,
/// `not_checked`, `no_frame`.
std::string_view tokenOf(Reachability r);
inline constexpr int kReachabilityCount = 8;

/// A motion of the sensor, or why there is none.
struct MotionPlan {
  Reachability verdict = Reachability::NotChecked;
  bool straight = false;        ///< the straight segment was free
  std::vector<Pose> waypoints;  ///< start and goal included; empty if there is no path
  double length_m = 0.0;
  int iterations = 0;  ///< of RRT-Connect
};

/// Whether the sensor may be at a position at all; NoPath and NotConnected are never returned.
Reachability checkPosition(const CollisionGrid& grid, const Eigen::Vector3d& position_world,
                           const FreeFlyerConfig& config);

/// Straight line, else RRT-Connect (OMPL, seeded sampler, bounded iterations) and shortcutting; the same seed
/// and map give the same path, unless the wall clock struck (TimedOut). The body stays in free cells and the
/// sensor within reach and above the minimum height; a start beyond those limits widens them to itself, so
/// that the sensor can come back. A start in collision is NotConnected. Orientations turn evenly over the
/// length of the path.
MotionPlan planPath(const CollisionGrid& grid, const Pose& from, const Pose& to,
                    const FreeFlyerConfig& config, std::uint64_t seed);

}  // namespace vantage
