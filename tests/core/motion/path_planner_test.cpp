#include "core/motion/path_planner.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/core/motion/box_world.h"

namespace vantage {
namespace {

using test::fill;
using test::freeWorld;

FreeFlyerConfig unlimited() {
  FreeFlyerConfig config;
  config.reach_m = 0.0;
  config.min_height_m = 0.0;
  return config;
}

Pose at(double x, double y, double z) {
  return lookAlong({x, y, z}, Eigen::Vector3d(0.3, 1.0, -0.2));
}

/// A wall at x = 0 with a window of 0.32 x 0.32 m away from the straight line.
StateGrid wallWithWindow(VoxelState wall) {
  StateGrid states = freeWorld();
  fill(states, Box(Eigen::Vector3d(0.0, -1.0, 0.0), Eigen::Vector3d(0.08, 1.0, 1.0)), wall);
  fill(states, Box(Eigen::Vector3d(0.0, 0.4, 0.6), Eigen::Vector3d(0.08, 0.72, 0.92)), VoxelState::Free);
  return states;
}

void expectSamePath(const MotionPlan& a, const MotionPlan& b) {
  ASSERT_EQ(a.waypoints.size(), b.waypoints.size());
  for (std::size_t i = 0; i < a.waypoints.size(); ++i)
    EXPECT_EQ(a.waypoints[i].matrix(), b.waypoints[i].matrix()) << "waypoint " << i;
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(a.length_m, b.length_m);
}

TEST(PathPlanner, FlysStraightThroughFreeSpace) {
  const CollisionGrid grid(freeWorld(), 0.04, 0.08);
  const Pose from = at(-0.5, -0.5, 0.3), to = lookAt({0.5, 0.5, 0.6}, {0.0, 0.0, 0.0});
  const MotionPlan plan = planPath(grid, from, to, unlimited(), 1);
  EXPECT_EQ(plan.verdict, Reachability::Reachable);
  EXPECT_TRUE(plan.straight);
  ASSERT_EQ(plan.waypoints.size(), 2u);
  EXPECT_EQ(plan.waypoints[0].matrix(), from.matrix());
  EXPECT_EQ(plan.waypoints[1].matrix(), to.matrix());
  EXPECT_DOUBLE_EQ(plan.length_m, Eigen::Vector3d(1.0, 1.0, 0.3).norm());
  EXPECT_EQ(plan.iterations, 0);
}

TEST(PathPlanner, PassesAWindowInAWall) {
  for (const VoxelState wall : {VoxelState::Occupied, VoxelState::Unknown}) {
    const CollisionGrid grid(wallWithWindow(wall), 0.04, 0.08);
    const Pose from = at(-0.6, -0.6, 0.2), to = lookAlong({0.6, -0.6, 0.2}, {-1.0, 0.5, 0.0});
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const MotionPlan plan = planPath(grid, from, to, unlimited(), seed);
      ASSERT_EQ(plan.verdict, Reachability::Reachable) << seed;
      EXPECT_FALSE(plan.straight);
      EXPECT_GT(plan.iterations, 0);
      ASSERT_GE(plan.waypoints.size(), 3u);
      EXPECT_EQ(plan.waypoints.front().matrix(), from.matrix());
      EXPECT_EQ(plan.waypoints.back().matrix(), to.matrix());
      double length = 0.0;
      for (std::size_t i = 1; i < plan.waypoints.size(); ++i) {
        const Eigen::Vector3d a = plan.waypoints[i - 1].translation(), b = plan.waypoints[i].translation();
        EXPECT_TRUE(grid.freeSegment(a, b, 0.08, 0.002)) << "segment " << i << " of seed " << seed;
        length += (b - a).norm();
      }
      EXPECT_NEAR(length, plan.length_m, 1e-12);
      EXPECT_LT(length, 3.2);  // the way through the window is about 2.7 m
    }
  }
}

TEST(PathPlanner, TurnsEvenlyOverTheLength) {
  const CollisionGrid grid(wallWithWindow(VoxelState::Occupied), 0.04, 0.08);
  const Pose from = at(-0.6, -0.6, 0.2), to = lookAlong({0.6, -0.6, 0.2}, {-1.0, 0.5, 0.0});
  const MotionPlan plan = planPath(grid, from, to, unlimited(), 3);
  ASSERT_GE(plan.waypoints.size(), 3u);
  double done = 0.0;
  for (std::size_t i = 1; i < plan.waypoints.size(); ++i) {
    done += (plan.waypoints[i].translation() - plan.waypoints[i - 1].translation()).norm();
    EXPECT_TRUE(isRigid(plan.waypoints[i].matrix(), 1e-9));
    EXPECT_NEAR(angleBetween(from, plan.waypoints[i]), done / plan.length_m * angleBetween(from, to), 1e-6);
  }
}

TEST(PathPlanner, SameSeedSamePathWhateverWasAskedBetween) {
  const CollisionGrid grid(wallWithWindow(VoxelState::Occupied), 0.04, 0.08);
  const Pose from = at(-0.6, -0.6, 0.2), to = at(0.6, -0.6, 0.2);
  const MotionPlan first = planPath(grid, from, to, unlimited(), 42);
  expectSamePath(first, planPath(grid, from, to, unlimited(), 42));
  std::set<double> lengths;
  for (std::uint64_t seed = 0; seed < 8; ++seed)
    lengths.insert(planPath(grid, at(-0.4, 0.3, 0.2), to, unlimited(), seed).length_m);
  EXPECT_GT(lengths.size(), 1u);  // the seed is used
  expectSamePath(first, planPath(grid, from, to, unlimited(), 42));
}

TEST(PathPlanner, ClosedBoxIsNotConnectedWithoutPlanning) {
  StateGrid states = freeWorld();
  fill(states, Box(Eigen::Vector3d(0.2, -0.4, 0.0), Eigen::Vector3d(1.0, 0.4, 0.8)), VoxelState::Occupied);
  fill(states, Box(Eigen::Vector3d(0.24, -0.36, 0.04), Eigen::Vector3d(0.96, 0.36, 0.76)), VoxelState::Free);
  const CollisionGrid grid(states, 0.04, 0.08);
  const MotionPlan plan = planPath(grid, at(-0.5, 0.0, 0.5), at(0.6, 0.0, 0.4), unlimited(), 1);
  EXPECT_EQ(plan.verdict, Reachability::NotConnected);
  EXPECT_EQ(plan.iterations, 0);
  EXPECT_TRUE(plan.waypoints.empty());
}

TEST(PathPlanner, StartInCollisionIsNotConnected) {
  StateGrid states = freeWorld();
  fill(states, Box(Eigen::Vector3d(-0.52, 0.0, 0.48), Eigen::Vector3d(-0.48, 0.04, 0.52)),
       VoxelState::Unknown);
  const CollisionGrid grid(states, 0.04, 0.08);
  EXPECT_EQ(planPath(grid, at(-0.5, 0.0, 0.5), at(0.6, 0.0, 0.4), unlimited(), 1).verdict,
            Reachability::NotConnected);
}

TEST(PathPlanner, GoalInUnknownOrOccupiedIsInCollision) {
  for (const VoxelState state : {VoxelState::Unknown, VoxelState::Occupied}) {
    StateGrid states = freeWorld();
    fill(states, Box(Eigen::Vector3d(0.2, -0.2, 0.2), Eigen::Vector3d(0.4, 0.2, 0.6)), state);
    const CollisionGrid grid(states, 0.04, 0.08);
    EXPECT_EQ(planPath(grid, at(-0.5, 0.0, 0.5), at(0.3, 0.0, 0.4), unlimited(), 1).verdict,
              Reachability::InCollision);
    EXPECT_EQ(checkPosition(grid, {0.15, 0.0, 0.4}, unlimited()), Reachability::InCollision);
    EXPECT_EQ(checkPosition(grid, {0.11, 0.0, 0.4}, unlimited()), Reachability::Reachable);
  }
}

TEST(PathPlanner, LimitsGiveOutOfReach) {
  const CollisionGrid grid(freeWorld(), 0.04, 0.08);
  FreeFlyerConfig config;
  config.min_height_m = 0.3;
  EXPECT_EQ(checkPosition(grid, {0.0, -0.5, 0.29}, config), Reachability::OutOfReach);
  EXPECT_EQ(checkPosition(grid, {0.0, -0.5, 0.31}, config), Reachability::Reachable);
  EXPECT_EQ(checkPosition(grid, {0.0, 0.56, 0.3}, config), Reachability::OutOfReach);  // reach is 1.4 m
  EXPECT_EQ(checkPosition(grid, {0.0, 0.54, 0.3}, config), Reachability::Reachable);
  EXPECT_EQ(checkPosition(grid, {0.0, 0.0, 1.5}, unlimited()), Reachability::OutOfReach);
  EXPECT_EQ(checkPosition(grid, {0.0, std::nan(""), 0.5}, config), Reachability::OutOfReach);
  EXPECT_EQ(checkPosition(CollisionGrid(), {0.0, 0.0, 0.5}, unlimited()), Reachability::OutOfReach);
}

TEST(PathPlanner, StaysWithinReachAndHeight) {
  StateGrid states = freeWorld();
  fill(states, Box(Eigen::Vector3d(-0.1, -0.5, 0.0), Eigen::Vector3d(0.1, 0.5, 0.8)), VoxelState::Occupied);
  const CollisionGrid grid(states, 0.04, 0.08);
  FreeFlyerConfig config = unlimited();
  config.reach_center_m = {0.0, 0.4, 0.3};  // the way round at -y and the one over the wall are out of reach
  config.reach_m = 0.55;
  config.min_height_m = 0.2;
  const MotionPlan plan = planPath(grid, at(-0.4, 0.3, 0.3), at(0.4, 0.3, 0.3), config, 9);
  ASSERT_EQ(plan.verdict, Reachability::Reachable);
  for (const Pose& w : plan.waypoints) {
    EXPECT_LE((w.translation() - config.reach_center_m).norm(), config.reach_m + 1e-9);
    EXPECT_GE(w.translation().z(), config.min_height_m);
  }
  // A start beyond the limits can come back.
  EXPECT_EQ(planPath(grid, at(0.9, 0.9, 0.1), at(0.4, 0.3, 0.3), config, 9).verdict, Reachability::Reachable);
}

TEST(PathPlanner, GivesUpAfterItsIterations) {
  const CollisionGrid grid(wallWithWindow(VoxelState::Occupied), 0.04, 0.08);
  FreeFlyerConfig config = unlimited();
  config.rrt_iterations = 3;
  const MotionPlan plan = planPath(grid, at(-0.6, -0.6, 0.2), at(0.6, -0.6, 0.2), config, 1);
  EXPECT_EQ(plan.verdict, Reachability::NoPath);
  EXPECT_EQ(plan.iterations, 3);
  EXPECT_TRUE(plan.waypoints.empty());
}

TEST(PathPlanner, SaysWhenTheWallClockStruck) {
  // A slit that points fit through but not the body: a grid for points sees a connection, no path exists.
  StateGrid states = wallWithWindow(VoxelState::Occupied);
  fill(states, Box(Eigen::Vector3d(0.0, 0.4, 0.6), Eigen::Vector3d(0.08, 0.72, 0.92)), VoxelState::Occupied);
  fill(states, Box(Eigen::Vector3d(0.0, 0.4, 0.6), Eigen::Vector3d(0.08, 0.52, 0.72)), VoxelState::Free);
  const CollisionGrid grid(states, 0.04);  // components of points
  FreeFlyerConfig config = unlimited();
  config.rrt_iterations = 1000000;
  config.safety_time_s = 0.05;
  const MotionPlan plan = planPath(grid, at(-0.6, -0.6, 0.2), at(0.6, -0.6, 0.2), config, 1);
  EXPECT_EQ(plan.verdict, Reachability::TimedOut);
}

TEST(PathPlanner, ConfigNamesFieldAndValue) {
  FreeFlyerConfig config;
  EXPECT_NO_THROW(config.validate());
  config.check_step_m = 0.5;  // more than a cell
  try {
    config.validate();
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("robot.check_step_m = 0.5"), std::string::npos) << e.what();
  }
}

TEST(PathPlanner, EveryVerdictHasAText) {
  std::set<std::string_view> texts;
  for (int r = 0; r < kReachabilityCount; ++r) texts.insert(toString(static_cast<Reachability>(r)));
  EXPECT_EQ(texts.size(), static_cast<std::size_t>(kReachabilityCount));
}

}  // namespace
}  // namespace vantage
