#include "hardware/simulated_robot.h"

namespace vantage {

FreeFlyer::FreeFlyer(const FreeFlyerConfig& config, const Pose& T_world_camera)
    : planner_(config), T_world_camera_(T_world_camera) {}

MotionPlan FreeFlyer::plan(const Pose& T_world_camera, std::uint64_t seed) {
  return planner_.plan(state(), T_world_camera, seed);
}

double FreeFlyer::execute(const MotionPlan& plan, const RunControl& control) {
  control.check();
  if (plan.waypoints.empty()) return 0.0;
  T_world_camera_ = plan.waypoints.back();
  return plan.length_m / planner_.config().speed_m_per_s;
}

}  // namespace vantage
