#pragma once

#include "core/geometry/camera_model.h"
#include "core/geometry/depth_image.h"
#include "core/motion/robot_model.h"

namespace vantage {

/// Depth of an arm's own bodies as its camera sees them: one ray through the centre of every pixel, metres
/// along the optical axis, NaN where there is no body. Bodies that hold the camera itself hide nothing.
/// \param camera_error where the camera truly is in the frame of the camera that the model has
/// \param margin_m the bodies are as much thicker on all sides, >= 0
DepthImage bodyImage(const RobotModel& model, const JointVector& q, const PinholeCamera& camera,
                     double margin_m = 0.0, const Pose& camera_error = Pose::Identity());

/// Makes invalid (NaN) what a body hides: the pixels where `body` is not behind the measurement.
void removeBody(DepthImage& depth, const DepthImage& body);

}  // namespace vantage
