#pragma once

#include <memory>

#include "io/config_file.h"
#include "io/run_file.h"

namespace vantage {

/// Plans the motions of a run's robot, its arm or the free flyer, under the given settings; it has seen no
/// map yet.
std::shared_ptr<MotionPlanner> motionPlannerOf(const RunHeader& header, const Settings& settings);

/// Where a run's robot was before it moved to a step's view; the pose is that of the last frame.
RobotState stateAfterScan(const StepRecord& record);

}  // namespace vantage
