#pragma once

#include <memory>
#include <string>

#include "core/motion/robot_model.h"
#include "hardware/device_list.h"
#include "hardware/live_arm.h"
#include "hardware/live_camera.h"

namespace vantage {

/// Depth camera behind ROS 1: images of type sensor_msgs/Image (`16UC1` or `mono16` in millimetres, `32FC1`
/// in metres), and beside them their calibration, `camera_info`. The image is taken as rectified. Where the
/// master is, says ROS_MASTER_URI. Waits until calibration and a first image came. \param topic of the images
/// \param range_m nearest and farthest range of the camera, metres, which ROS does not tell
/// \param patience_s seconds until a camera that sends nothing counts as lost. \throws InputError without
/// master, images or calibration, saying which
std::unique_ptr<LiveCamera> openRosCamera(const std::string& topic, const Eigen::Vector2d& range_m,
                                          double patience_s = 2.0);

/// Topics of an arm behind ROS 1.
struct RosArmTopics {
  std::string controller;                      ///< of control_msgs/FollowJointTrajectory, e.g. "/arm/follow"
  std::string joint_states = "/joint_states";  ///< of sensor_msgs/JointState
};

/// Arm behind ROS 1. Joints are matched by their names in the model; others in the messages do not matter.
/// \param patience_s seconds without joints until the arm counts as lost. \throws InputError without master,
/// controller or joints, saying which
std::unique_ptr<ArmLink> rosArmLink(const RobotModel& model, const RosArmTopics& topics,
                                    double patience_s = 2.0);

/// Cameras, joints and controllers that the ROS master knows.
DeviceKind rosDevices();

}  // namespace vantage
