#include "tests/support/ros_server.h"

#include <actionlib/server/simple_action_server.h>
#include <control_msgs/FollowJointTrajectoryAction.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>

#include <cmath>
#include <cstring>

namespace vantage::test {

using Server = actionlib::SimpleActionServer<control_msgs::FollowJointTrajectoryAction>;

struct RosServer::State {
  explicit State(const std::string& space)
      : node(space),
        images(node.advertise<sensor_msgs::Image>("camera/image_raw", 1)),
        infos(node.advertise<sensor_msgs::CameraInfo>("camera/camera_info", 1)),
        joints(node.advertise<sensor_msgs::JointState>("joint_states", 1)),
        server(node, "follow_joint_trajectory", false) {
    server.start();
  }
  ros::NodeHandle node;
  ros::Publisher images, infos, joints;
  Server server;
};

RosServer::RosServer(const std::string& space) {
  ros::init(ros::M_string(), "robot", ros::init_options::AnonymousName | ros::init_options::NoRosout);
  state_ = std::make_unique<State>(space);
}
RosServer::~RosServer() = default;

bool RosServer::ok() const {
  return ros::ok();
}

void RosServer::spinOnce() {
  ros::spinOnce();
}

std::optional<RosServer::Goal> RosServer::newGoal() {
  if (!state_->server.isNewGoalAvailable()) return std::nullopt;
  const auto message = state_->server.acceptNewGoal();
  Goal goal;
  goal.joints = message->trajectory.joint_names;
  for (const auto& point : message->trajectory.points) {
    goal.time_s.push_back(point.time_from_start.toSec());
    goal.positions.push_back(point.positions);
  }
  return goal;
}

bool RosServer::stopWanted() const {
  return state_->server.isPreemptRequested();
}
void RosServer::succeed() {
  state_->server.setSucceeded();
}
void RosServer::stopped() {
  state_->server.setPreempted();
}
void RosServer::abort(const std::string& why) {
  control_msgs::FollowJointTrajectoryResult result;
  result.error_code = control_msgs::FollowJointTrajectoryResult::PATH_TOLERANCE_VIOLATED;
  result.error_string = why;
  state_->server.setAborted(result);
}

void RosServer::publishJoints(double stamp_s, const std::vector<std::string>& names,
                              const std::vector<double>& positions) {
  sensor_msgs::JointState message;
  message.header.stamp = ros::Time(stamp_s);
  message.name = names;
  message.position = positions;
  state_->joints.publish(message);
}

void RosServer::publishDepth(double stamp_s, const DepthImage& depth, const PinholeCamera& camera,
                             const std::string& encoding) {
  sensor_msgs::CameraInfo info;
  info.header.stamp = ros::Time(stamp_s);
  info.width = camera.width;
  info.height = camera.height;
  info.K = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  state_->infos.publish(info);

  sensor_msgs::Image image;
  image.header.stamp = ros::Time(stamp_s);
  image.width = depth.width;
  image.height = depth.height;
  image.encoding = encoding;
  const std::size_t bytes = encoding == "32FC1" ? 4 : 2;
  image.step = static_cast<std::uint32_t>(bytes * image.width);
  image.data.resize(bytes * depth.depth_m.size());
  for (std::size_t i = 0; i < depth.depth_m.size(); ++i) {
    const float z = depth.depth_m[i];
    const auto mm = static_cast<std::uint16_t>(DepthImage::valid(z) ? std::lround(z * 1000.0f) : 0);
    std::memcpy(&image.data[bytes * i], bytes == 4 ? static_cast<const void*>(&z) : &mm, bytes);
  }
  state_->images.publish(image);
}

}  // namespace vantage::test
