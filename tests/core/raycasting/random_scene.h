#pragma once

#include <cstdint>
#include <random>

#include "core/raycasting/ray_tree.h"
#include "core/raycasting/uniform_caster.h"
#include "core/volume/state_grid.h"

namespace vantage::testing {

/// Mostly free grid with boxes of unknown and occupied space and a sprinkle of single voxels.
inline StateGrid randomGrid(std::mt19937_64& random, const Eigen::Vector3i& size, double voxel_m) {
  GridGeometry g;
  g.size = size;
  g.voxel_size_m = voxel_m;
  std::uniform_real_distribution<double> offset(-1.0, 1.0);
  g.origin_m = {offset(random), offset(random), offset(random)};
  StateGrid grid(g);
  const auto upTo = [&](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
  for (std::size_t i = 0; i < g.count(); ++i) grid.set(g.voxel(i), VoxelState::Free);
  for (int n = 0; n < 6; ++n) {
    const Eigen::Vector3i low(upTo(size.x()), upTo(size.y()), upTo(size.z()));
    const Eigen::Vector3i high = (low + Eigen::Vector3i(upTo(9), upTo(9), upTo(9))).cwiseMin(size);
    const auto state = n % 2 ? VoxelState::Unknown : VoxelState::Occupied;
    for (int k = low.z(); k < high.z(); ++k)
      for (int j = low.y(); j < high.y(); ++j)
        for (int i = low.x(); i < high.x(); ++i) grid.set({i, j, k}, state);
  }
  for (int n = 0; n < 20; ++n)
    grid.set({upTo(size.x()), upTo(size.y()), upTo(size.z())},
             n % 3 ? VoxelState::Unknown : VoxelState::Occupied);
  grid.rebuildFreeRadius();
  return grid;
}

/// Pose near or in a box: two of three look at the box, the others anywhere.
inline Pose randomPose(std::mt19937_64& random, const Box& around) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&] { return Eigen::Vector3d(unit(random), unit(random), unit(random)); };
  const Eigen::Vector3d eye = around.center() + vector().cwiseProduct(around.sizes() * 0.7);
  const Eigen::Vector3d target = around.center() + vector().cwiseProduct(around.sizes() * 0.4);
  const bool anywhere = random() % 3 == 0;
  return lookAlong(eye, anywhere ? vector() : target - eye, 3.0 * unit(random));
}

/// Apertures from 23 deg on, with and without a minimum range, either anchor. \param shortest_m maximum range
inline RaySensor randomSensor(std::mt19937_64& random, double shortest_m) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  RaySensor sensor;
  sensor.horizontal_fov_rad = 0.5 + unit(random);
  sensor.vertical_fov_rad = 0.4 + unit(random);
  sensor.min_range_m = random() % 3 ? 0.2 * unit(random) : 0.0;
  sensor.max_range_m = shortest_m + 0.5 * unit(random);
  sensor.anchor = random() % 4 ? RayAnchor::Centered : RayAnchor::Literal;
  return sensor;
}

}  // namespace vantage::testing
