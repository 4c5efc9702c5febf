#pragma once

#include <ros/ros.h>

namespace vantage::ros_topics {

/// This program as a node of ROS: made once, when first needed, and kept until the program ends. A thread of
/// its own runs the callbacks. \throws std::runtime_error if whyNoNode()
ros::NodeHandle& node();

}  // namespace vantage::ros_topics
