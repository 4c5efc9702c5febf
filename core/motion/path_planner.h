#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "core/geometry/pose.h"
#include "core/motion/collision_grid.h"
#include "core/motion/trajectory.h"

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
  NoFrame,       ///< recorded data: no frame left that was taken near enough
  NoIk,          ///< arms: no configuration within the joint limits puts the camera there
  SelfCollision  ///< arms: in every configuration the arm touches itself
};
/// The reason as a person reads it, e.g. "the body would touch occupied or unknown space".
std::string_view toString(Reachability r);
/// One word for tables: `reachable`, `out_of_reach`, `in_collision`, `not_connected`, `no_path`, `timed_out`,
/// `not_checked`, `no_frame`, `no_ik`, `self_collision`.
std::string_view tokenOf(Reachability r);
inline constexpr int kReachabilityCount = 10;

/// Where a robot is.
struct RobotState {
  Pose T_world_camera = Pose::Identity();
  JointVector joints;  ///< of an arm; empty for others
};

/// A motion of the sensor, or why there is none.
struct MotionPlan {
  Reachability verdict = Reachability::NotChecked;
  bool straight = false;        ///< the straight segment, of an arm the straight joint motion, was free
  std::vector<Pose> waypoints;  ///< of the camera, start and goal included; empty if there is no path
  double length_m = 0.0;        ///< way of the camera
  int iterations = 0;           ///< of RRT-Connect
  std::shared_ptr<const JointTrajectory> trajectory = nullptr;  ///< of an arm
  bool by_orientation = false;  ///< another orientation at the same position may have another verdict
};

/// Plans the motions of one robot in the map that it was shown last. Not for several threads at once.
class MotionPlanner {
 public:
  virtual ~MotionPlanner() = default;
  /// Takes over a map; before the first one nothing is known to be free.
  virtual void observe(const StateGrid& states) = 0;
  /// Whether the camera may be at a pose at all, without asking for a path: NoPath and NotConnected are never
  /// returned.
  virtual Reachability check(const Pose& T_world_camera) const = 0;
  /// A motion, or why there is none. The same arguments and map give the same one, unless the wall clock
  /// struck (TimedOut).
  virtual MotionPlan plan(const RobotState& from, const Pose& T_world_camera, std::uint64_t seed) const = 0;
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

/// checkPosition() and planPath() behind the common interface.
class FreeFlyerPlanner : public MotionPlanner {
 public:
  /// \throws std::invalid_argument as FreeFlyerConfig::validate().
  explicit FreeFlyerPlanner(const FreeFlyerConfig& config);

  const FreeFlyerConfig& config() const { return config_; }
  void observe(const StateGrid& states) override;
  Reachability check(const Pose& T_world_camera) const override;
  MotionPlan plan(const RobotState& from, const Pose& T_world_camera, std::uint64_t seed) const override;

 private:
  FreeFlyerConfig config_;
  CollisionGrid grid_;
};

}  // namespace vantage
