#include "core/motion/arm_planner.h"

#include <gtest/gtest.h>

#include <random>

#include "io/robot_file.h"
#include "io/scene_file.h"
#include "io/scene_truth.h"
#include "tests/core/motion/box_world.h"

namespace vantage {
namespace {

using test::freeWorld;

struct Planner : ArmPlanner {
  explicit Planner(const ArmConfig& config = {}) : ArmPlanner(loadRobot("smart_six"), config) {
    start.joints = JointVector(6);
    start.joints << 0.0, -0.3, -1.9, 0.0, 0.9, 0.0;
    start.T_world_camera = cameraPose(start.joints);
  }
  RobotState start;
};

/// A view from above the free world's front edge.
const Pose kView = lookAt({0.2, -0.4, 0.7}, {0.0, 0.2, 0.1});

TEST(ArmPlanner, BringsTheCameraToTheView) {
  Planner planner;
  planner.observe(freeWorld());
  const MotionPlan plan = planner.plan(planner.start, kView, 1);
  ASSERT_EQ(plan.verdict, Reachability::Reachable);
  ASSERT_TRUE(plan.trajectory);
  EXPECT_EQ(plan.trajectory->positions.front(), planner.start.joints);
  const Pose arrived = planner.cameraPose(plan.trajectory->positions.back());
  EXPECT_TRUE(isNear(arrived, kView, 1e-6, 1e-6));
  EXPECT_TRUE(isNear(plan.waypoints.front(), planner.start.T_world_camera, 1e-9, 1e-9));
  EXPECT_TRUE(plan.waypoints.back().isApprox(kView));
  double way = 0.0;
  for (std::size_t i = 1; i < plan.waypoints.size(); ++i)
    way += (plan.waypoints[i].translation() - plan.waypoints[i - 1].translation()).norm();
  EXPECT_NEAR(way, plan.length_m, 0.02 * plan.length_m);
  EXPECT_NO_THROW(planner.requireSafe(*plan.trajectory, planner.start.joints));
}

TEST(ArmPlanner, SaysWhyThereIsNoMotion) {
  Planner planner;
  EXPECT_EQ(planner.plan(planner.start, kView, 1).verdict, Reachability::OutOfReach);  // no map yet
  StateGrid unknown(freeWorld().geometry());
  planner.observe(unknown);
  EXPECT_EQ(planner.plan(planner.start, kView, 1).verdict, Reachability::InCollision);
  EXPECT_EQ(planner.check(kView), Reachability::InCollision);
  planner.observe(freeWorld());
  EXPECT_EQ(planner.check(kView), Reachability::Reachable);
  const Pose far = lookAlong({0.95, 0.95, 0.3}, {0, 1, 0});
  EXPECT_EQ(planner.plan(planner.start, far, 1).verdict, Reachability::NoIk);
  EXPECT_EQ(planner.check(far), Reachability::NoIk);
  EXPECT_EQ(planner.check(lookAlong({0, 0, 5.0}, {0, 1, 0})), Reachability::OutOfReach);
}

TEST(ArmPlanner, VerdictsAreOfThePoseAndNotOfThePosition) {
  Planner planner;
  planner.observe(freeWorld());
  Pose backward = kView;
  backward.rotate(Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitY()));
  EXPECT_EQ(planner.check(kView), Reachability::Reachable);
  EXPECT_NE(planner.check(backward), Reachability::Reachable);
  EXPECT_TRUE(planner.plan(planner.start, backward, 1).by_orientation);
}

TEST(ArmPlanner, TakesAMapOfAnotherGrid) {
  Planner planner;
  planner.observe(freeWorld());
  GridGeometry finer = freeWorld().geometry();
  finer.voxel_size_m = 0.01;
  finer.size *= 2;
  planner.observe(StateGrid(finer));
  EXPECT_EQ(planner.check(kView), Reachability::InCollision);
}

/// A motion that is planned is one that may be sent, also where the arm passes close to something.
TEST(ArmPlanner, EveryPlannedMotionMayBeSent) {
  ArmConfig coarse;  // much lies between the points that are looked at
  coarse.path.check_step_m = 0.08;
  Planner planner(coarse);
  StateGrid states = freeWorld();
  for (const double x : {-0.5, 0.0, 0.5})
    test::fill(states, Box(Eigen::Vector3d(x - 0.1, -0.2, 0.0), Eigen::Vector3d(x + 0.1, 0.1, 0.5)),
               VoxelState::Unknown);
  planner.observe(states);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> across(-0.7, 0.7), along(-0.5, 0.5), up(0.1, 0.9);
  int sent = 0;
  RobotState at = planner.start;
  for (std::uint64_t n = 0; n < 300; ++n) {
    const double x = across(random), y = along(random), z = up(random);
    const MotionPlan plan = planner.plan(at, lookAt({x, y, z}, {0.5 * x, 0.2, 0.1}), n);
    if (plan.verdict != Reachability::Reachable) continue;
    ++sent;
    EXPECT_EQ(planner.refusal(*plan.trajectory, at.joints), "") << n;
    at.joints = plan.trajectory->positions.back();
  }
  EXPECT_GT(sent, 30);
}

TEST(ArmPlanner, RefusesToSendWhatIsNotSafe) {
  Planner planner;
  planner.observe(freeWorld());
  const MotionPlan plan = planner.plan(planner.start, kView, 1);
  ASSERT_TRUE(plan.trajectory);
  const auto refusal = [&](const JointTrajectory& trajectory, const JointVector& at) -> std::string {
    try {
      planner.requireSafe(trajectory, at);
    } catch (const ArmRefusal& error) {
      return error.what();
    }
    return "";
  };
  JointVector elsewhere = planner.start.joints;
  elsewhere[3] += 0.2;
  EXPECT_NE(refusal(*plan.trajectory, elsewhere).find("0.200 rad away"), std::string::npos);
  JointTrajectory fast = *plan.trajectory;
  for (double& t : fast.time_s) t *= 0.05;
  EXPECT_NE(refusal(fast, planner.start.joints).find("would move at"), std::string::npos);
  // Somebody put something in the way.
  StateGrid blocked = freeWorld();
  test::fill(blocked, Box(Eigen::Vector3d(-1, -0.6, 0.0), Eigen::Vector3d(1, 1, 0.8)), VoxelState::Occupied);
  planner.observe(blocked);
  EXPECT_NE(refusal(*plan.trajectory, planner.start.joints).find("would touch occupied or unknown space"),
            std::string::npos);
}

/// The boxes of the default configuration are vouched for: nothing of a scene on the table may be in them.
TEST(ArmPlanner, TheSpaceVouchedForHoldsNothingOfTheScenesOnTheTable) {
  for (const char* name : {"tabletop", "row", "apart", "clutter"}) {
    const SceneTruth truth(loadScene(name));
    for (const Box& box : ArmConfig::aroundTheTable()) {
      const Eigen::Vector3d size = box.sizes();
      for (double x = 0.0; x <= 1.0; x += 0.02)
        for (double y = 0.0; y <= 1.0; y += 0.02)
          for (double z = 0.02; z <= 1.0; z += 0.02) {
            const Eigen::Vector3d p = box.min() + size.cwiseProduct(Eigen::Vector3d(x, y, z));
            ASSERT_LT(0.0, truth.objectDistance(p) + (truth.insideSolid(p) ? 0.0 : 1.0)) << name;
          }
    }
  }
}

}  // namespace
}  // namespace vantage
