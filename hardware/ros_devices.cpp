#include <algorithm>

#include "hardware/ros_bridge.h"
#include "hardware/ros_topics.h"

namespace vantage {
namespace {

constexpr std::string_view kResult = "/result";

bool hasSibling(const std::vector<ros_topics::Topic>& topics, const std::string& name, const char* sibling) {
  const std::string wanted = name.substr(0, name.rfind('/') + 1) + sibling;
  return std::ranges::any_of(topics, [&](const auto& topic) { return topic.name == wanted; });
}

}  // namespace

DeviceKind rosDevices() {
  DeviceKind kind{"ros", true, "", {}};
  kind.note = ros_topics::whyNoNode();
  if (!kind.note.empty()) return kind;
  const std::vector<ros_topics::Topic> topics = ros_topics::topics();
  for (const ros_topics::Topic& topic : topics) {
    if (topic.type == "sensor_msgs/Image" && hasSibling(topics, topic.name, "camera_info"))
      kind.devices.push_back({"ros:" + topic.name, "camera", "images with calibration"});
    if (topic.type == "sensor_msgs/JointState")
      kind.devices.push_back({"ros:" + topic.name, "joints", "positions of joints"});
    if (topic.type == "control_msgs/FollowJointTrajectoryActionResult" && topic.name.ends_with(kResult))
      kind.devices.push_back({"ros:" + topic.name.substr(0, topic.name.size() - kResult.size()), "arm",
                              "controller of joint trajectories"});
  }
  if (kind.devices.empty())
    kind.note = "the master at " + ros_topics::masterUri() + " knows no camera and no arm";
  return kind;
}

}  // namespace vantage
