#include "hardware/ros_topics.h"

#include <fmt/format.h>
#include <ros/console.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <stdexcept>
#include <utility>

#include "hardware/ros_image.h"
#include "hardware/ros_node.h"

namespace vantage::ros_topics {
namespace {

/// What ROS says of itself would stand between our own lines; what matters comes back as errors.
void keepQuiet() {
  if (ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Fatal))
    ros::console::notifyLoggerLevelsChanged();
}

struct Node {
  ros::NodeHandle handle;
  ros::AsyncSpinner spinner{1};
};

/// Why ROS_MASTER_URI is none; ROS itself would end the program.
std::string whyNoUri() {
  const char* uri = std::getenv("ROS_MASTER_URI");
  if (!uri || std::regex_match(uri, std::regex("http://[^:/ ]+:[0-9]{1,5}/?"))) return {};
  return fmt::format("ROS_MASTER_URI is '{}', and no address; wanted: http://HOST:PORT", uri);
}

template <class Message>
Subscription subscribe(const std::string& topic, std::function<void(const Message&)> take) {
  return std::make_shared<ros::Subscriber>(node().subscribe<Message>(
      topic, 1, [take = std::move(take)](const boost::shared_ptr<const Message>& message) { take(*message); },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
}

}  // namespace

std::string whyNoNode() {
  if (std::string why = whyNoUri(); !why.empty()) return why;
  if (!ros::isInitialized()) {
    try {
      ros::init(ros::M_string(), "vantage",
                ros::init_options::AnonymousName | ros::init_options::NoSigintHandler |
                    ros::init_options::NoRosout);
    } catch (const ros::Exception& error) {
      return error.what();
    }
    keepQuiet();
  }
  if (ros::master::check()) return {};
  return "no ROS master answers at " + ros::master::getURI() +
         "; start roscore, or say with ROS_MASTER_URI where it runs";
}

ros::NodeHandle& node() {
  static Node* node = nullptr;  // never destroyed: only ended, before what ROS uses is destroyed
  if (node) return node->handle;
  if (const std::string why = whyNoNode(); !why.empty()) throw std::runtime_error(why);
  node = new Node;
  node->spinner.start();
  std::atexit([] {  // its thread would go on while what it uses is destroyed
    node->spinner.stop();
    ros::shutdown();
  });
  return node->handle;
}

std::string masterUri() {
  return ros::master::getURI();
}

std::vector<Topic> topics() {
  node();
  std::vector<ros::master::TopicInfo> known;
  ros::master::getTopics(known);
  std::vector<Topic> topics;
  for (const ros::master::TopicInfo& topic : known) topics.push_back({topic.name, topic.datatype});
  std::sort(topics.begin(), topics.end(), [](const Topic& a, const Topic& b) { return a.name < b.name; });
  return topics;
}

Subscription subscribeDepth(const std::string& topic, std::function<void(DepthImage, double stamp_s)> take,
                            Refuse refuse) {
  return subscribe<sensor_msgs::Image>(
      topic, [take = std::move(take), refuse = std::move(refuse)](const sensor_msgs::Image& image) {
        try {
          take(depthOf(image), image.header.stamp.toSec());
        } catch (const std::invalid_argument& error) {
          refuse(error.what());
        }
      });
}

Subscription subscribeCamera(const std::string& topic, std::function<void(const PinholeCamera&)> take,
                             Refuse refuse) {
  return subscribe<sensor_msgs::CameraInfo>(
      topic, [take = std::move(take), refuse = std::move(refuse)](const sensor_msgs::CameraInfo& info) {
        try {
          take(cameraOf(info));
        } catch (const std::invalid_argument& error) {
          refuse(error.what());
        }
      });
}

Subscription subscribeJoints(const std::string& topic, std::function<void(const Joints&)> take) {
  return subscribe<sensor_msgs::JointState>(topic,
                                            [take = std::move(take)](const sensor_msgs::JointState& state) {
                                              take({state.header.stamp.toSec(), state.name, state.position});
                                            });
}

}  // namespace vantage::ros_topics
