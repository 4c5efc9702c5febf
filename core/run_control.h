#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <stop_token>
#include <string_view>

namespace vantage {

/// Thrown where long work notices that it is to stop. Maps and records stay consistent.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

/// Stop token and progress of long work; cheap to copy.
struct RunControl {
  std::stop_token stop;
  /// Called with the phase, items done and items in all (0 = not known), from the thread that runs the work.
  std::function<void(std::string_view phase, std::uint64_t done, std::uint64_t total)> progress;

  /// \throws Cancelled if a stop was requested.
  void check() const {
    if (stop.stop_requested()) throw Cancelled();
  }
  void report(std::string_view phase, std::uint64_t done, std::uint64_t total) const {
    if (progress) progress(phase, done, total);
  }
};

}  // namespace vantage
