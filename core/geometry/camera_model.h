#pragma once

#include <Eigen/Core>

namespace vantage {

/// Pinhole depth camera without distortion. Pixel (u, v): u right, v down, integer coordinates at pixel
/// centres. The defaults are those of the contour planner (Kinect V2; 70.1 x 60.3 deg).
struct PinholeCamera {
  int width = 512;           ///< pixels, 1..8192
  int height = 424;          ///< pixels, 1..8192
  double fx = 365.0;         ///< focal length, pixels, > 0
  double fy = 365.0;         ///< focal length, pixels, > 0
  double cx = 255.5;         ///< principal point, pixels
  double cy = 211.5;         ///< principal point, pixels
  double min_range_m = 0.5;  ///< nearest measurable range, metres, >= 0
  double max_range_m = 8.0;  ///< farthest measurable range, metres, > min_range_m

  /// Direction through pixel (u, v) in the camera frame with z = 1; not a unit vector.
  Eigen::Vector3d ray(double u, double v) const { return {(u - cx) / fx, (v - cy) / fy, 1.0}; }

  /// Pixel coordinates of a point in the camera frame with z > 0.
  Eigen::Vector2d project(const Eigen::Vector3d& p_camera) const {
    return {fx * p_camera.x() / p_camera.z() + cx, fy * p_camera.y() / p_camera.z() + cy};
  }

  /// The same field of view at 1/`factor` of the resolution per axis, pixel centres kept in the middle of the
  /// blocks they stand for. Width and height round up, 512x424 at factor 4 gives 128x106.
  PinholeCamera reduced(int factor) const;

  double horizontalFov_rad() const;  ///< full angle, radians
  double verticalFov_rad() const;    ///< full angle, radians

  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// Camera with centred principal point and square pixels from the full horizontal aperture, radians in (0,
/// pi).
PinholeCamera cameraFromFov(int width, int height, double horizontal_fov_rad);

}  // namespace vantage
