#include <cmath>
#include <numbers>

#include "core/exploration/explorer.h"
#include "core/geometry/check.h"

namespace vantage {

void ScanConfig::validate() const {
  requireInRange("scan.initial_frames", initial_frames, 1, 10000);
  requireInRange("scan.initial_arc_m", initial_arc_m, 0.0, 100.0);
  requireInRange("scan.initial_distance_m", initial_distance_m, 0.01, 100.0);
  requireInRange("scan.initial_elevation", initial_elevation_rad, -1.57, 1.57);
  requireInRange("scan.clear_radius_m", clear_radius_m, 0.0, 10.0);
  requireInRange("scan.frames", frames, 1, 10000);
  requireInRange("scan.tilt", tilt_rad, 0.0, 1.57);
}

std::vector<Pose> initialScanPoses(const ScanConfig& config) {
  const double circle_radius_m = config.initial_distance_m * std::cos(config.initial_elevation_rad);
  const double swept_rad = config.initial_arc_m / circle_radius_m;
  std::vector<Pose> poses;
  for (int f = 0; f < config.initial_frames; ++f) {
    const double along = config.initial_frames > 1 ? f / (config.initial_frames - 1.0) - 0.5 : 0.0;
    const double azimuth = config.initial_azimuth_rad + along * swept_rad;
    const Eigen::Vector3d offset(circle_radius_m * std::cos(azimuth), circle_radius_m * std::sin(azimuth),
                                 config.initial_distance_m * std::sin(config.initial_elevation_rad));
    poses.push_back(lookAt(config.scene_center_m + offset, config.scene_center_m));
  }
  return poses;
}

std::vector<Pose> tiltedScanPoses(const Pose& T_world_camera, const ScanConfig& config) {
  std::vector<Pose> poses;
  for (int f = 0; f < config.frames; ++f) {
    const double tilt = config.tilt_rad * std::sin(2.0 * std::numbers::pi * f / config.frames);
    poses.push_back(T_world_camera * Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()));
  }
  return poses;
}

}  // namespace vantage
