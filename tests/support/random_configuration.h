#pragma once

#include <algorithm>
#include <numbers>
#include <random>

#include "core/motion/robot_model.h"

namespace vantage::test {

/// Uniform within the limits; a joint of several turns within one of them.
inline JointVector randomConfiguration(const RobotModel& model, std::mt19937_64& random) {
  JointVector q(model.jointCount());
  for (int i = 0; i < model.jointCount(); ++i) {
    const double low = std::max(model.joints[i].lower, -std::numbers::pi),
                 high = std::min(model.joints[i].upper, std::numbers::pi);
    q[i] = low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
  }
  return q;
}

}  // namespace vantage::test
