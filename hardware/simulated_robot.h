#pragma once

#include "core/exploration/ports.h"
#include "core/motion/path_planner.h"

namespace vantage {

/// Free-flying sensor: goes where its body fits and its reach allows (D-B26). Moves are modelled, not waited
/// for.
class FreeFlyer : public Robot {
 public:
  /// \throws std::invalid_argument as FreeFlyerConfig::validate().
  FreeFlyer(const FreeFlyerConfig& config, const Pose& T_world_camera);

  std::string name() const override { return "free"; }
  RobotState state() const override { return {T_world_camera_, {}}; }
  void adjust(const Pose& T_world_camera, const RunControl&) override { T_world_camera_ = T_world_camera; }
  void observe(const StateGrid& states) override { planner_.observe(states); }
  /// Before the first observe() nothing is known to be free: the verdict is OutOfReach.
  MotionPlan plan(const Pose& T_world_camera, std::uint64_t seed) override;
  /// Goes to the last waypoint; the duration is length / speed. A plan without waypoints moves nothing and
  /// takes 0 s.
  double execute(const MotionPlan& plan, const RunControl& control) override;

 private:
  FreeFlyerPlanner planner_;
  Pose T_world_camera_;
};

}  // namespace vantage
