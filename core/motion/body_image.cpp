#include "core/motion/body_image.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace vantage {
namespace {

using Eigen::Vector3d;

/// A ray in the frame of a shape; distances in multiples of the direction.
struct Ray {
  Vector3d origin, direction;
};

/// Distances at which a ray enters and leaves something convex; empty if enter > leave.
struct Span {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  bool empty() const { return !(enter <= leave); }
};

Span common(const Span& a, const Span& b) {
  return {std::max(a.enter, b.enter), std::min(a.leave, b.leave)};
}

constexpr Span kMiss = {1.0, 0.0};

/// Between two planes perpendicular to an axis, at +-half.
Span slab(double origin, double direction, double half) {
  if (direction == 0.0) return std::abs(origin) <= half ? Span{} : kMiss;
  const double a = (-half - origin) / direction, b = (half - origin) / direction;
  return {std::min(a, b), std::max(a, b)};
}

/// Where a t^2 + 2 b t + c <= 0.
Span roots(double a, double b, double c) {
  if (a == 0.0) return c <= 0.0 ? Span{} : kMiss;
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return kMiss;
  const double root = std::sqrt(discriminant);
  return {(-b - root) / a, (-b + root) / a};
}

Span sphere(const Ray& ray, const Vector3d& center, double radius) {
  const Vector3d o = ray.origin - center;
  return roots(ray.direction.squaredNorm(), o.dot(ray.direction), o.squaredNorm() - radius * radius);
}

Span tube(const Ray& ray, double radius, double half_length) {
  const auto o = ray.origin.head<2>(), d = ray.direction.head<2>();
  const Span round = roots(d.squaredNorm(), o.dot(d), o.squaredNorm() - radius * radius);
  return common(round, slab(ray.origin.z(), ray.direction.z(), half_length));
}

Span hull(const Span& a, const Span& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.enter, b.enter), std::max(a.leave, b.leave)};
}

Span within(const LinkShape& shape, double margin, const Ray& ray) {
  const double radius = shape.radius_m + margin, half = shape.length_m / 2;
  switch (shape.kind) {
    case ShapeKind::Cuboid: {
      Span span;
      for (int axis = 0; axis < 3; ++axis)
        span = common(span, slab(ray.origin[axis], ray.direction[axis], shape.size_m[axis] / 2 + margin));
      return span;
    }
    case ShapeKind::Cylinder:
      return tube(ray, radius, half + margin);
    case ShapeKind::Sphere:
      return sphere(ray, Vector3d::Zero(), radius);
    case ShapeKind::Capsule:
      return hull(hull(tube(ray, radius, half), sphere(ray, {0, 0, half}, radius)),
                  sphere(ray, {0, 0, -half}, radius));
  }
  return kMiss;
}

/// Columns and rows that may see a ball before the camera; empty if none.
struct PixelBox {
  int left = 0, top = 0, right = -1, bottom = -1;
};

PixelBox pixelsOf(const Vector3d& center_camera, double radius, const PinholeCamera& camera) {
  if (center_camera.z() + radius <= 0.0) return {};
  const double nearest = center_camera.z() - radius;
  if (nearest <= 1e-6) return {0, 0, camera.width - 1, camera.height - 1};
  // The ball's box, whose nearest face has the widest view.
  PixelBox box;
  const auto range = [&](double c, double f, double middle, int size, int& low, int& high) {
    const double farther = center_camera.z() + radius;
    const double a = c - radius, b = c + radius;
    low = std::max(0, static_cast<int>(std::floor(std::min(a / nearest, a / farther) * f + middle)));
    high = std::min(size - 1, static_cast<int>(std::ceil(std::max(b / nearest, b / farther) * f + middle)));
  };
  range(center_camera.x(), camera.fx, camera.cx, camera.width, box.left, box.right);
  range(center_camera.y(), camera.fy, camera.cy, camera.height, box.top, box.bottom);
  return box;
}

void draw(const LinkShape& shape, const Pose& T_shape_camera, double margin_m, const PinholeCamera& camera,
          DepthImage& image) {
  const Span at_camera = within(shape, margin_m, {T_shape_camera.translation(), Vector3d::Zero()});
  const bool holds_camera = !at_camera.empty();
  if (holds_camera) return;
  const Vector3d center = T_shape_camera.inverse().translation();
  const double radius = std::hypot(shape.size_m.norm() / 2, shape.radius_m + shape.length_m / 2) +
                        2.0 * margin_m + shape.radius_m;
  const PixelBox box = pixelsOf(center, radius, camera);
  tbb::parallel_for(box.top, box.bottom + 1, [&](int v) {
    for (int u = box.left; u <= box.right; ++u) {
      const Ray ray{T_shape_camera.translation(), T_shape_camera.linear() * camera.ray(u, v)};
      const Span span = within(shape, margin_m, ray);
      if (span.empty() || span.enter <= 0.0) continue;
      float& depth = image.at(u, v);
      const auto found = static_cast<float>(span.enter);  // the ray has z = 1: distance is depth
      if (!(depth <= found)) depth = found;
    }
  });
}

}  // namespace

DepthImage bodyImage(const RobotModel& model, const JointVector& q, const PinholeCamera& camera,
                     double margin_m, const Pose& camera_error) {
  DepthImage image(camera.width, camera.height);
  const ArmFrames frames = forwardKinematics(model, q);
  const Pose T_base_camera = frames.T_base_camera * camera_error;
  for (const LinkShape& shape : model.shapes)
    draw(shape, (frames.of(shape.frame) * shape.T_frame_shape).inverse() * T_base_camera, margin_m, camera,
         image);
  return image;
}

void removeBody(DepthImage& depth, const DepthImage& body) {
  if (depth.width != body.width || depth.height != body.height)
    throw std::invalid_argument("removeBody: images of different sizes");
  for (std::size_t i = 0; i < depth.depth_m.size(); ++i)
    if (!(depth.depth_m[i] < body.depth_m[i]) && std::isfinite(body.depth_m[i]))
      depth.depth_m[i] = DepthImage::kInvalid;
}

}  // namespace vantage
