#include "core/geometry/camera_model.h"

#include <cmath>
#include <numbers>

#include "core/geometry/check.h"

namespace vantage {

PinholeCamera PinholeCamera::reduced(int factor) const {
  requireInRange("reduction factor", factor, 1, 64);
  PinholeCamera small = *this;
  small.width = (width + factor - 1) / factor;
  small.height = (height + factor - 1) / factor;
  small.fx = fx / factor;
  small.fy = fy / factor;
  small.cx = (cx + 0.5) / factor - 0.5;
  small.cy = (cy + 0.5) / factor - 0.5;
  return small;
}

double PinholeCamera::horizontalFov_rad() const {
  return std::atan((cx + 0.5) / fx) + std::atan((width - 0.5 - cx) / fx);
}

double PinholeCamera::verticalFov_rad() const {
  return std::atan((cy + 0.5) / fy) + std::atan((height - 0.5 - cy) / fy);
}

void PinholeCamera::validate() const {
  requireInRange("camera.width", width, 1, 8192);
  requireInRange("camera.height", height, 1, 8192);
  requireInRange("camera.fx", fx, 1e-3, 1e6);
  requireInRange("camera.fy", fy, 1e-3, 1e6);
  requireInRange("camera.cx", cx, -1e6, 1e6);
  requireInRange("camera.cy", cy, -1e6, 1e6);
  requireInRange("camera.min_range_m", min_range_m, 0.0, 1e3);
  requireInRange("camera.max_range_m", max_range_m, min_range_m + 1e-6, 1e4);
}

PinholeCamera cameraFromFov(int width, int height, double horizontal_fov_rad) {
  requireInRange("horizontal field of view (rad)", horizontal_fov_rad, 1e-3, std::numbers::pi - 1e-3);
  PinholeCamera camera;
  camera.width = width;
  camera.height = height;
  camera.cx = (width - 1) / 2.0;
  camera.cy = (height - 1) / 2.0;
  camera.fx = camera.fy = width / 2.0 / std::tan(horizontal_fov_rad / 2.0);
  camera.validate();
  return camera;
}

}  // namespace vantage
