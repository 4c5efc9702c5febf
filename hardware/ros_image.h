#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "core/geometry/camera_model.h"
#include "core/geometry/depth_image.h"

namespace vantage::ros_topics {

/// Metres; what is 0 or no number becomes invalid. \throws std::invalid_argument for another encoding than
/// `16UC1`, `mono16` (millimetres) and `32FC1` (metres), and for data that do not fit the size
DepthImage depthOf(const sensor_msgs::Image& image);

/// Size and camera matrix K; the distortion is left out. \throws std::invalid_argument for a size or matrix
/// that is none
PinholeCamera cameraOf(const sensor_msgs::CameraInfo& info);

}  // namespace vantage::ros_topics
