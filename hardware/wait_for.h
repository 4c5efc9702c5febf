#pragma once

#include <chrono>
#include <thread>

namespace vantage {

/// Waits until something is there, looking every 10 ms; false if it did not come in time.
template <class IsThere>
bool waitFor(double seconds, const IsThere& is_there) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (!is_there()) {
    if (Clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

}  // namespace vantage
