#include "viewer/eye.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace vantage {
namespace {

constexpr PictureSize kPicture{800, 500};

std::vector<Eye> someEyes() {
  std::vector<Eye> eyes;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-2.0, 2.0);
  for (int i = 0; i < 20; ++i)
    eyes.push_back({{at(random), at(random), at(random)},
                    {0.1 * at(random), 0.1 * at(random), 5.0 + at(random)},
                    Eigen::Vector3d::UnitX(),
                    0.5});
  for (Eye& eye : eyes) eye.up = Eigen::Vector3d(at(random), at(random), 0.1);
  return eyes;
}

TEST(EyeRay, LeadsBackToItsPixel) {
  for (const Eye& eye : someEyes()) {
    for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(0, 0), {799, 3}, {400, 250}, {120.5, 433.25}}) {
      const EyeRay ray = eyeRay(eye, pixel, kPicture);
      const auto back = pixelOf(eye, ray.origin + 3.7 * ray.direction, kPicture);
      ASSERT_TRUE(back);
      EXPECT_LT((*back - pixel).norm(), 1e-6);
    }
    EXPECT_FALSE(pixelOf(eye, eye.position - (eye.focus - eye.position), kPicture));
  }
}

TEST(EyeRay, FocusIsInTheMiddleAndTheApertureIsVertical) {
  const Eye eye{{0, -2, 0}, {0, 0, 0}, Eigen::Vector3d::UnitZ(), 1.0};
  const auto middle = pixelOf(eye, eye.focus, kPicture);
  ASSERT_TRUE(middle);
  EXPECT_LT((*middle - Eigen::Vector2d(400, 250)).norm(), 1e-9);
  const auto top = pixelOf(eye, {0, 0, 2 * std::tan(0.5)}, kPicture);
  EXPECT_NEAR(top->y(), 0.0, 1e-9);
  EXPECT_GT(pixelOf(eye, {1, 0, 0}, kPicture)->x(), 400.0) << "+x is to the right of who looks along +y";
}

TEST(MovedEyes, OrbitKeepsDistanceFocusAndUprightness) {
  for (const Eye& eye : someEyes()) {
    const Eye turned = orbited(eye, 0.3, -0.2);
    EXPECT_EQ(turned.focus, eye.focus);
    EXPECT_NEAR(turned.distance(), eye.distance(), 1e-9);
    EXPECT_EQ(turned.up, Eigen::Vector3d(Eigen::Vector3d::UnitZ()));
    const Eye above = orbited(eye, 0.0, 10.0);
    const double elevation = std::asin((above.position - above.focus).z() / above.distance());
    EXPECT_LT(elevation, std::numbers::pi / 2 - 0.01);
    EXPECT_GT(elevation, std::numbers::pi / 2 - 0.05);
  }
}

TEST(MovedEyes, OrbitBackAndForthIsNoMove) {
  const Eye eye{{1, -2, 1.5}, {0.2, 0, 0.4}, Eigen::Vector3d::UnitZ(), 0.5};
  const Eye back = orbited(orbited(eye, 0.7, 0.2), -0.7, -0.2);
  EXPECT_LT((back.position - eye.position).norm(), 1e-9);
}

TEST(MovedEyes, PanTakesWhatIsAtTheFocusAlong) {
  for (const Eye& eye : someEyes()) {
    const Eye moved = panned(eye, {37.0, -21.0}, kPicture);
    const auto at = pixelOf(moved, eye.focus, kPicture);
    ASSERT_TRUE(at);
    EXPECT_LT((*at - Eigen::Vector2d(437, 229)).norm(), 1e-6);
  }
}

TEST(MovedEyes, ZoomKeepsWhatIsUnderTheCursor) {
  for (const Eye& eye : someEyes()) {
    const Eigen::Vector2d cursor(650, 90);
    const EyeRay ray = eyeRay(eye, cursor, kPicture);
    const Eigen::Vector3d forward = (eye.focus - eye.position).normalized();
    const Eigen::Vector3d under = ray.origin + ray.direction * (eye.distance() / ray.direction.dot(forward));
    const Eye nearer = zoomed(eye, 1.6, cursor, kPicture);
    EXPECT_NEAR(nearer.distance(), eye.distance() / 1.6, 1e-9);
    const auto at = pixelOf(nearer, under, kPicture);
    ASSERT_TRUE(at);
    EXPECT_LT((*at - cursor).norm(), 1e-6);
  }
  Eye eye;
  for (int i = 0; i < 200; ++i) eye = zoomed(eye, 2.0, {1, 1}, kPicture);
  EXPECT_GE(eye.distance(), 0.0099);
}

TEST(EyeOfView, SeesTheCamerasPixelsWhereTheCameraDoes) {
  const PinholeCamera camera;  // centred
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(0.4, -0.9, 0.7);
  pose.rotate(Eigen::AngleAxisd(0.8, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()));
  const Eye eye = eyeOfView(camera, pose, 0.6);
  const PictureSize picture{camera.width, camera.height};
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(0, 0), {511, 10}, {255.5, 211.5}, {30, 400}}) {
    const auto at = pixelOf(eye, pose * (1.3 * camera.ray(pixel.x(), pixel.y())), picture);
    ASSERT_TRUE(at);
    // Pixel centres are integers for the camera; pictures count from the corner.
    EXPECT_LT((*at - pixel - Eigen::Vector2d(0.5, 0.5)).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace vantage
