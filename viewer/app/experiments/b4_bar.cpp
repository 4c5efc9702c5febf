#include "viewer/app/experiments/b4_bar.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/pose.h"
#include "core/perception/depth_filters.h"
#include "hardware/simulated_depth_camera.h"

namespace vantage::experiments {
namespace {

SceneFile sceneOf(const BarScene& s) {
  constexpr double kFar_m = 60.0;
  SceneFile scene;
  const auto add = [&](const Eigen::Vector3d& size_m, const Eigen::Vector3d& at_m, const char* name) {
    Pose pose = Pose::Identity();
    pose.translation() = at_m;
    scene.solids.emplace_back(makeBox(size_m), pose, SolidRole::Other, name, Solid::Color{});
  };
  add({s.width_m, s.depth_m > 0.0 ? s.depth_m : s.width_m, 1.0}, Eigen::Vector3d::Zero(), "bar");
  add({2 * kFar_m, 0.1, 2 * kFar_m}, {0.0, s.wall_m + 0.05, -kFar_m}, "wall");
  if (s.ground) add({2 * kFar_m, s.wall_m + kFar_m, 0.1}, {0.0, (s.wall_m - kFar_m) / 2, -0.1}, "ground");
  return scene;
}

/// Optical axis horizontal, through the bar's axis.
Pose poseOf(const BarScene& s) {
  const Eigen::Vector3d eye(-std::sin(s.angle_rad), -std::cos(s.angle_rad), 0.5);
  return lookAt(eye, {0.0, 0.0, 0.5});
}

DepthImage imageOf(const BarScene& s, const PinholeCamera& camera, bool emitter_shadow) {
  SimulatedCameraConfig config;
  config.camera = camera;
  config.sensor.noise_at_1m_m = 0.0;
  config.sensor.emitter_shadow = emitter_shadow;
  config.sensor.emitter_offset_m = s.emitter_offset_m;
  return SimulatedDepthCamera(sceneOf(s), config).capture(poseOf(s), 0)->depth;
}

}  // namespace

BarResult measureBar(const BarScene& s) {
  PinholeCamera camera;
  camera.min_range_m = 0.0;
  if (!s.range_limit) camera.max_range_m = 1000.0;
  const DepthImage all = imageOf(s, camera, false), lit = imageOf(s, camera, true);
  DepthFilterConfig config;
  config.shadow = true;
  config.emitter_offset_m = s.emitter_offset_m;
  const FilteredDepth filtered = filterDepth(all, camera, config);
  BarResult result;
  for (std::size_t i = 0; i < all.depth_m.size(); ++i) {
    if (!DepthImage::valid(all.depth_m[i])) continue;
    const bool is_lit = DepthImage::valid(lit.depth_m[i]), is_removed = filtered.mask[i] != 0;
    result.shadowed += !is_lit;
    result.removed += is_removed;
    result.removed_lit += is_removed && is_lit;
  }
  return result;
}

double plateFdr(double width_m, double z1_m, double z2_m, double emitter_offset_m) {
  return std::max(0.0, 1.0 - width_m * z2_m / (emitter_offset_m * (z2_m - z1_m)));
}

}  // namespace vantage::experiments
