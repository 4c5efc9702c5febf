#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/depth_image.h"

// What goes over the topics of ROS 1, in types of our own. ROS 1's headers do not compile as C++20: the files
// behind this header are C++17, and so this one has to be both.

namespace vantage::ros_topics {

/// Why this program can't be a node of ROS, e.g. because no master answers at ROS_MASTER_URI; empty if it
/// can.
std::string whyNoNode();

struct Topic {
  std::string name, type;
};
/// What the master knows, by name. \throws std::runtime_error if whyNoNode()
std::vector<Topic> topics();
std::string masterUri();

/// Ends when the last copy goes; no call comes after that.
using Subscription = std::shared_ptr<void>;
using Refuse = std::function<void(const std::string& why)>;

/// Calls come from one thread, which all subscriptions share. Images as depthOf() of them; what it refuses
/// goes to `refuse`. \throws std::runtime_error if whyNoNode(), or for a name that is no topic's
Subscription subscribeDepth(const std::string& topic, std::function<void(DepthImage, double stamp_s)> take,
                            Refuse refuse);

/// Size and camera matrix K of each calibration; the distortion is left out, and the range is none of ROS's.
Subscription subscribeCamera(const std::string& topic, std::function<void(const PinholeCamera&)> take,
                             Refuse refuse);

struct Joints {
  double stamp_s = 0.0;
  std::vector<std::string> names;
  std::vector<double> positions;  ///< rad or m; not always as many as names
};
Subscription subscribeJoints(const std::string& topic, std::function<void(const Joints&)> take);

/// Sends motions to a controller (action control_msgs/FollowJointTrajectory). One motion at a time.
class TrajectoryClient {
 public:
  struct Point {
    double time_s = 0.0;
    std::vector<double> positions, velocities;
  };
  enum class State { Moving, Succeeded, Failed };

  /// \param action name of the action, e.g. "/arm_controller/follow_joint_trajectory" \throws as
  /// subscribeDepth()
  explicit TrajectoryClient(const std::string& action);
  /// Ends a motion that has not ended.
  ~TrajectoryClient();

  bool connected() const;
  void send(const std::vector<std::string>& joints, const std::vector<Point>& points);
  State state();
  /// Of a motion that failed, what the controller said.
  std::string failure();
  /// Asks the controller to end the motion and waits for its answer, at most that long.
  void cancel(double wait_s);

 private:
  struct Client;
  std::unique_ptr<Client> client_;
};

}  // namespace vantage::ros_topics
