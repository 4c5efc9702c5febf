#include "core/motion/inverse_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "io/robot_file.h"
#include "tests/support/random_configuration.h"

namespace vantage {
namespace {

using test::randomConfiguration;

constexpr double kDeg = std::numbers::pi / 180.0;

/// The largest difference of two configurations, full turns apart.
double difference(const JointVector& a, const JointVector& b) {
  double largest = 0.0;
  for (int i = 0; i < a.size(); ++i)
    largest = std::max(largest, std::abs(std::remainder(a[i] - b[i], 2 * std::numbers::pi)));
  return largest;
}

double positionError(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm();
}

/// The wrist's centre: where the axes of the last three joints meet.
Eigen::Vector3d wristCentre(const RobotModel& model, const JointVector& q) {
  return forwardKinematics(model, q).T_base_joint[4].translation();
}

TEST(SmartSix, MeetsTheManualsWorkAreaPoints) {
  const RobotModel arm = loadRobot("smart_six");
  struct Point {
    double axis_2_deg, axis_3_deg, x_mm, z_mm;
  };
  constexpr Point kPoints[] = {{30, -170, 345.85, 308.45},
                               {155, -100, -192.03, -377.77},
                               {155, -11.36, 678.27, -682.88},
                               {-85, -11.36, -1095.24, 558.94},
                               {-85, 0, -1093.69, 428.31}};
  for (const Point& point : kPoints) {
    JointVector q = JointVector::Zero(6);
    q[1] = point.axis_2_deg * kDeg;
    q[2] = point.axis_3_deg * kDeg;
    ASSERT_TRUE(arm.withinLimits(q));
    const Eigen::Vector3d wrist_mm = 1000.0 * wristCentre(arm, q);
    EXPECT_NEAR(wrist_mm.x(), point.x_mm, 0.1) << "axis 2 at " << point.axis_2_deg;
    EXPECT_NEAR(wrist_mm.z(), point.z_mm, 0.1) << "axis 2 at " << point.axis_2_deg;
    EXPECT_NEAR(wrist_mm.y(), 0.0, 1e-6);
  }
}

TEST(SmartSix, CalibrationPositionStretchesTheForearmForward) {
  const RobotModel arm = loadRobot("smart_six");
  JointVector q = JointVector::Zero(6);
  q[2] = -90 * kDeg;
  const ArmFrames frames = forwardKinematics(arm, q);
  EXPECT_NEAR(positionError(frames.T_base_joint[4], Pose(Eigen::Translation3d(0.79707, 0.0, 1.17))), 0.0,
              1e-9);
  EXPECT_NEAR((frames.T_base_camera.linear().col(2) - Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-9);
}

TEST(Ur5, StretchedOutItReachesItsPublishedLength) {
  const RobotModel arm = loadRobot("ur5");
  const ArmFrames frames = forwardKinematics(arm, JointVector::Zero(6));
  // Both long links and the three offsets of the wrist, in the plane of the base.
  const Eigen::Vector3d flange = frames.T_base_joint[5].translation();
  EXPECT_NEAR(std::abs(flange.x()), 0.425 + 0.39225, 1e-9);
  EXPECT_NEAR(std::abs(flange.y()), 0.10915 + 0.0823, 1e-9);
  EXPECT_NEAR(flange.z(), 0.089159 - 0.09465, 1e-9);
}

class BothArms : public testing::TestWithParam<const char*> {};

TEST_P(BothArms, SolutionsCloseOnTenThousandRandomConfigurations) {
  const RobotModel arm = loadRobot(GetParam());
  const InverseKinematics inverse(arm);
  std::mt19937_64 random(7);
  int recovered = 0;
  constexpr int kConfigurations = 10'000;
  for (int n = 0; n < kConfigurations; ++n) {
    const JointVector q = randomConfiguration(arm, random), near = randomConfiguration(arm, random);
    const Pose target = cameraPose(arm, q);
    const auto solutions = inverse.solve(target, inverse.analytic() ? near : q);
    ASSERT_FALSE(solutions.empty()) << "configuration " << n << ": " << q.transpose();
    bool found = false;
    for (const JointVector& s : solutions) {
      ASSERT_TRUE(arm.withinLimits(s)) << s.transpose();
      const Pose reached = cameraPose(arm, s);
      ASSERT_LE(positionError(reached, target), 1e-6);
      ASSERT_LE(angleBetween(reached, target), 1e-6);
      found = found || difference(s, q) < 1e-3;
    }
    recovered += found;
  }
  EXPECT_EQ(recovered, kConfigurations);
}

/// From anywhere else: how often the numeric search finds a way in at all, and never a wrong one.
TEST_P(BothArms, FindsSolutionsFarFromTheCurrentConfiguration) {
  const RobotModel arm = loadRobot(GetParam());
  const InverseKinematics inverse(arm);
  std::mt19937_64 random(11);
  int solved = 0;
  for (int n = 0; n < 500; ++n) {
    const Pose target = cameraPose(arm, randomConfiguration(arm, random));
    solved += !inverse.solve(target, randomConfiguration(arm, random)).empty();
  }
  EXPECT_GE(solved, inverse.analytic() ? 500 : 495);
}

TEST_P(BothArms, NearestSolutionComesFirst) {
  const RobotModel arm = loadRobot(GetParam());
  const InverseKinematics inverse(arm);
  std::mt19937_64 random(3);
  int several = 0;
  for (int n = 0; n < 200; ++n) {
    const JointVector near = randomConfiguration(arm, random);
    const auto solutions = inverse.solve(cameraPose(arm, randomConfiguration(arm, random)), near);
    several += solutions.size() > 1;
    for (std::size_t s = 1; s < solutions.size(); ++s)
      EXPECT_LE(jointTravel_s(arm, near, solutions[s - 1]), jointTravel_s(arm, near, solutions[s]));
    EXPECT_EQ(inverse.solve(cameraPose(arm, near), near).empty(), false);
    EXPECT_LT(jointTravel_s(arm, near, inverse.solve(cameraPose(arm, near), near).front()), 1e-5);
  }
  EXPECT_GT(several, 100);
}

INSTANTIATE_TEST_SUITE_P(Robots, BothArms, testing::Values("smart_six", "ur5"));

TEST(InverseKinematics, ClosedFormOnlyForASphericalWrist) {
  EXPECT_TRUE(InverseKinematics(loadRobot("smart_six")).analytic());
  EXPECT_FALSE(InverseKinematics(loadRobot("ur5")).analytic());
}

/// What the closed form finds, the numeric search from many starts finds no more of.
TEST(InverseKinematics, ClosedFormIsComplete) {
  const RobotModel arm = loadRobot("smart_six");
  RobotModel bent = arm;  // 0.1 um off: no closed form, practically the same arm
  bent.joints[5].T_parent_joint = Eigen::Translation3d(1e-7, 0.0, 0.0) * bent.joints[5].T_parent_joint;
  IkConfig many;
  many.seeds = 200;
  const InverseKinematics closed(arm), numeric(bent, many);
  ASSERT_TRUE(closed.analytic());
  ASSERT_FALSE(numeric.analytic());
  std::mt19937_64 random(5);
  int compared = 0;
  for (int n = 0; n < 30; ++n) {
    const JointVector q = randomConfiguration(arm, random);
    if (std::abs(q[4]) < 0.1) continue;  // stretched: a whole line of solutions
    const auto all = closed.solve(cameraPose(arm, q), q);
    for (const JointVector& found : numeric.solve(cameraPose(arm, q), q)) {
      double nearest = 1e9;
      for (const JointVector& known : all) nearest = std::min(nearest, difference(known, found));
      EXPECT_LT(nearest, 1e-3) << found.transpose();
      ++compared;
    }
  }
  EXPECT_GT(compared, 30);
}

TEST(InverseKinematics, StretchedWristKeepsItsFirstJoint) {
  const RobotModel arm = loadRobot("smart_six");
  JointVector q(6);
  q << 0.3, 0.2, -1.2, 0.7, 0.0, -0.4;
  const auto solutions = InverseKinematics(arm).solve(cameraPose(arm, q), q);
  ASSERT_FALSE(solutions.empty());
  EXPECT_LT((solutions.front() - q).cwiseAbs().maxCoeff(), 1e-6);
}

/// The wrist over the first axis: any turn of the base does, but not every one leaves the wrist within its
/// limits.
TEST(InverseKinematics, WristOnTheFirstAxisIsSolvedFromAnywhere) {
  const RobotModel arm = loadRobot("smart_six");
  const InverseKinematics inverse(arm);
  // Axis 2 such that the wrist's centre stands over the base, by bisection.
  JointVector q(6);
  q << 2.9, 0.0, -2.2, 0.4, 0.9, -0.3;
  double low = arm.joints[1].lower, high = 0.5;
  const auto wristAhead = [&](double axis_2) {
    JointVector p = q;
    p[0] = 0.0;
    p[1] = axis_2;
    return wristCentre(arm, p).x();
  };
  ASSERT_LT(wristAhead(low) * wristAhead(high), 0.0);
  for (int i = 0; i < 100; ++i) {
    q[1] = (low + high) / 2;
    (wristAhead(low) * wristAhead(q[1]) > 0.0 ? low : high) = q[1];
  }
  const Pose target = cameraPose(arm, q);
  for (double axis_1 = -2.9; axis_1 < 2.9; axis_1 += 0.37) {
    JointVector near = q;
    near[0] = axis_1;
    const auto solutions = inverse.solve(target, near);
    ASSERT_GE(solutions.size(), 8u) << axis_1;
    for (const JointVector& s : solutions) EXPECT_LE(positionError(cameraPose(arm, s), target), 1e-6);
  }
}

TEST(InverseKinematics, NothingBeyondReachOrForNaN) {
  for (const char* name : {"smart_six", "ur5"}) {
    const InverseKinematics inverse(loadRobot(name));
    Pose far = Pose::Identity();
    far.translation() = Eigen::Vector3d(3.0, 0.0, 0.5);
    EXPECT_TRUE(inverse.solve(far, JointVector::Zero(6)).empty()) << name;
    far.translation().x() = std::nan("");
    EXPECT_TRUE(inverse.solve(far, JointVector::Zero(6)).empty()) << name;
  }
}

TEST(InverseKinematics, ConfigNamesFieldAndValue) {
  IkConfig config;
  config.tolerance = 0.0;
  EXPECT_THROW(InverseKinematics(loadRobot("ur5"), config), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
