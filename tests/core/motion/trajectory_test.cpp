#include "core/motion/trajectory.h"

#include <gtest/gtest.h>

#include "io/robot_file.h"
#include "tests/support/random_configuration.h"

namespace vantage {
namespace {

JointVector six(double a, double b, double c, double d, double e, double f) {
  JointVector q(6);
  q << a, b, c, d, e, f;
  return q;
}

TEST(Trajectory, TakesTheSlowestJointsTimeAndARamp) {
  RobotModel arm = loadRobot("smart_six");
  for (ArmJoint& joint : arm.joints) joint.max_velocity = 2.0;
  const std::vector<JointVector> corners = {six(0, 0, -1, 0, 0, 0), six(1, 0.2, -1, 0, 0, 0)};
  const JointTrajectory t =
      timedTrajectory(arm, corners, {.speed_share = 0.5, .ramp_s = 0.25, .period_s = 0.02});
  EXPECT_NEAR(t.duration_s(), 1.0 + 0.25, 1e-12);  // 1 rad at 1 rad/s, and a ramp
  EXPECT_EQ(t.positions.front(), corners[0]);
  EXPECT_EQ(t.positions.back(), corners[1]);
  EXPECT_EQ(t.velocities.back().norm(), 0.0);
  double fastest = 0.0;
  for (const JointVector& v : t.velocities) fastest = std::max(fastest, v.cwiseAbs().maxCoeff());
  EXPECT_NEAR(fastest, 1.0, 1e-9);
}

TEST(Trajectory, AShortMotionNeverReachesFullSpeed) {
  const RobotModel arm = loadRobot("smart_six");
  const JointTrajectory t = timedTrajectory(arm, {six(0, 0, -1, 0, 0, 0), six(1e-3, 0, -1, 0, 0, 0)}, {});
  const double full = 0.25 * arm.joints[0].max_velocity;
  EXPECT_NEAR(t.duration_s(), 2.0 * std::sqrt(1e-3 / full * 0.25), 1e-9);
  for (const JointVector& v : t.velocities) EXPECT_LT(v[0], full);
}

TEST(Trajectory, StaysWithinVelocitiesAndOnTheStraightMotions) {
  const RobotModel arm = loadRobot("ur5");
  std::mt19937_64 random(3);
  for (int n = 0; n < 20; ++n) {
    std::vector<JointVector> corners;
    for (int c = 0; c < 4; ++c) corners.push_back(test::randomConfiguration(arm, random));
    const JointTrajectory t = timedTrajectory(arm, corners, {.speed_share = 1.0});
    EXPECT_EQ(limitViolation(arm, t), "");
    std::size_t corner = 0;
    for (std::size_t p = 0; p < t.size(); ++p) {
      if (t.positions[p] == corners[corner + 1] && corner + 2 < corners.size()) ++corner;
      const JointVector along = corners[corner + 1] - corners[corner], at = t.positions[p] - corners[corner];
      const double share = along.dot(at) / along.squaredNorm();
      EXPECT_LT((at - share * along).norm(), 1e-9);
      EXPECT_GE(share, -1e-9);
      EXPECT_LE(share, 1.0 + 1e-9);
    }
  }
}

TEST(Trajectory, SaysWhatTheArmCannotDo) {
  const RobotModel arm = loadRobot("smart_six");
  const JointTrajectory good = timedTrajectory(arm, {six(0, 0, -1, 0, 0, 0), six(1, 0, -1, 0, 0, 0)}, {});
  ASSERT_EQ(limitViolation(arm, good), "");
  JointTrajectory fast = good;
  for (double& t : fast.time_s) t *= 0.1;
  EXPECT_NE(limitViolation(arm, fast).find("axis_1 would move at"), std::string::npos);
  JointTrajectory far = good;
  far.positions[3][2] = 0.5;
  EXPECT_NE(limitViolation(arm, far).find("axis_3 would go to 0.5"), std::string::npos);
  JointTrajectory back = good;
  std::swap(back.time_s[2], back.time_s[3]);
  EXPECT_NE(limitViolation(arm, back).find("not later"), std::string::npos);
  JointTrajectory nan = good;
  nan.positions[2][1] = std::nan("");
  EXPECT_NE(limitViolation(arm, nan), "");
  EXPECT_NE(limitViolation(arm, {}), "");
}

}  // namespace
}  // namespace vantage
