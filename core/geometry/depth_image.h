#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace vantage {

/// Depth along the optical axis (z of the camera frame), metres, row-major. Invalid pixels are NaN.
struct DepthImage {
  static constexpr float kInvalid = std::numeric_limits<float>::quiet_NaN();

  int width = 0;
  int height = 0;
  std::vector<float> depth_m;  ///< width * height values

  DepthImage() = default;
  /// An image of invalid pixels.
  DepthImage(int width_, int height_)
      : width(width_), height(height_), depth_m(static_cast<std::size_t>(width_) * height_, kInvalid) {}

  float& at(int u, int v) { return depth_m[static_cast<std::size_t>(v) * width + u]; }
  float at(int u, int v) const { return depth_m[static_cast<std::size_t>(v) * width + u]; }
  static bool valid(float depth) { return std::isfinite(depth) && depth > 0.0f; }
  bool empty() const { return depth_m.empty(); }
};

}  // namespace vantage
