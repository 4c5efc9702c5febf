#pragma once

#include <numbers>

#include "core/raycasting/hierarchical_caster.h"

namespace vantage::testing {

/// Toy sensor of section 10.1: 60 x 45 deg, 1 m, for voxels of 5 cm.
inline RaySensor toySensor() {
  RaySensor sensor;
  sensor.horizontal_fov_rad = std::numbers::pi / 3;
  sensor.vertical_fov_rad = std::numbers::pi / 4;
  sensor.min_range_m = 0.0;
  sensor.max_range_m = 1.0;
  return sensor;
}

inline constexpr double kToyVoxel = 0.05;

/// Where the toy sensor stands; it looks along +z of the world.
inline Pose toyPose() {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(0.001, 0.0007, 0.0003);
  return pose;
}

/// Toy map of section 10.4, 32^3 voxels on [-0.8,0.8]^2 x [0,1.6], labelled by voxel centre.
template <class Label>
StatePyramid toyPyramid(Label label, int coarse_levels) {
  GridGeometry g;
  g.voxel_size_m = kToyVoxel;
  g.size = Eigen::Vector3i::Constant(32);
  g.origin_m = Eigen::Vector3d(-0.8, -0.8, 0.0) + Eigen::Vector3d::Constant(kToyVoxel / 2);
  StateGrid grid(g);
  for (std::size_t i = 0; i < g.count(); ++i) grid.set(g.voxel(i), label(g.center(g.voxel(i))));
  grid.rebuildFreeRadius();
  return StatePyramid(std::move(grid), firstVoxelOf(g), coarse_levels);
}

/// The five scenes of the toy table, in its order.
inline VoxelState toyLabel(int scene, const Eigen::Vector3d& p) {
  using enum VoxelState;
  const bool wall = p.z() > 0.5;
  const bool ball = (p - Eigen::Vector3d(0, 0, 0.6)).norm() <= 0.15;
  if (scene == 0) return wall ? Unknown : Free;
  if (scene == 1) return wall ? Occupied : Free;
  if (scene == 2) return ball ? Occupied : Free;
  if (scene == 3) return !wall ? Free : p.x() < 0 ? Occupied : Unknown;
  if (ball) return Occupied;
  return p.z() > 0.6 && p.head<2>().norm() < 0.3 ? Unknown : Free;
}

}  // namespace vantage::testing
