#include "core/motion/arm_path.h"

#include <gtest/gtest.h>

#include <random>

#include "core/motion/shortcut.h"
#include "io/robot_file.h"
#include "tests/core/motion/box_world.h"

namespace vantage {
namespace {

using test::fill;
using test::freeWorld;

/// The SMART SiX in the middle of one side of the free world, its own side vouched for.
struct Cell {
  explicit Cell(const StateGrid& states)
      : inverse(loadRobot("smart_six")),
        collision(inverse.model(),
                  {T_world_base,
                   {Box(Eigen::Vector3d(-1.5, -2.0, -0.5), Eigen::Vector3d(1.5, -0.5, 2.5)),
                    Box(Eigen::Vector3d(-1.5, -1.0, 1.0), Eigen::Vector3d(1.5, 1.5, 2.5))}}) {
    collision.update(CollisionGrid(states, 0.04));
    start << 0.0, -0.3, -1.9, 0.0, 0.9, 0.0;
  }
  ArmPath plan(const Pose& T_world_camera, std::uint64_t seed, const ArmPathConfig& config = {}) const {
    return planArmPath(inverse, collision, start, T_world_base.inverse() * T_world_camera, config, seed);
  }

  // Turned so that the arm's x axis points into the free world.
  Pose T_world_base =
      Eigen::Translation3d(0.0, -0.9, 0.0) * Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitZ());
  InverseKinematics inverse;
  ArmCollision collision;
  JointVector start{6};
};

/// A wall across the free world, from the floor to 0.8 m.
StateGrid walled() {
  StateGrid states = freeWorld();
  fill(states, Box(Eigen::Vector3d(-0.06, -0.5, 0.0), Eigen::Vector3d(0.06, 1.0, 0.8)), VoxelState::Unknown);
  return states;
}

/// No part of the path touches anything, at a tenth of the step that the planner looked at.
void expectSafe(const Cell& cell, const ArmPath& path) {
  ASSERT_TRUE(path.found());
  EXPECT_EQ(path.configurations.front(), cell.start);
  for (std::size_t i = 1; i < path.configurations.size(); ++i) {
    const JointVector &from = path.configurations[i - 1], &to = path.configurations[i];
    for (int s = 0; s <= 500; ++s) {
      const JointVector q = from + (to - from) * (s / 500.0);
      ASSERT_TRUE(cell.inverse.model().withinLimits(q));
      ASSERT_TRUE(cell.collision.check(q).free()) << cell.collision.check(q).link;
    }
  }
}

const Pose kRight = lookAt({0.45, -0.25, 0.55}, {0.3, 0.3, 0.1});
const Pose kLeft = lookAt({-0.45, -0.25, 0.55}, {-0.3, 0.3, 0.1});

TEST(ArmPath, GoesStraightThroughFreeSpace) {
  const Cell cell(freeWorld());
  const ArmPath path = cell.plan(kRight, 1);
  expectSafe(cell, path);
  EXPECT_TRUE(path.straight);
  EXPECT_EQ(path.iterations, 0);
  const Pose reached = cell.T_world_base * cameraPose(cell.inverse.model(), path.configurations.back());
  EXPECT_TRUE(isNear(reached, kRight, 1e-6, 1e-6));
}

TEST(ArmPath, GoesAroundAWallOfTheUnknown) {
  Cell cell(walled());
  const ArmPath there = cell.plan(kRight, 1);
  expectSafe(cell, there);
  cell.start = there.configurations.back();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const ArmPath path = cell.plan(kLeft, seed);
    expectSafe(cell, path);
    EXPECT_FALSE(path.straight);
    EXPECT_GT(path.configurations.size(), 2u);
    const Pose reached = cell.T_world_base * cameraPose(cell.inverse.model(), path.configurations.back());
    EXPECT_TRUE(isNear(reached, kLeft, 1e-6, 1e-6));
  }
}

/// A hair beyond a limit, as rounding leaves it: the way around is found all the same.
TEST(ArmPath, StartAHairBeyondALimitIsTakenBack) {
  Cell cell(walled());
  cell.start = cell.plan(kRight, 1).configurations.back();
  const double upper = cell.inverse.model().joints[5].upper;
  cell.start[5] = upper + 5e-10;
  const ArmPath path = cell.plan(kLeft, 1);
  ASSERT_TRUE(path.found());
  EXPECT_FALSE(path.straight);
  EXPECT_EQ(path.configurations.front()[5], upper);
}

TEST(ArmPath, SameSeedSamePath) {
  Cell cell(walled());
  cell.start = cell.plan(kRight, 1).configurations.back();
  const ArmPath first = cell.plan(kLeft, 42), other = cell.plan(kLeft, 43), again = cell.plan(kLeft, 42);
  ASSERT_TRUE(first.found());
  ASSERT_EQ(first.configurations.size(), again.configurations.size());
  for (std::size_t i = 0; i < first.configurations.size(); ++i)
    EXPECT_EQ(first.configurations[i], again.configurations[i]);
  EXPECT_EQ(first.iterations, again.iterations);
  EXPECT_NE(lengthOf(first.configurations), lengthOf(other.configurations));
}

TEST(ArmPath, SaysWhyThereIsNone) {
  const Cell cell(walled());
  const ArmPath far = cell.plan(lookAt({0.0, 2.5, 0.5}, {0.0, 0.0, 0.0}), 1);
  EXPECT_FALSE(far.found());
  EXPECT_EQ(far.solutions, 0);
  const ArmPath inside = cell.plan(lookAt({0.0, -0.1, 0.4}, {0.0, 0.5, 0.1}), 1);
  EXPECT_FALSE(inside.found());
  EXPECT_GT(inside.solutions, 0);
  EXPECT_EQ(inside.free_solutions, 0);
  EXPECT_EQ(inside.contact.with, ArmContact::With::Obstacle);
  ArmPathConfig straight_only;
  straight_only.rrt_iterations = 0;
  Cell moved(walled());
  moved.start = moved.plan(kRight, 1).configurations.back();
  const ArmPath blocked = moved.plan(kLeft, 1, straight_only);
  EXPECT_FALSE(blocked.found());
  EXPECT_GT(blocked.free_solutions, 0);
  EXPECT_FALSE(blocked.timed_out);
}

TEST(ArmPath, StartInCollisionIsSaid) {
  Cell cell(walled());
  cell.start << 0.0, 1.2, -0.6, 0.0, 0.0, 0.0;  // through the wall
  ASSERT_FALSE(cell.collision.check(cell.start).free());
  const ArmPath path = cell.plan(kRight, 1);
  EXPECT_FALSE(path.found());
  EXPECT_GT(path.free_solutions, 0);
  EXPECT_TRUE(path.start_blocked);
  EXPECT_EQ(path.contact.with, ArmContact::With::Obstacle);
  cell.start[2] = 1.0;
  EXPECT_THROW(cell.plan(kRight, 1), std::invalid_argument);
}

TEST(ArmPath, SweepBoundHoldsOnRandomMotions) {
  for (const char* name : {"smart_six", "ur5"}) {
    const RobotModel arm = loadRobot(name);
    std::mt19937_64 random(1);
    const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    for (int n = 0; n < 2000; ++n) {
      JointVector from(6), step(6);
      for (int i = 0; i < 6; ++i) {
        from[i] = -3.0 + 6.0 * unit();
        step[i] = -0.1 + 0.2 * unit();
      }
      const ArmFrames a = forwardKinematics(arm, from), b = forwardKinematics(arm, from + step);
      const double bound = sweepBound(arm, step);
      for (const LinkShape& shape : arm.shapes) {
        const Eigen::Vector3d p = shape.T_frame_shape * (0.5 * shape.size_m);
        EXPECT_LE((b.of(shape.frame) * p - a.of(shape.frame) * p).norm(), bound);
      }
      EXPECT_LE((b.T_base_camera.translation() - a.T_base_camera.translation()).norm(), bound);
    }
  }
}

TEST(ArmPath, ConfigNamesFieldAndValue) {
  ArmPathConfig config;
  config.check_step_m = 0.0;
  EXPECT_THROW(config.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
