#include "core/geometry/pose.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace vantage {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<Eigen::Vector3d> randomAxes(int count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Eigen::Vector3d> axes;
  for (int n = 0; n < count; ++n) axes.emplace_back(unit(random), unit(random), unit(random));
  return axes;
}

TEST(LookAlong, OpticalAxisFollowsTheDirectionAndTheImageIsUpright) {
  const Eigen::Vector3d eye(1, 2, 3);
  for (const Eigen::Vector3d& axis : randomAxes(100)) {
    const Pose pose = lookAlong(eye, axis);
    EXPECT_TRUE(isRigid(pose.matrix(), 1e-12));
    EXPECT_EQ(pose.translation(), eye);
    EXPECT_NEAR(pose.linear().col(2).dot(axis.normalized()), 1.0, 1e-12);
    EXPECT_NEAR(pose.linear()(2, 0), 0.0, 1e-12) << "image x axis is horizontal";
    EXPECT_LT(pose.linear()(2, 1), 0.0) << "image y axis points down";
  }
}

TEST(LookAlong, VerticalViewsTakeTheWorldXAxis) {
  for (const double up : {1.0, -1.0}) {
    const Pose pose = lookAlong({0, 0, 1}, {0, 0, up});
    EXPECT_EQ(pose.linear().col(0), Eigen::Vector3d::UnitX());
    EXPECT_TRUE(isRigid(pose.matrix(), 1e-12));
  }
}

TEST(LookAlong, RollTurnsTheImageAboutTheOpticalAxisFromXTowardY) {
  for (const Eigen::Vector3d& axis : randomAxes(20)) {
    const Pose upright = lookAlong({0, 0, 0}, axis), rolled = lookAlong({0, 0, 0}, axis, 0.3);
    EXPECT_NEAR(angleBetween(upright, rolled), 0.3, 1e-9);
    EXPECT_TRUE(rolled.linear().col(2).isApprox(upright.linear().col(2), 1e-12));
    EXPECT_NEAR(rolled.linear().col(0).dot(upright.linear().col(1)), std::sin(0.3), 1e-12);
  }
}

TEST(LookAlong, RefusesAnAxisWithoutLength) {
  EXPECT_THROW(lookAlong({0, 0, 0}, {0, 0, 0}), std::invalid_argument);
  EXPECT_THROW(lookAt({1, 2, 3}, {1, 2, 3}), std::invalid_argument);
}

TEST(LookAt, TargetLiesOnTheOpticalAxis) {
  const Eigen::Vector3d eye(0.4, -0.8, 0.6), target(0.1, 0.2, 0.05);
  const Eigen::Vector3d seen = lookAt(eye, target, 0.7).inverse() * target;
  EXPECT_NEAR(seen.x(), 0.0, 1e-12);
  EXPECT_NEAR(seen.y(), 0.0, 1e-12);
  EXPECT_NEAR(seen.z(), (target - eye).norm(), 1e-12);
}

TEST(Pose, OrientationSurvivesARoundTripWithPositiveW) {
  for (const Eigen::Vector3d& axis : randomAxes(50)) {
    const Pose pose = lookAlong({1, 0, -1}, axis, 5 * axis.x());
    const Eigen::Quaterniond q = orientationOf(pose);
    EXPECT_GE(q.w(), 0.0);
    EXPECT_NEAR(q.norm(), 1.0, 1e-12);
    const Pose back = makePose(pose.translation(), Eigen::Quaterniond(3 * q.coeffs()));
    EXPECT_TRUE(back.isApprox(pose, 1e-12));
  }
}

TEST(Pose, IsNearWithinBothLimits) {
  const Pose pose = lookAlong({1.0, 2.0, 3.0}, {0.0, 1.0, 0.0});
  const Pose moved = lookAlong({1.0, 2.1, 3.0}, {0.0, 1.0, 0.0}, 0.2);
  EXPECT_TRUE(isNear(pose, pose, 0.0, 1e-7));
  EXPECT_TRUE(isNear(pose, moved, 0.11, 0.21));
  EXPECT_FALSE(isNear(pose, moved, 0.09, 0.21));
  EXPECT_FALSE(isNear(pose, moved, 0.11, 0.19));
}

TEST(Pose, AngleBetweenIsGeodesic) {
  const Pose pose = lookAlong({0, 0, 0}, {1, 2, 3});
  EXPECT_NEAR(angleBetween(pose, pose), 0.0, 1e-7);
  const Pose half = pose * Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitY());
  EXPECT_NEAR(angleBetween(pose, half), kPi, 1e-7);
}

TEST(IsRigid, AcceptsRotationsAndRefusesEverythingElse) {
  Eigen::Matrix4d m = lookAlong({1, 2, 3}, {1, 1, 0}).matrix();
  EXPECT_TRUE(isRigid(m));
  Eigen::Matrix4d bad = m;
  bad.topLeftCorner<3, 3>() *= 1.01;
  EXPECT_FALSE(isRigid(bad)) << "scaled";
  bad = m;
  bad.col(0) *= -1;
  EXPECT_FALSE(isRigid(bad)) << "mirrored";
  bad = m;
  bad(3, 0) = 0.5;
  EXPECT_FALSE(isRigid(bad)) << "projective";
  bad = m;
  bad(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(isRigid(bad)) << "not a number";
  EXPECT_FALSE(isRigid(Eigen::Matrix4d::Zero()));
}

}  // namespace
}  // namespace vantage
