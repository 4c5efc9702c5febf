#include "hardware/frame_inbox.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/exploration/ports.h"

namespace vantage {

FrameInbox::FrameInbox(std::string device, double patience_s)
    : device_(std::move(device)),
      patience_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(patience_s))),
      counted_at_(Clock::now()) {
  if (!(patience_s > 0.0)) throw std::invalid_argument("FrameInbox: patience_s must be above 0");
}

void FrameInbox::put(DepthImage depth, double stamp_s) {
  const std::lock_guard lock(mutex_);
  if (!last_.empty() && (depth.width != last_.width || depth.height != last_.height)) {
    reason_ = fmt::format("its images are {}x{} now, and were {}x{}", depth.width, depth.height, last_.width,
                          last_.height);
  } else if (!std::isfinite(stamp_s) || (stamp_s_ && !(stamp_s > *stamp_s_))) {
    reason_ =
        fmt::format("the time stamps of its images stand still at {:.6f} s", stamp_s_.value_or(stamp_s));
  } else {
    last_ = std::move(depth);
    stamp_s_ = stamp_s;
    counted_at_ = Clock::now();
    reason_.clear();
    ++count_;
  }
  arrived_.notify_all();
}

void FrameInbox::refuse(std::string reason) {
  const std::lock_guard lock(mutex_);
  reason_ = std::move(reason);
}

DepthImage FrameInbox::next() {
  std::unique_lock lock(mutex_);
  const auto asked_at = Clock::now();
  const std::uint64_t wanted = count_ + 2;
  while (count_ < wanted) {
    const auto since = std::max(asked_at, counted_at_);
    if (arrived_.wait_until(lock, since + patience_) == std::cv_status::no_timeout) continue;
    if (Clock::now() < std::max(asked_at, counted_at_) + patience_) continue;
    throw DeviceLost(troubleSince(since));
  }
  return last_;
}

std::string FrameInbox::trouble() const {
  const std::lock_guard lock(mutex_);
  return Clock::now() - counted_at_ > patience_ ? troubleSince(counted_at_) : std::string();
}

std::string FrameInbox::troubleSince(Clock::time_point since) const {
  const double silent_s = std::chrono::duration<double>(Clock::now() - since).count();
  if (!reason_.empty()) return fmt::format("{}: {}", device_, reason_);
  return fmt::format("{}: no image for {:.1f} s; is it connected, and does it stream?", device_, silent_s);
}

}  // namespace vantage
