#pragma once

#include <vector>

#include "core/exploration/explorer.h"
#include "core/motion/arm_planner.h"

namespace vantage {

/// Configurations of the initial scan of an arm: an arc of its first joint around a start that touches
/// nothing, in the space that the operator vouches for. The start is ArmConfig::start_rad, else looked for:
/// the camera looks at the scene's centre from ScanConfig's distance and azimuth, as low as the arm can.
/// \throws ArmRefusal if there is none, saying what the arm would touch
std::vector<JointVector> armStart(const ArmPlanner& arm, const ScanConfig& scan);

}  // namespace vantage
