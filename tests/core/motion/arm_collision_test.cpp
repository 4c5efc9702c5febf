#include "core/motion/arm_collision.h"

#include <gtest/gtest.h>

#include <random>

#include "io/robot_file.h"
#include "tests/core/motion/box_world.h"

namespace vantage {
namespace {

using test::fill;
using test::freeWorld;
using With = ArmContact::With;

/// Three sliding joints that carry a ball: a free flyer. Limits say how far the map matters, no more.
RobotModel slidingBall(double radius_m) {
  RobotModel model;
  for (int axis = 0; axis < 3; ++axis) {
    ArmJoint joint;
    joint.prismatic = true;
    joint.axis = Eigen::Vector3d::Unit(axis);
    joint.lower = -0.6;
    joint.upper = 0.6;
    model.joints.push_back(joint);
  }
  LinkShape ball;
  ball.link = "ball";
  ball.frame = 2;
  ball.kind = ShapeKind::Sphere;
  ball.radius_m = radius_m;
  model.shapes.push_back(ball);
  return model;
}

JointVector randomPosition(std::mt19937_64& random) {
  JointVector q(3);
  for (int axis = 0; axis < 3; ++axis) q[axis] = -1.2 + 2.4 * static_cast<double>(random() >> 11) * 0x1p-53;
  return q;
}

/// Free space with blocks and unknown in it.
StateGrid clutteredWorld(std::uint64_t seed) {
  StateGrid states = freeWorld();
  std::mt19937_64 random(seed);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int n = 0; n < 25; ++n) {
    const Eigen::Vector3d corner(-1.0 + 2.0 * unit(), -1.0 + 2.0 * unit(), unit());
    const Eigen::Vector3d size(0.05 + 0.3 * unit(), 0.05 + 0.3 * unit(), 0.05 + 0.3 * unit());
    fill(states, Box(corner, corner + size), n % 2 ? VoxelState::Unknown : VoxelState::Occupied);
  }
  return states;
}

TEST(ArmCollision, BallAgreesWithTheFreeFlyersCells) {
  int free = 0, blocked = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const CollisionGrid grid(clutteredWorld(seed), 0.04);
    ArmCollision arm(slidingBall(0.08), {});
    arm.update(grid);
    std::mt19937_64 random(seed);
    for (int n = 0; n < 2000; ++n) {
      const JointVector q = randomPosition(random);
      const bool expected = grid.freeBall(q, 0.08);
      EXPECT_EQ(arm.check(q).free(), expected) << q.transpose();
      (expected ? free : blocked) += 1;
    }
  }
  EXPECT_GT(free, 300);
  EXPECT_GT(blocked, 300);
}

TEST(ArmCollision, UpdatesWriteOnlyWhatChangedAndEndTheSame) {
  const CollisionGrid before(clutteredWorld(1), 0.04), after(clutteredWorld(2), 0.04);
  ArmCollision updated(slidingBall(0.08), {}), fresh(slidingBall(0.08), {});
  const std::size_t all = updated.update(before);
  EXPECT_EQ(updated.update(before), 0u);
  const std::size_t changed = updated.update(after);
  EXPECT_GT(changed, 0u);
  EXPECT_LT(changed, all / 2);
  fresh.update(after);
  std::mt19937_64 random(1);
  for (int n = 0; n < 2000; ++n) {
    const JointVector q = randomPosition(random);
    EXPECT_EQ(updated.check(q).with, fresh.check(q).with) << q.transpose();
  }
}

TEST(ArmCollision, NothingIsFreeBeforeTheFirstMapOrBeyondIt) {
  ArmCollision arm(slidingBall(0.08), {});
  EXPECT_EQ(arm.check(JointVector::Zero(3)).with, With::Obstacle);
  arm.update(CollisionGrid(freeWorld(), 0.04));
  JointVector q(3);
  q << 0.0, 0.0, 0.5;
  EXPECT_TRUE(arm.check(q).free());
  q[0] = 1.2;
  EXPECT_EQ(arm.check(q).with, With::Obstacle);
  EXPECT_EQ(arm.check(q).link, "ball");
}

TEST(ArmCollision, VouchedBoxesAreFree) {
  ArmPlace place;
  place.clear_boxes = {Box(Eigen::Vector3d(0.5, -0.5, 0.0), Eigen::Vector3d(1.5, 0.5, 1.0))};
  ArmCollision arm(slidingBall(0.08), place);
  arm.update(CollisionGrid(freeWorld(), 0.04));
  JointVector q(3);
  q << 1.2, 0.0, 0.5;
  EXPECT_TRUE(arm.check(q).free());
  q[1] = 0.6;
  EXPECT_EQ(arm.check(q).with, With::Obstacle);
}

TEST(ArmCollision, RefusesOtherCellsAndArmsWithoutEnd) {
  ArmCollision arm(slidingBall(0.08), {});
  arm.update(CollisionGrid(freeWorld(), 0.04));
  EXPECT_THROW(arm.update(CollisionGrid(freeWorld(), 0.06)), std::invalid_argument);
  RobotModel endless = slidingBall(0.08);
  endless.joints[0].T_parent_joint.translation().x() = 1e12;
  EXPECT_THROW(ArmCollision(endless, {}).update(CollisionGrid(freeWorld(), 0.04)), std::invalid_argument);
}

/// All free around an arm.
ArmPlace openPlace() {
  return {Pose::Identity(), {Box(Eigen::Vector3d::Constant(-5.0), Eigen::Vector3d::Constant(5.0))}};
}

TEST(ArmCollision, ArmsAreFreeUprightAndHitThemselvesFolded) {
  for (const char* name : {"smart_six", "ur5"}) {
    ArmCollision arm(loadRobot(name), openPlace());
    arm.update(CollisionGrid(freeWorld(), 0.04));
    JointVector q = JointVector::Zero(6);
    if (name[0] == 'u') q[1] = -1.5707963267948966;  // its zero lies flat
    EXPECT_TRUE(arm.check(q).free()) << name << ": " << arm.check(q).link << " - " << arm.check(q).other;
  }
  ArmCollision arm(loadRobot("ur5"), openPlace());
  arm.update(CollisionGrid(freeWorld(), 0.04));
  JointVector q = JointVector::Zero(6);
  q << 0.0, -1.57, 3.1, 0.0, 0.0, 0.0;  // the forearm back through the shoulder
  EXPECT_EQ(arm.check(q).with, With::Itself);
  EXPECT_FALSE(arm.check(q).other.empty());
}

}  // namespace
}  // namespace vantage
