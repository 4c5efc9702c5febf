#include "hardware/ros_bridge.h"
#include "io/error.h"

namespace vantage {
namespace {

constexpr const char* kAbsent =
    "this program was built without ROS; install libroscpp-dev libsensor-msgs-dev libtrajectory-msgs-dev "
    "libactionlib-dev python3-gencpp ros-actionlib-msgs and configure again";

}  // namespace

struct RosCamera::State {};

RosCamera::RosCamera(const std::string& topic, const Eigen::Vector2d&, double) {
  throw InputError("ros:" + topic, kAbsent);
}
RosCamera::~RosCamera() = default;
const PinholeCamera& RosCamera::model() const {
  throw InputError("ros", kAbsent);
}
std::optional<DepthFrame> RosCamera::capture(const Pose&, std::uint64_t) {
  return std::nullopt;
}
std::string RosCamera::trouble() const {
  return kAbsent;
}

std::unique_ptr<ArmLink> rosArmLink(const RobotModel&, const RosArmTopics& topics, double) {
  throw InputError("ros:" + topics.controller, kAbsent);
}

DeviceKind rosDevices() {
  return {"ros", false, kAbsent, {}};
}

}  // namespace vantage
