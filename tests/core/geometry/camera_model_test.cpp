#include "core/geometry/camera_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace vantage {
namespace {

double degrees(double rad) {
  return rad * 180 / std::numbers::pi;
}

TEST(PinholeCamera, DefaultsSeeTheAnglesOfTheSpecification) {
  const PinholeCamera camera;
  EXPECT_NEAR(degrees(camera.horizontalFov_rad()), 70.1, 0.05);
  EXPECT_NEAR(degrees(camera.verticalFov_rad()), 60.3, 0.05);
}

TEST(PinholeCamera, ProjectionUndoesTheRay) {
  const PinholeCamera camera;
  for (const auto& [u, v] : {std::pair{0.0, 0.0}, {511.0, 423.0}, {100.25, 37.5}}) {
    const Eigen::Vector2d back = camera.project(2.5 * camera.ray(u, v));
    EXPECT_NEAR(back.x(), u, 1e-9);
    EXPECT_NEAR(back.y(), v, 1e-9);
  }
}

TEST(PinholeCamera, ReducedKeepsTheFieldOfViewAndPixelsInTheMiddleOfTheirBlocks) {
  const PinholeCamera camera, quarter = camera.reduced(4);
  EXPECT_EQ(quarter.width, 128);
  EXPECT_EQ(quarter.height, 106);
  EXPECT_NEAR(quarter.horizontalFov_rad(), camera.horizontalFov_rad(), 1e-12);
  EXPECT_NEAR(quarter.verticalFov_rad(), camera.verticalFov_rad(), 1e-12);
  // Pixel (5, 7) stands for the columns 20..23 and the rows 28..31.
  EXPECT_TRUE(quarter.ray(5, 7).isApprox(camera.ray(21.5, 29.5), 1e-12));
  EXPECT_EQ(quarter.min_range_m, camera.min_range_m);
  EXPECT_EQ(quarter.max_range_m, camera.max_range_m);
}

TEST(PinholeCamera, ReducedRoundsUpAndFactorOneChangesNothing) {
  PinholeCamera camera;
  camera.width = 13;
  camera.height = 9;
  EXPECT_EQ(camera.reduced(4).width, 4);
  EXPECT_EQ(camera.reduced(4).height, 3);
  EXPECT_EQ(camera.reduced(1).fx, camera.fx);
  EXPECT_EQ(camera.reduced(1).cx, camera.cx);
  EXPECT_THROW(camera.reduced(0), std::invalid_argument);
}

TEST(PinholeCamera, FromFieldOfViewHasIt) {
  const PinholeCamera camera = cameraFromFov(640, 480, 57 * std::numbers::pi / 180);
  EXPECT_NEAR(degrees(camera.horizontalFov_rad()), 57.0, 1e-9);
  EXPECT_EQ(camera.fx, camera.fy);
  EXPECT_EQ(camera.cx, 319.5);
}

TEST(PinholeCamera, ValidateNamesTheFieldAndTheValue) {
  PinholeCamera camera;
  EXPECT_NO_THROW(camera.validate());
  camera.width = 9000;
  try {
    camera.validate();
    ADD_FAILURE() << "accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("width"));
    EXPECT_THAT(e.what(), ::testing::HasSubstr("9000"));
  }
  camera = {};
  camera.fx = 0;
  EXPECT_THROW(camera.validate(), std::invalid_argument);
  camera = {};
  camera.max_range_m = camera.min_range_m;
  EXPECT_THROW(camera.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
