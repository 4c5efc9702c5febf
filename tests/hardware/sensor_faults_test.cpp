#include "hardware/sensor_faults.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "hardware/simulated_depth_camera.h"

namespace vantage {
namespace {

using Eigen::Vector3d;
constexpr float kNone = std::numeric_limits<float>::infinity();

/// A row with an object of 1 m at columns 10 to 19 before a wall at 2.5 m; what is right of it is dark.
struct Row {
  std::vector<float> depth = std::vector<float>(60, 2.5f);
  std::vector<std::uint8_t> lit = std::vector<std::uint8_t>(60, 1);
  Row() {
    std::fill_n(depth.begin() + 10, 10, 1.0f);
    std::fill_n(lit.begin() + 20, 15, std::uint8_t{0});
  }
};

TEST(CorruptShadow, DarkPixelsMixBothSidesOrAreOffByThreeToThirtyCentimetres) {
  int mixed = 0, biased = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Row row;
    row.depth[25] = kNone;
    corruptShadow(row.depth, row.lit, true, seed);
    const Row before;
    for (std::size_t u = 0; u < row.depth.size(); ++u) {
      if (u == 25) {
        EXPECT_EQ(row.depth[u], kNone) << "nothing is there";
        continue;
      }
      if (row.lit[u]) {
        EXPECT_EQ(row.depth[u], before.depth[u]) << u;
        continue;
      }
      const float off = std::abs(row.depth[u] - 2.5f);
      const bool is_bias = off >= 0.03f - 1e-5f && off <= 0.30f + 1e-5f;
      const bool is_mixture = row.depth[u] >= 1.0f && row.depth[u] <= 2.5f;
      EXPECT_TRUE(is_bias || is_mixture) << row.depth[u];
      (off > 0.31f ? mixed : biased)++;
    }
  }
  EXPECT_GT(mixed, 800) << "of 2800";
  EXPECT_GT(biased, 1200);
}

TEST(CorruptShadow, TheForegroundIsOnTheEmittersSide) {
  Row row;
  std::fill_n(row.lit.begin(), 60, std::uint8_t{1});
  std::fill_n(row.lit.begin(), 10, std::uint8_t{0});  // left of the object: dark for an emitter on the right
  Row left = row;
  corruptShadow(row.depth, row.lit, false, 3);
  corruptShadow(left.depth, left.lit, true, 3);
  const auto nearer = [](const Row& r) {
    return std::count_if(r.depth.begin(), r.depth.begin() + 10, [](float z) { return z < 2.19f; });
  };
  EXPECT_GT(nearer(row), 0);
  EXPECT_EQ(nearer(left), 0) << "there is nothing before it to mix with";
}

TEST(CorruptShadow, BelongsToThePixelAndItsSeed) {
  Row a, b, c;
  corruptShadow(a.depth, a.lit, true, 7);
  corruptShadow(b.depth, b.lit, true, 7);
  corruptShadow(c.depth, c.lit, true, 8);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_NE(a.depth, c.depth);
}

TEST(IsStep, ComparesWithFourNeighbours) {
  const std::vector<float> flat(5, 1.0f);
  std::vector<float> row = flat, other = flat;
  row[2] = 1.005f;
  for (std::size_t u = 0; u < 5; ++u) EXPECT_FALSE(isStep(row, flat, flat, u)) << "5 mm are none";
  row[2] = 1.02f;
  EXPECT_TRUE(isStep(row, {}, {}, 1));
  EXPECT_TRUE(isStep(row, {}, {}, 2));
  EXPECT_FALSE(isStep(row, {}, {}, 4));
  other[4] = kNone;
  EXPECT_TRUE(isStep(flat, other, {}, 4));
  EXPECT_TRUE(isStep(flat, {}, other, 4));
  EXPECT_FALSE(isStep(other, flat, flat, 4)) << "nothing is there";
}

/// A bar of 20 cm at 1 m before a wall at 2.5 m.
SceneFile barBeforeWall() {
  SceneFile scene;
  const auto add = [&](const Vector3d& size, const Vector3d& at) {
    Pose pose = Pose::Identity();
    pose.translation() = at;
    scene.solids.emplace_back(makeBox(size), pose, SolidRole::Other, "box", Solid::Color{});
  };
  add({0.2, 0.2, 4.0}, {1.1, 0.0, -2.0});
  add({0.2, 20.0, 20.0}, {2.6, 0.0, -10.0});
  return scene;
}

DepthImage imageOf(bool shadow, bool faults, std::uint64_t index = 0) {
  SimulatedCameraConfig config;
  config.sensor.noise_at_1m_m = 0.0;
  config.sensor.emitter_shadow = shadow;
  config.sensor.faults = faults;
  return SimulatedDepthCamera(barBeforeWall(), config)
      .capture(lookAlong(Vector3d::Zero(), Vector3d::UnitX()), index)
      ->depth;
}

TEST(SimulatedDepthCamera, WithFaultsADarkPixelHasAWrongDepthInsteadOfNone) {
  const DepthImage ideal = imageOf(true, false), all = imageOf(false, false), faulty = imageOf(true, true);
  int dark = 0, wrong = 0;
  for (std::size_t i = 0; i < all.depth_m.size(); ++i) {
    if (!DepthImage::valid(all.depth_m[i]) || DepthImage::valid(ideal.depth_m[i])) continue;
    ++dark;
    EXPECT_TRUE(DepthImage::valid(faulty.depth_m[i]));
    wrong += std::abs(faulty.depth_m[i] - all.depth_m[i]) > 0.02f;
  }
  EXPECT_GT(dark, 5000);
  EXPECT_GT(wrong, 0.9 * dark);
}

TEST(SimulatedDepthCamera, WithFaultsPixelsAtStepsMixBothSides) {
  const DepthImage all = imageOf(false, false), faulty = imageOf(false, true);
  int between = 0;
  for (int v = 0; v < all.height; ++v)
    for (int u = 1; u + 1 < all.width; ++u) {
      if (faulty.at(u, v) == all.at(u, v)) continue;
      EXPECT_TRUE(std::abs(all.at(u - 1, v) - all.at(u + 1, v)) > 1.0f)
          << u << " " << v << ": only at the bar's sides";
      between += faulty.at(u, v) > 1.1f && faulty.at(u, v) < 2.4f;
    }
  EXPECT_GE(between, all.height) << "one a row at least";
}

TEST(SimulatedDepthCamera, FaultsAreTheSameInEveryFrame) {
  const DepthImage first = imageOf(true, true, 0), later = imageOf(true, true, 5);
  for (std::size_t i = 0; i < first.depth_m.size(); ++i)
    if (DepthImage::valid(first.depth_m[i])) {
      ASSERT_EQ(first.depth_m[i], later.depth_m[i]);
    }
}

}  // namespace
}  // namespace vantage
