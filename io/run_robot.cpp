#include "io/run_robot.h"

namespace vantage {

std::shared_ptr<MotionPlanner> motionPlannerOf(const RunHeader& header, const Settings& settings) {
  if (header.arm) return std::make_shared<ArmPlanner>(header.arm->model, settings.armConfig());
  return std::make_shared<FreeFlyerPlanner>(settings.free_flyer);
}

RobotState stateAfterScan(const StepRecord& record) {
  RobotState state;
  if (!record.scan.empty()) state.T_world_camera = record.scan.back().T_world_camera;
  if (record.joints) state.joints = record.joints->back();
  return state;
}

}  // namespace vantage
