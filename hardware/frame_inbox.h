#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>

#include "core/geometry/depth_image.h"

namespace vantage {

/// Where the driver of a live camera leaves its images and the exploration waits for them. An image counts if
/// it has the size of the first one and a later time stamp than all before; the others are remembered as what
/// is wrong with the camera. All functions may be called from any thread.
class FrameInbox {
 public:
  /// \param device name for messages \param patience_s seconds without an image that counts until the camera
  /// is lost, > 0
  FrameInbox(std::string device, double patience_s);

  /// An image arrived. \param stamp_s when it was taken, seconds on the device's own clock
  void put(DepthImage depth, double stamp_s);
  /// An image arrived that cannot be used, or the device reported that it is gone. Says why.
  void refuse(std::string reason);

  /// The image that counts after the next one: an image that arrives just now may have been taken before the
  /// call, the one behind it was not. \throws DeviceLost saying what came instead.
  DepthImage next();
  /// What keeps images from coming, empty while the last one that counts is no older than the patience.
  std::string trouble() const;

 private:
  using Clock = std::chrono::steady_clock;
  std::string troubleSince(Clock::time_point since) const;

  const std::string device_;
  const Clock::duration patience_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  DepthImage last_;
  std::optional<double> stamp_s_;
  std::uint64_t count_ = 0;  ///< images that counted
  Clock::time_point counted_at_;
  std::string reason_;  ///< why the images since then did not count
};

}  // namespace vantage
