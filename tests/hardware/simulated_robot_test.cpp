#include "hardware/simulated_robot.h"

#include <gtest/gtest.h>

#include "core/volume/state_grid.h"

namespace vantage {
namespace {

using Eigen::Vector3d;

/// 1.2 m of free space with an occupied wall across x = 0.6 m, open above z = 0.8 m.
StateGrid walledSpace() {
  StateGrid states(GridGeometry{{0.01, 0.01, 0.01}, 0.02, {60, 60, 60}});
  for (int k = 0; k < 60; ++k)
    for (int j = 0; j < 60; ++j)
      for (int i = 0; i < 60; ++i) {
        const bool wall = i >= 29 && i <= 30 && k < 40;
        states.set({i, j, k}, wall ? VoxelState::Occupied : VoxelState::Free);
      }
  states.rebuildFreeRadius();
  return states;
}

FreeFlyerConfig anywhere() {
  FreeFlyerConfig config;
  config.reach_m = 0.0;
  config.speed_m_per_s = 0.5;
  return config;
}

Pose at(double x, double y, double z) {
  return lookAlong({x, y, z}, Vector3d::UnitX());
}

TEST(FreeFlyer, FliesStraightAndTakesLengthOverSpeed) {
  FreeFlyer robot(anywhere(), at(0.2, 0.2, 0.3));
  robot.observe(walledSpace());
  const Pose goal = lookAlong({0.2, 0.9, 0.3}, {1, 1, 0});
  const MotionPlan plan = robot.plan(goal, 1);
  ASSERT_EQ(plan.verdict, Reachability::Reachable);
  EXPECT_TRUE(plan.straight);
  EXPECT_NEAR(robot.execute(plan, {}), 0.7 / 0.5, 1e-9);
  EXPECT_TRUE(robot.state().T_world_camera.isApprox(goal));
}

TEST(FreeFlyer, GoesAroundAnObstacleTheSameWayEachTime) {
  FreeFlyer robot(anywhere(), at(0.2, 0.6, 0.3));
  robot.observe(walledSpace());
  const MotionPlan plan = robot.plan(at(1.0, 0.6, 0.3), 7);
  ASSERT_EQ(plan.verdict, Reachability::Reachable);
  EXPECT_FALSE(plan.straight);
  EXPECT_GT(plan.length_m, 1.2);
  const MotionPlan again = robot.plan(at(1.0, 0.6, 0.3), 7);
  EXPECT_EQ(plan.length_m, again.length_m);
}

TEST(FreeFlyer, StaysWhereItIsWithoutAPath) {
  FreeFlyer robot(anywhere(), at(0.2, 0.6, 0.3));
  EXPECT_NE(robot.plan(at(0.3, 0.6, 0.3), 1).verdict, Reachability::Reachable);  // nothing observed yet
  robot.observe(walledSpace());
  const MotionPlan blocked = robot.plan(at(0.6, 0.6, 0.3), 1);
  EXPECT_EQ(blocked.verdict, Reachability::InCollision);
  EXPECT_EQ(robot.execute(blocked, {}), 0.0);
  EXPECT_TRUE(robot.state().T_world_camera.isApprox(at(0.2, 0.6, 0.3)));
}

TEST(FreeFlyer, RefusesAnImpossibleConfiguration) {
  FreeFlyerConfig config = anywhere();
  config.speed_m_per_s = 0.0;
  EXPECT_THROW(FreeFlyer(config, at(0, 0, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
