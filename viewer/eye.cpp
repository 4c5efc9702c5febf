#include "viewer/eye.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/geometry/grid_geometry.h"

namespace vantage {
namespace {

/// Direction from the focus to the eye.
Eigen::Vector3d towardEye(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad), std::cos(elevation_rad) * std::sin(azimuth_rad),
          std::sin(elevation_rad)};
}

/// Directions of the picture in the world.
struct PictureAxes {
  Eigen::Vector3d right, up, forward;
};

PictureAxes axesOf(const Eye& eye) {
  PictureAxes axes;
  axes.forward = (eye.focus - eye.position).normalized();
  axes.right = axes.forward.cross(eye.up);
  if (axes.right.norm() < 1e-9) axes.right = axes.forward.unitOrthogonal();
  axes.right.normalize();
  axes.up = axes.right.cross(axes.forward);
  return axes;
}

/// Metres at the focus' depth that one pixel covers.
double metresPerPixel(const Eye& eye, const PictureSize& picture) {
  return 2.0 * eye.distance() * std::tan(eye.fov_rad / 2) / picture.height;
}

/// From the picture's middle to a pixel, at the focus' depth: world, metres.
Eigen::Vector3d fromMiddle(const Eye& eye, const Eigen::Vector2d& at_px, const PictureSize& picture) {
  const PictureAxes axes = axesOf(eye);
  const double scale = metresPerPixel(eye, picture);
  return scale *
         ((at_px.x() - picture.width / 2.0) * axes.right - (at_px.y() - picture.height / 2.0) * axes.up);
}

}  // namespace

Eye fitEye(const CameraView& view, std::span<const Eigen::Vector3d> points, double width_to_height) {
  view.validate();
  if (points.empty()) throw std::invalid_argument("fitEye: there is nothing to be seen");
  Box box;
  for (const Eigen::Vector3d& p : points) box.extend(p);
  const Eigen::Vector3d back = towardEye(view.azimuth_rad, view.elevation_rad);
  const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(back).normalized(), up = back.cross(right);
  const double tan_v = std::tan(view.fov_rad / 2), tan_h = tan_v * width_to_height;
  Eigen::Vector3d focus = box.center();
  double distance = std::max(1e-3, box.diagonal().norm()) / tan_v;
  for (int round = 0; round < 40; ++round) {
    double left = 1e9, rightmost = -1e9, bottom = 1e9, top = -1e9;
    for (const Eigen::Vector3d& point : points) {
      const Eigen::Vector3d p = point - focus;
      const double depth = distance - p.dot(back);
      const double x = p.dot(right) / depth / tan_h, y = p.dot(up) / depth / tan_v;
      left = std::min(left, x), rightmost = std::max(rightmost, x);
      bottom = std::min(bottom, y), top = std::max(top, y);
    }
    focus +=
        right * ((left + rightmost) / 2 * distance * tan_h) + up * ((bottom + top) / 2 * distance * tan_v);
    distance *= std::clamp(std::max(rightmost - left, top - bottom) / 2, 0.5, 2.0);
  }
  constexpr double kMargin = 1.02;  // nothing touches the edge
  return {focus + back * (kMargin * distance / view.zoom), focus, Eigen::Vector3d::UnitZ(), view.fov_rad};
}

Eye eyeOfView(const PinholeCamera& camera, const Pose& T_world_camera, double focus_m) {
  return {T_world_camera.translation(), T_world_camera * Eigen::Vector3d(0.0, 0.0, focus_m),
          -T_world_camera.linear().col(1), camera.verticalFov_rad()};
}

FrustumCorners frustumCorners(const PinholeCamera& camera, const Pose& T_world_camera, double depth_m) {
  const double left = -0.5, top = -0.5, right = camera.width - 0.5, bottom = camera.height - 0.5;
  FrustumCorners corners;
  corners.apex = T_world_camera.translation();
  corners.image = {T_world_camera * (depth_m * camera.ray(left, top)),
                   T_world_camera * (depth_m * camera.ray(right, top)),
                   T_world_camera * (depth_m * camera.ray(right, bottom)),
                   T_world_camera * (depth_m * camera.ray(left, bottom))};
  return corners;
}

EyeRay eyeRay(const Eye& eye, const Eigen::Vector2d& at_px, const PictureSize& picture) {
  return {eye.position, (eye.focus - eye.position + fromMiddle(eye, at_px, picture)).normalized()};
}

std::optional<Eigen::Vector2d> pixelOf(const Eye& eye, const Eigen::Vector3d& p_world,
                                       const PictureSize& picture) {
  const PictureAxes axes = axesOf(eye);
  const Eigen::Vector3d p = p_world - eye.position;
  const double depth = p.dot(axes.forward);
  if (depth <= 1e-9) return std::nullopt;
  const double pixels = picture.height / (2.0 * std::tan(eye.fov_rad / 2) * depth);
  return Eigen::Vector2d(picture.width / 2.0 + pixels * p.dot(axes.right),
                         picture.height / 2.0 - pixels * p.dot(axes.up));
}

Eye orbited(const Eye& eye, double left_rad, double up_rad) {
  constexpr double kSteepest_rad = 1.55;  // straight down there is no "up" in the picture
  const Eigen::Vector3d back = (eye.position - eye.focus).normalized();
  const double azimuth = std::atan2(back.y(), back.x()),
               elevation = std::asin(std::clamp(back.z(), -1.0, 1.0));
  Eye turned = eye;
  turned.up = Eigen::Vector3d::UnitZ();
  turned.position =
      eye.focus + eye.distance() * towardEye(azimuth + left_rad,
                                             std::clamp(elevation + up_rad, -kSteepest_rad, kSteepest_rad));
  return turned;
}

Eye panned(const Eye& eye, const Eigen::Vector2d& drag_px, const PictureSize& picture) {
  const Eigen::Vector2d middle(picture.width / 2.0, picture.height / 2.0);
  const Eigen::Vector3d shift = -fromMiddle(eye, middle + drag_px, picture);
  Eye moved = eye;
  moved.position += shift;
  moved.focus += shift;
  return moved;
}

Eye zoomed(const Eye& eye, double factor, const Eigen::Vector2d& at_px, const PictureSize& picture) {
  constexpr double kNearest_m = 0.01, kFarthest_m = 1000.0;
  const double distance = std::clamp(eye.distance() / factor, kNearest_m, kFarthest_m);
  const double kept = distance / eye.distance();
  Eye nearer = eye;
  nearer.focus += (1.0 - kept) * fromMiddle(eye, at_px, picture);
  nearer.position = nearer.focus + kept * (eye.position - eye.focus);
  return nearer;
}

}  // namespace vantage
