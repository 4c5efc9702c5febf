#include "hardware/simulated_robot.h"

namespace vantage {

FreeFlyer::FreeFlyer(const FreeFlyerConfig& config, const Pose& T_world_camera)
    : config_(config), T_world_camera_(T_world_camera) {
  config_.validate();
}

void FreeFlyer::observe(const StateGrid& states) {
  grid_ = CollisionGrid(states, config_.cell_m, config_.body_radius_m);
}

MotionPlan FreeFlyer::plan(const Pose& T_world_camera, std::uint64_t seed) {
  return planPath(grid_, T_world_camera_, T_world_camera, config_, seed);
}

double FreeFlyer::execute(const MotionPlan& plan) {
  if (plan.waypoints.empty()) return 0.0;
  T_world_camera_ = plan.waypoints.back();
  return plan.length_m / config_.speed_m_per_s;
}

}  // namespace vantage
