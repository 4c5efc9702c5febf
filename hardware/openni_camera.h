#pragma once

#include <memory>
#include <string>

#include "core/exploration/ports.h"
#include "hardware/device_list.h"

namespace vantage {

/// Depth camera behind OpenNI2, or a recording of one (`.oni`). Its calibration is what the driver tells:
/// size and fields of view, the principal point in the middle.
class OpenNiCamera : public DepthCamera {
 public:
  /// \param uri device as `vantage devices` lists it, or path of an `.oni` file \param range_m nearest and
  /// farthest range, metres; beyond what the driver tells, the driver's holds \param patience_s seconds until
  /// a camera that sends nothing counts as lost. \throws InputError if there is no such device, or it has no
  /// depth in millimetres or tenths of them
  OpenNiCamera(const std::string& uri, const Eigen::Vector2d& range_m, double patience_s = 2.0);
  ~OpenNiCamera() override;

  const PinholeCamera& model() const override;
  /// Of a live camera an image that was taken after the call. Of a recording every image, one after the
  /// other, then none. \throws DeviceLost
  std::optional<DepthFrame> capture(const Pose& T_world_camera, std::uint64_t index) override;
  /// What keeps images from coming, empty if they come.
  std::string trouble() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Cameras that OpenNI2 finds.
DeviceKind openNiDevices();

}  // namespace vantage
