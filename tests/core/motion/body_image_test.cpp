#include "core/motion/body_image.h"

#include <gtest/gtest.h>

#include "io/robot_file.h"

namespace vantage {
namespace {

/// One joint, the camera at its frame, and one body before it that does not move with it.
RobotModel armWith(const LinkShape& shape) {
  RobotModel arm;
  arm.joints.resize(1);
  arm.shapes = {shape};
  return arm;
}

LinkShape shapeAt(ShapeKind kind, const Eigen::Vector3d& at) {
  LinkShape shape;
  shape.kind = kind;
  shape.T_frame_shape.translation() = at;
  shape.size_m = kind == ShapeKind::Cuboid ? Eigen::Vector3d(0.2, 0.4, 0.6) : Eigen::Vector3d::Zero();
  shape.radius_m = kind == ShapeKind::Cuboid ? 0.0 : 0.1;
  shape.length_m = kind == ShapeKind::Cylinder || kind == ShapeKind::Capsule ? 0.5 : 0.0;
  return shape;
}

const JointVector kRest = JointVector::Zero(1);

TEST(BodyImage, ShapesHaveTheDepthOfTheirNearestSide) {
  PinholeCamera camera;
  camera.cx = 255.0;  // a ray straight ahead
  camera.cy = 211.0;
  const Eigen::Vector3d ahead(0.0, 0.0, 2.0);
  const auto depth = [&](ShapeKind kind, double margin) {
    return bodyImage(armWith(shapeAt(kind, ahead)), kRest, camera, margin).at(255, 211);
  };
  EXPECT_NEAR(depth(ShapeKind::Cuboid, 0.0), 2.0 - 0.3, 1e-6);
  EXPECT_NEAR(depth(ShapeKind::Sphere, 0.0), 2.0 - 0.1, 1e-6);
  EXPECT_NEAR(depth(ShapeKind::Cylinder, 0.0), 2.0 - 0.25, 1e-6);
  EXPECT_NEAR(depth(ShapeKind::Capsule, 0.0), 2.0 - 0.35, 1e-6);
  EXPECT_NEAR(depth(ShapeKind::Capsule, 0.02), 2.0 - 0.37, 1e-6);
}

/// Every pixel that is drawn lies on the shape, and its outline is where the shape's is.
TEST(BodyImage, AgreesWithTheShapeEverywhere) {
  const PinholeCamera camera;
  LinkShape shape = shapeAt(ShapeKind::Capsule, {0.3, -0.1, 1.2});
  shape.T_frame_shape.rotate(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()));
  const DepthImage image = bodyImage(armWith(shape), kRest, camera);
  int drawn = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      // Distance of the ray from the capsule's middle line, by a fine search along the ray.
      const Eigen::Vector3d ray = camera.ray(u, v);
      const auto gap = [&](double depth) {
        Eigen::Vector3d p = shape.T_frame_shape.inverse() * (ray * depth);
        p.z() -= std::clamp(p.z(), -shape.length_m / 2, shape.length_m / 2);
        return p.norm() - shape.radius_m;
      };
      const float depth = image.at(u, v);
      if (DepthImage::valid(depth)) {
        ++drawn;
        EXPECT_NEAR(gap(depth), 0.0, 1e-5);
        EXPECT_GT(gap(depth - 1e-3), 0.0);
      } else if (u % 4 == 0 && v % 4 == 0) {
        for (double d = 0.5; d < 2.0; d += 0.01) EXPECT_GT(gap(d), -1e-9);
      }
    }
  EXPECT_GT(drawn, 3000);
}

TEST(BodyImage, WhatHoldsTheCameraOrLiesBehindHidesNothing) {
  const PinholeCamera camera;
  for (const Eigen::Vector3d& at : {Eigen::Vector3d(0, 0, 0.1), Eigen::Vector3d(0, 0, -1)})
    for (const float depth : bodyImage(armWith(shapeAt(ShapeKind::Cuboid, at)), kRest, camera).depth_m)
      EXPECT_TRUE(std::isnan(depth));
}

TEST(BodyImage, RemovesWhatItHidesAndKeepsWhatIsBefore) {
  DepthImage depth(3, 1), body(3, 1);
  depth.depth_m = {2.0f, 0.5f, 2.0f};
  body.depth_m = {1.0f, 1.0f, DepthImage::kInvalid};
  removeBody(depth, body);
  EXPECT_TRUE(std::isnan(depth.depth_m[0]));
  EXPECT_EQ(depth.depth_m[1], 0.5f);
  EXPECT_EQ(depth.depth_m[2], 2.0f);
  EXPECT_THROW(removeBody(depth, DepthImage(2, 1)), std::invalid_argument);
}

TEST(BodyImage, AnEmbeddedArmThatLooksAtItselfSeesItself) {
  const RobotModel arm = loadRobot("smart_six");
  JointVector q(6);
  q << 0.0, -0.8, -2.6, 0.0, -2.2, 0.0;  // the wrist bent back toward the upper arm
  const DepthImage image = bodyImage(arm, q, PinholeCamera());
  EXPECT_GT(std::count_if(image.depth_m.begin(), image.depth_m.end(), DepthImage::valid), 1000);
}

}  // namespace
}  // namespace vantage
