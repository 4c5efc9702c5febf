#pragma once

#include <memory>
#include <string>

#include "hardware/device_list.h"
#include "hardware/live_camera.h"

namespace vantage {

/// Depth camera behind OpenNI2, or a recording of one (`.oni`). Its calibration is what the driver tells:
/// size and fields of view, the principal point in the middle. A live camera gives images that were taken
/// after the call, a recording every image, one after the other, then none. \param uri device as `vantage
/// devices` lists it, or path of an `.oni` file \param range_m nearest and farthest range, metres; where the
/// driver tells narrower ones, those hold \param patience_s seconds until a camera that sends nothing counts
/// as lost. \throws InputError if there is no such device, or it has no depth in millimetres or tenths of
/// them
std::unique_ptr<LiveCamera> openOpenNiCamera(const std::string& uri, const Eigen::Vector2d& range_m,
                                             double patience_s = 2.0);

/// Cameras that OpenNI2 finds.
DeviceKind openNiDevices();

}  // namespace vantage
