#include "core/exploration/world_model.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace vantage {
namespace {

using Eigen::Vector3d;

/// A cube of 1 m about the origin, nothing known.
WorldConfig bothMaps() {
  WorldConfig config;
  config.keep_volume = config.keep_octree = true;
  config.volume = {Vector3d::Constant(-0.48), 0.04, Eigen::Vector3i::Constant(25)};
  config.fusion.truncation_m = 0.1;
  config.octree.voxel_size_m = 0.04;
  config.octree.outside = VoxelState::Unknown;
  config.object_box = Box(Vector3d::Constant(0.2), Vector3d::Constant(0.4));
  return config;
}

/// An image without a measurement.
DepthImage emptyImage(const PinholeCamera& camera) {
  DepthImage depth(camera.width, camera.height);
  std::ranges::fill(depth.depth_m, 0.0f);
  return depth;
}

TEST(WorldModel, TakesTheBubbleOfEachMapAsEmptyAlone) {
  const PinholeCamera camera;
  for (const bool in_volume : {true, false}) {
    WorldModel world(bothMaps());
    world.fuse(emptyImage(camera), Pose::Identity(), camera,
               in_volume ? SensorBubble{0.2, 0.0} : SensorBubble{0.0, 0.2});
    world.finishScan();
    const Box all(Vector3d::Constant(-1), Vector3d::Constant(1));
    EXPECT_EQ(world.surfaceStates()->count(VoxelState::Free, all) > 300, in_volume);
    EXPECT_EQ(world.pyramid()->finest().count(VoxelState::Free, all) > 300, !in_volume);
  }
}

TEST(WorldModel, WhatIsKnownFromElsewhereReachesTheNextScan) {
  WorldModel world(bothMaps());
  world.finishScan();
  const Box table(Vector3d(-0.4, -0.4, -0.4), Vector3d(0.4, 0.4, -0.3));
  world.occupyOctree(table, [](const Vector3d& p) { return p.x() < 0.0; });
  const MapChanges changes = world.finishScan();
  EXPECT_FALSE(changes.octree->empty());
  const StateGrid& states = world.pyramid()->finest();
  for (std::size_t n = 0; n < states.geometry().count(); ++n) {
    const Eigen::Vector3i v = states.geometry().voxel(n);
    const Vector3d p = states.geometry().center(v);
    EXPECT_EQ(states.at(v) == VoxelState::Occupied, table.contains(p) && p.x() < 0.0) << p.transpose();
  }
}

TEST(WorldModel, TheObjectsBoxIsNeverKnownFromElsewhere) {
  WorldModel world(bothMaps());
  world.occupyOctree(Box(Vector3d::Constant(0.1), Vector3d::Constant(0.45)),
                     [](const Vector3d&) { return true; });
  world.finishScan();
  const StateGrid& states = world.pyramid()->finest();
  EXPECT_EQ(states.count(VoxelState::Occupied, bothMaps().object_box), 0u);
  EXPECT_GT(states.count(VoxelState::Occupied, Box(Vector3d::Constant(0.1), Vector3d::Constant(0.45))), 100u);
}

}  // namespace
}  // namespace vantage
