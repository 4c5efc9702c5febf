#pragma once

#include <string>

#include "core/exploration/ports.h"

namespace vantage {

/// Depth camera that sends images by itself, whether asked or not.
class LiveCamera : public DepthCamera {
 public:
  /// What keeps images from coming, empty if they come. Called while the robot moves.
  virtual std::string trouble() const = 0;
};

}  // namespace vantage
