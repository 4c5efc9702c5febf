#include <fmt/format.h>

#include <mutex>
#include <optional>

#include "hardware/frame_inbox.h"
#include "hardware/ros_bridge.h"
#include "hardware/ros_topics.h"
#include "hardware/wait_for.h"
#include "io/error.h"

namespace vantage {
namespace {

constexpr double kOpening_s = 5.0;  // publishers have to find us first

/// "camera_info" in the namespace of the images.
std::string infoTopic(const std::string& topic) {
  const std::size_t slash = topic.rfind('/');
  return (slash == std::string::npos ? "" : topic.substr(0, slash + 1)) + "camera_info";
}

class RosCamera : public LiveCamera {
 public:
  RosCamera(const std::string& topic, double patience_s) : inbox("camera ros:" + topic, patience_s) {
    const auto refuse = [this](const std::string& why) { inbox.refuse(why); };
    calibrations = ros_topics::subscribeCamera(
        infoTopic(topic), [this](const PinholeCamera& found) { calibrate(found); }, refuse);
    images = ros_topics::subscribeDepth(
        topic, [this](DepthImage depth, double stamp_s) { inbox.put(std::move(depth), stamp_s); }, refuse);
  }

  const PinholeCamera& model() const override { return camera; }
  std::optional<DepthFrame> capture(const Pose& T_world_camera, std::uint64_t) override {
    return DepthFrame{inbox.next(), T_world_camera};
  }
  std::string trouble() const override { return inbox.trouble(); }

  /// Waits for a calibration and an image that fits it.
  void open(const std::string& topic, const Eigen::Vector2d& range_m) {
    if (!waitFor(kOpening_s, [&] { return calibrated(); }))
      throw std::runtime_error(
          fmt::format("no calibration came on {} for {:g} s; see 'vantage devices' for what is there",
                      infoTopic(topic), kOpening_s));
    const DepthImage first = inbox.next();
    camera = *calibration;
    camera.min_range_m = range_m[0];
    camera.max_range_m = range_m[1];
    camera.validate();
    if (first.width != camera.width || first.height != camera.height)
      throw std::runtime_error(fmt::format("its images are {}x{}, and its calibration is of {}x{}",
                                           first.width, first.height, camera.width, camera.height));
  }

 private:
  void calibrate(const PinholeCamera& found) {
    const std::lock_guard lock(mutex);
    if (!calibration) calibration = found;
  }
  bool calibrated() {
    const std::lock_guard lock(mutex);
    return calibration.has_value();
  }

  FrameInbox inbox;
  PinholeCamera camera;
  std::mutex mutex;
  std::optional<PinholeCamera> calibration;
  ros_topics::Subscription images, calibrations;  // last: no call comes after them
};

}  // namespace

std::unique_ptr<LiveCamera> openRosCamera(const std::string& topic, const Eigen::Vector2d& range_m,
                                          double patience_s) {
  try {
    auto camera = std::make_unique<RosCamera>(topic, patience_s);
    camera->open(topic, range_m);
    return camera;
  } catch (const std::exception& error) {
    throw InputError("ros:" + topic, error.what());
  }
}

}  // namespace vantage
