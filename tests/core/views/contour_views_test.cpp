#include "core/views/contour_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/core/perception/half_observed.h"

namespace vantage {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

ContourPoint examplePoint() {
  return {{0.5, 0.0, 0.1}, {1.0, 0.0, 0.0}, 3};
}

std::vector<ContourPoint> randomPoints(int count) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<ContourPoint> points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d p(normal(random), normal(random), normal(random));
    const Eigen::Vector3d n(normal(random), normal(random), normal(random));
    points.push_back({p, n.normalized(), 1});
  }
  points.push_back({{0, 0, 0}, {0, 0, 1}, 1});
  points.push_back({{0, 0, 0}, {0, 0, -1}, 1});
  return points;
}

void expectVector(const Eigen::Vector3d& v, const Eigen::Vector3d& expected) {
  EXPECT_LT((v - expected).norm(), 1e-12) << v.transpose();
}

TEST(ContourViews, ReferenceBoxGives480PosesAndTheLargerBox1120) {
  const auto count = [](const TsdfVolume& volume) {
    return contourViews(extractContours(volume, {}).points, {}).size();
  };
  EXPECT_EQ(count(test::referenceBox()), 480u);
  EXPECT_EQ(count(test::halfObservedBox(70, 60, 40, 18, 51, 20, 39)), 1120u);
}

TEST(ContourViews, FirstPoseOfTheExampleLooksBackAlongTheNormal) {
  const auto views = contourViews({examplePoint()}, {});
  ASSERT_EQ(views.size(), 40u);
  expectVector(views[0].T_world_camera.translation(), {1.3, 0.0, 0.1});
  expectVector(views[0].T_world_camera.linear().col(2), {-1.0, 0.0, 0.0});
}

TEST(ContourViews, All40AxesPassThroughThePointAt80Centimetres) {
  for (const ContourPoint& point : randomPoints(20)) {
    const auto views = contourViews({point}, {});
    ASSERT_EQ(views.size(), 40u);
    for (const CandidateView& view : views) {
      const Pose& T = view.T_world_camera;
      expectVector(T.translation() + 0.8 * T.linear().col(2), point.position_m);
      EXPECT_NEAR((T.translation() - point.position_m).norm(), 0.8, 1e-12);
      EXPECT_TRUE(isRigid(T.matrix(), 1e-12));
    }
  }
}

TEST(ContourViews, TiltedAxesStand15DegreesFromTheNormalAndOppositeOnes30Apart) {
  for (const ContourPoint& point : randomPoints(20)) {
    const auto positions = contourViewPositions({point}, {});
    ASSERT_EQ(positions.size(), 5u);
    const auto axis = [&](int i) { return Eigen::Vector3d(positions[i].T_world_camera.linear().col(2)); };
    for (int i = 1; i < 5; ++i) EXPECT_NEAR(std::acos(axis(i).dot(axis(0))) / kDegree, 15.0, 1e-6);
    EXPECT_NEAR(std::acos(axis(1).dot(axis(3))) / kDegree, 30.0, 1e-6);
    EXPECT_NEAR(std::acos(axis(2).dot(axis(4))) / kDegree, 30.0, 1e-6);
    // Neighbouring azimuths are 90 deg apart: the parts across the normal are at right angles.
    EXPECT_NEAR((axis(1) - axis(3)).dot(axis(2) - axis(4)), 0.0, 1e-12);
    // 0.209 m shift of the sensor at 0.8 m (D-B6).
    EXPECT_NEAR(0.8 * (axis(1) - axis(0)).norm(), 0.209, 1e-3);
  }
}

TEST(ContourViews, AzimuthZeroLiesAlongTheImageXAxisOfRollZero) {
  const auto positions = contourViewPositions({examplePoint()}, {});
  const Eigen::Matrix3d image = positions[0].T_world_camera.linear();
  const Eigen::Vector3d p = examplePoint().position_m;
  for (int i = 1; i < 5; ++i) {
    const Eigen::Vector3d offset = positions[i].T_world_camera.translation() - p;
    const double azimuth = std::atan2(offset.dot(image.col(1)), offset.dot(image.col(0)));
    EXPECT_NEAR(std::remainder(azimuth - (i - 1) * std::numbers::pi / 2, 2 * std::numbers::pi), 0.0, 1e-9);
  }
}

TEST(ContourViews, ImageXAxisIsHorizontalAtRollZeroAndWorldXForVerticalViews) {
  for (const ViewPosition& position : contourViewPositions(randomPoints(20), {})) {
    EXPECT_NEAR(position.T_world_camera.linear()(2, 0), 0.0, 1e-9);
  }
  const auto down = contourViewPositions({{{0, 0, 0}, {0, 0, 1}, 1}}, {});
  expectVector(down[0].T_world_camera.linear().col(0), {1, 0, 0});
}

TEST(ContourViews, RollsTurnTheImageIn45DegreeStepsFromXTowardY) {
  const ContourViewConfig config;
  const auto position = contourViewPositions({examplePoint()}, config)[0];
  for (int roll = 0; roll < 8; ++roll) {
    const Pose pose = rolledPose(position, roll, config);
    const Pose expected = lookAlong({1.3, 0.0, 0.1}, {-1.0, 0.0, 0.0}, roll * 45.0 * kDegree);
    EXPECT_LT((pose.matrix() - expected.matrix()).norm(), 1e-12) << roll;
  }
}

TEST(ContourViews, QuarterTurnsAreExact) {
  const ContourViewConfig config;
  const auto position = contourViewPositions(randomPoints(1), config)[0];
  const Eigen::Matrix3d R = position.T_world_camera.linear();
  EXPECT_EQ(rolledPose(position, 0, config).linear(), R);
  EXPECT_EQ(rolledPose(position, 2, config).linear().col(0), R.col(1));
  EXPECT_EQ(rolledPose(position, 4, config).linear().col(0), -R.col(0));
  EXPECT_EQ(rolledPose(position, 6, config).linear().col(0), -R.col(1));
}

TEST(ContourViews, IdsAreDenseAndSayPointDistanceDirectionAndRoll) {
  ContourViewConfig config;
  config.distances_m = {0.6, 0.8, 1.0};
  config.rolls = 4;
  const auto points = randomPoints(3);
  const auto views = contourViews(points, config);
  const auto positions = contourViewPositions(points, config);
  ASSERT_EQ(config.posesPerPoint(), 60);
  ASSERT_EQ(views.size(), points.size() * 60);
  for (std::uint32_t id = 0; id < views.size(); ++id) {
    EXPECT_EQ(views[id].id, id);
    const std::uint32_t roll = id % 4, place = id / 4, distance = place / 5 % 3, point = place / 15;
    EXPECT_EQ(views[id].group, point);
    EXPECT_EQ(positions[place].group, point);
    EXPECT_EQ(positions[place].first_id, id - roll);
    const double expected = config.distances_m[distance];
    EXPECT_NEAR((views[id].T_world_camera.translation() - points[point].position_m).norm(), expected, 1e-12);
    EXPECT_EQ(views[id].T_world_camera.matrix(), rolledPose(positions[place], roll, config).matrix());
  }
}

TEST(ContourViews, PoseCountsAreMultiplesOf40) {
  for (int count = 0; count < 5; ++count) {
    const auto views = contourViews(randomPoints(count), {});
    EXPECT_GT(views.size(), 0u);
    EXPECT_EQ(views.size() % 40, 0u);
  }
}

TEST(ContourViews, NoPointsGiveNoPoses) {
  EXPECT_TRUE(contourViews({}, {}).empty());
}

TEST(ContourViewConfig, RefusesValuesOutOfRangeByName) {
  const auto message = [](const ContourViewConfig& config) -> std::string {
    try {
      contourViews({}, config);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  ContourViewConfig config;
  config.distances_m = {};
  EXPECT_THAT(message(config), testing::HasSubstr("distances_m"));
  config.distances_m = {0.8, -1.0};
  EXPECT_THAT(message(config), testing::HasSubstr("distances_m"));
  config = {};
  config.rolls = 0;
  EXPECT_THAT(message(config), testing::HasSubstr("rolls"));
  config = {};
  config.tilt_rad = -0.1;
  EXPECT_THAT(message(config), testing::HasSubstr("tilt_rad"));
}

}  // namespace
}  // namespace vantage
