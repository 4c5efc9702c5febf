#include "hardware/ros_bridge.h"
#include "io/error.h"

namespace vantage {
namespace {

constexpr const char* kAbsent =
    "this program was built without ROS; install libroscpp-dev libsensor-msgs-dev libtrajectory-msgs-dev "
    "libactionlib-dev python3-gencpp ros-actionlib-msgs and configure again";

}  // namespace

std::unique_ptr<LiveCamera> openRosCamera(const std::string& topic, const Eigen::Vector2d&, double) {
  throw InputError("ros:" + topic, kAbsent);
}

std::unique_ptr<ArmLink> rosArmLink(const RobotModel&, const RosArmTopics& topics, double) {
  throw InputError("ros:" + topics.controller, kAbsent);
}

DeviceKind rosDevices() {
  return {"ros", false, kAbsent, {}};
}

}  // namespace vantage
