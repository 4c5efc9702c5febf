#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/depth_image.h"
#include "core/geometry/grid_geometry.h"
#include "core/geometry/pose.h"

namespace vantage::test {

/// A table top and boxes, rendered without noise by intersecting each pixel's ray: ground truth for whole
/// pipelines.
struct AnalyticScene {
  std::optional<Box> table;  ///< the rectangle of its x and y, at height max().z()
  std::vector<Box> boxes;    ///< axis-aligned, metres

  /// Length factor along `direction` to the first surface, infinity if there is none.
  double hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    double nearest = std::numeric_limits<double>::infinity();
    if (table && direction.z() != 0.0) {
      const double t = (table->max().z() - origin.z()) / direction.z();
      const Eigen::Vector3d p = origin + t * direction;
      const bool on_it = (p.head<2>().array() >= table->min().head<2>().array()).all() &&
                         (p.head<2>().array() <= table->max().head<2>().array()).all();
      if (t > 0.0 && on_it) nearest = t;
    }
    for (const Box& box : boxes) {
      const Eigen::Array3d a = (box.min() - origin).array() / direction.array();
      const Eigen::Array3d b = (box.max() - origin).array() / direction.array();
      const double enter = a.min(b).maxCoeff(), leave = a.max(b).minCoeff();
      if (enter > 0.0 && enter <= leave) nearest = std::min(nearest, enter);
    }
    return nearest;
  }

  /// Ideal depth image; pixels that see nothing, or nothing within the camera's range, are invalid.
  DepthImage render(const PinholeCamera& camera, const Pose& T_world_camera) const {
    DepthImage image(camera.width, camera.height);
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u) {
        const double z = hit(T_world_camera.translation(), T_world_camera.linear() * camera.ray(u, v));
        if (z >= camera.min_range_m && z <= camera.max_range_m) image.at(u, v) = static_cast<float>(z);
      }
    return image;
  }
};

}  // namespace vantage::test
