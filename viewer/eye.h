#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "core/geometry/camera_model.h"
#include "core/geometry/pose.h"
#include "viewer/view_settings.h"

namespace vantage {

/// Eye of a view for points that must all be seen, in a picture of the given shape. \throws
/// std::invalid_argument for a view out of range or no points.
Eye fitEye(const CameraView& view, std::span<const Eigen::Vector3d> points, double width_to_height);

/// What a camera at a pose sees: its eye with its roll and vertical aperture, focused at `focus_m`. A camera
/// whose principal point is not in the middle is shown as if it were.
Eye eyeOfView(const PinholeCamera& camera, const Pose& T_world_camera, double focus_m = 1.0);

/// Apex and the corners of the image at `depth_m`, in the order left-top, right-top, right-bottom,
/// left-bottom.
struct FrustumCorners {
  Eigen::Vector3d apex;
  std::array<Eigen::Vector3d, 4> image;
};
FrustumCorners frustumCorners(const PinholeCamera& camera, const Pose& T_world_camera, double depth_m);

/// A picture's size in pixels.
struct PictureSize {
  int width = 1, height = 1;
  double shape() const { return static_cast<double>(width) / height; }
};

/// Straight line from the eye through a point of the picture, pixels from its top left corner.
struct EyeRay {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  ///< unit length
};
EyeRay eyeRay(const Eye& eye, const Eigen::Vector2d& at_px, const PictureSize& picture);

/// Where a world point appears, pixels from the top left; nothing for a point behind the eye.
std::optional<Eigen::Vector2d> pixelOf(const Eye& eye, const Eigen::Vector3d& p_world,
                                       const PictureSize& picture);

// What the mouse does to an eye. z stays up: an eye that was rolled is put upright.

/// Turns about the focus; the elevation stays short of straight up and down. \param left_rad about z,
/// \param up_rad toward the zenith
Eye orbited(const Eye& eye, double left_rad, double up_rad);
/// Moves eye and focus so that what is at the focus' depth follows a drag by these pixels (y down).
Eye panned(const Eye& eye, const Eigen::Vector2d& drag_px, const PictureSize& picture);
/// Comes nearer by a factor above 1; what is at the focus' depth under the cursor stays under it. The
/// distance stays within 1 cm and 1 km.
Eye zoomed(const Eye& eye, double factor, const Eigen::Vector2d& at_px, const PictureSize& picture);

}  // namespace vantage
