#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/depth_image.h"

namespace vantage::test {

/// The other side of a ROS adapter: publishes images and joints, and takes motions. C++17, as the headers of
/// ROS 1.
class RosServer {
 public:
  /// \param space namespace of all topics: SPACE/camera/image_raw, SPACE/camera/camera_info,
  /// SPACE/joint_states, SPACE/follow_joint_trajectory
  explicit RosServer(const std::string& space);
  ~RosServer();

  struct Goal {
    std::vector<std::string> joints;
    std::vector<double> time_s;
    std::vector<std::vector<double>> positions;  ///< one row per time
  };

  bool ok() const;
  /// Answers what came in.
  void spinOnce();
  std::optional<Goal> newGoal();
  bool stopWanted() const;
  void succeed();
  void stopped();
  void abort(const std::string& why);

  void publishJoints(double stamp_s, const std::vector<std::string>& names,
                     const std::vector<double>& positions);
  /// \param encoding "16UC1", "32FC1", or another that no depth camera has
  void publishDepth(double stamp_s, const DepthImage& depth, const PinholeCamera& camera,
                    const std::string& encoding);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage::test
