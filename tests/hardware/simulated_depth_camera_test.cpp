#include "hardware/simulated_depth_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>

namespace vantage {
namespace {

using Eigen::Vector3d;

SceneFile sceneOf(const std::string& toml) {
  return parseScene(toml, "test.toml");
}

/// A wall at x = `distance` before a camera at the origin that looks along +x.
SceneFile wallAt(double distance) {
  return sceneOf("[[solid]]\nkind='box'\nposition_m=[" + std::to_string(distance + 0.5) +
                 ",0,-50]\nsize_m=[1,100,100]\n");
}
const Pose kAlongX = lookAlong(Vector3d::Zero(), Vector3d::UnitX());

SimulatedCameraConfig exactCamera() {
  SimulatedCameraConfig config;
  config.sensor.noise_at_1m_m = 0.0;
  config.sensor.emitter_shadow = false;
  return config;
}

bool sameBits(const DepthImage& a, const DepthImage& b) {
  return a.depth_m.size() == b.depth_m.size() && !a.empty() &&
         std::memcmp(a.depth_m.data(), b.depth_m.data(), a.depth_m.size() * sizeof(float)) == 0;
}

TEST(SimulatedDepthCamera, SeesAPlaneAtItsDepth) {
  SimulatedDepthCamera camera(wallAt(2.0), exactCamera());
  const DepthFrame frame = *camera.capture(kAlongX, 0);
  ASSERT_EQ(frame.depth.depth_m.size(), 512u * 424u);
  EXPECT_TRUE(frame.T_world_camera.isApprox(kAlongX));
  for (const float depth : frame.depth.depth_m) ASSERT_NEAR(depth, 2.0f, 2e-6f);
}

TEST(SimulatedDepthCamera, SeesATiltedPlaneAtItsDepth) {
  SimulatedDepthCamera camera(sceneOf("[[solid]]\nkind='box'\nposition_m=[0,0,-1]\nsize_m=[100,100,1]\n"),
                              exactCamera());
  const Pose pose = lookAlong({0.3, -0.2, 1.0}, {0.5, 0.7, -1.0}, 0.4);
  const DepthFrame frame = *camera.capture(pose, 0);
  int valid = 0;
  for (int v = 0; v < 424; v += 7)
    for (int u = 0; u < 512; u += 7) {
      const Vector3d ray = pose.linear() * camera.model().ray(u, v);
      const double depth = -1.0 / ray.z();
      if (ray.z() >= 0 || depth > 8.0) {
        EXPECT_TRUE(std::isnan(frame.depth.at(u, v)));
        continue;
      }
      ++valid;
      ASSERT_NEAR(frame.depth.at(u, v), depth, 1e-5 * depth);
    }
  EXPECT_GT(valid, 2000);
}

TEST(SimulatedDepthCamera, SeesASphereWithinTheFacetsOfItsMesh) {
  SimulatedDepthCamera camera(sceneOf("[[solid]]\nkind='sphere'\nposition_m=[1,0,0]\nradius_m=0.2\n"),
                              exactCamera());
  const DepthFrame frame = *camera.capture(kAlongX, 0);
  int hits = 0, compared = 0;
  for (int v = 0; v < 424; ++v)
    for (int u = 0; u < 512; ++u) {
      const Vector3d ray = camera.model().ray(u, v);  // |z ray - c| = r, c = (0, 0, 1)
      const double a = ray.squaredNorm(), discriminant = 1.0 - a * (1.0 - 0.04);
      hits += DepthImage::valid(frame.depth.at(u, v));
      if (discriminant < 0) {
        ASSERT_TRUE(std::isnan(frame.depth.at(u, v)));
      } else if (discriminant > 0.01) {  // away from the grazing rim
        ++compared;
        ASSERT_NEAR(frame.depth.at(u, v), (1.0 - std::sqrt(discriminant)) / a, 0.0005);
      }
    }
  EXPECT_GT(compared, 10000);
  EXPECT_NEAR(hits, M_PI * std::pow(365 * 0.2 / std::sqrt(1 - 0.04), 2), 0.01 * hits);
}

TEST(SimulatedDepthCamera, LimitsTheRangeAlongTheAxis) {
  SimulatedCameraConfig config = exactCamera();
  const auto valid = [&](double distance) {
    SimulatedDepthCamera camera(wallAt(distance), config);
    int count = 0;
    const DepthFrame frame = *camera.capture(kAlongX, 0);
    for (const float depth : frame.depth.depth_m) count += DepthImage::valid(depth);
    return count;
  };
  EXPECT_EQ(valid(0.49), 0);
  EXPECT_EQ(valid(0.51), 512 * 424);
  EXPECT_EQ(valid(7.99), 512 * 424);
  EXPECT_EQ(valid(8.01), 0);
  config.sensor.noise_at_1m_m = 0.002;  // noise carries some measurements over the limit
  EXPECT_NEAR(valid(8.0), 512 * 424 / 2, 2000);
}

TEST(SimulatedDepthCamera, InvalidWhereTheRayLeavesTheScene) {
  SimulatedDepthCamera camera(sceneOf("[[solid]]\nkind='box'\nposition_m=[-2,0,0]\nsize_m=[1,1,1]\n"),
                              exactCamera());
  const DepthFrame frame = *camera.capture(kAlongX, 0);
  ASSERT_FALSE(frame.depth.empty());
  for (const float depth : frame.depth.depth_m) ASSERT_TRUE(std::isnan(depth));
}

TEST(SimulatedDepthCamera, NoiseGrowsWithTheSquareOfDepth) {
  for (const double distance : {1.0, 2.5}) {
    SimulatedCameraConfig config = exactCamera();
    config.sensor.noise_at_1m_m = 0.002;
    SimulatedDepthCamera camera(wallAt(distance), config);
    const DepthFrame frame = *camera.capture(kAlongX, 3);
    double sum = 0, squares = 0, fourth = 0, neighbours = 0;
    const auto n = static_cast<double>(frame.depth.depth_m.size());
    double previous = 0;
    for (const float depth : frame.depth.depth_m) {
      const double x = (depth - distance) / (0.002 * distance * distance);
      sum += x, squares += x * x, fourth += x * x * x * x, neighbours += x * previous;
      previous = x;
    }
    EXPECT_NEAR(sum / n, 0.0, 0.01);
    EXPECT_NEAR(std::sqrt(squares / n), 1.0, 0.01);
    EXPECT_NEAR(fourth / n, 3.0, 0.1);       // as a Gaussian's
    EXPECT_NEAR(neighbours / n, 0.0, 0.01);  // pixels are independent
  }
}

TEST(SimulatedDepthCamera, SameSeedAndIndexGiveTheSameFrameForAnyThreadCount) {
  const SceneFile scene = loadScene("tabletop");
  const Pose pose = lookAt({0, -0.9, 0.6}, {0, 0, 0.1});
  SimulatedCameraConfig config;
  const auto capture = [&](std::size_t threads, std::uint64_t index) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return SimulatedDepthCamera(scene, config).capture(pose, index)->depth;
  };
  const DepthImage one = capture(1, 5);
  EXPECT_TRUE(sameBits(one, capture(2, 5)));
  EXPECT_TRUE(sameBits(one, capture(4, 5)));
  EXPECT_FALSE(sameBits(one, capture(2, 6)));
  config.seed = 2;
  EXPECT_FALSE(sameBits(one, capture(2, 5)));
}

TEST(SimulatedDepthCamera, ShadowHasTheWidthOfItsGeometry) {
  // A plate at 1 m before a wall at 2 m: the shadow lies to the right, f * offset * (1/z1 - 1/z2) pixels
  // wide.
  const SceneFile scene = sceneOf(
      "[[solid]]\nkind='box'\nposition_m=[2.5,0,-50]\nsize_m=[1,100,100]\n"
      "[[solid]]\nkind='box'\nposition_m=[1.0005,0,-50]\nsize_m=[0.001,0.2,100]\n");
  for (const double offset : {0.08, 0.133, -0.08}) {
    SimulatedCameraConfig config = exactCamera();
    config.sensor.emitter_shadow = true;
    config.sensor.emitter_offset_m = offset;
    SimulatedDepthCamera camera(scene, config);
    const DepthFrame frame = *camera.capture(kAlongX, 0);
    const double width = 365 * std::abs(offset) * (1.0 / 1.0 - 1.0 / 2.0);
    for (int v = 0; v < 424; v += 53) {
      int invalid = 0;
      double middle = 0;
      for (int u = 0; u < 512; ++u)
        if (!DepthImage::valid(frame.depth.at(u, v))) ++invalid, middle += u;
      ASSERT_NEAR(invalid, width, 1.01);
      // Beside the plate's edge, on the side away from the emitter.
      const double edge = 255.5 + (offset > 0 ? 1 : -1) * 365 * 0.1;
      EXPECT_NEAR(middle / invalid, edge + (offset > 0 ? 1 : -1) * width / 2, 1.0);
    }
  }
}

TEST(SimulatedDepthCamera, EmitterInTheCameraCastsNoShadow) {
  SimulatedCameraConfig config = exactCamera();
  const SceneFile scene = loadScene("tabletop");
  const Pose pose = lookAt({0, -0.9, 0.6}, {0, 0, 0.1});
  const DepthImage without = SimulatedDepthCamera(scene, config).capture(pose, 0)->depth;
  config.sensor.emitter_shadow = true;
  config.sensor.emitter_offset_m = 0.0;
  EXPECT_TRUE(sameBits(without, SimulatedDepthCamera(scene, config).capture(pose, 0)->depth));
}

TEST(SimulatedDepthCamera, RefusesAnImpossibleConfiguration) {
  SimulatedCameraConfig config;
  config.sensor.noise_at_1m_m = -1;
  EXPECT_THROW(SimulatedDepthCamera(wallAt(1), config), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
