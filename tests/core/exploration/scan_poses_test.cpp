#include <gtest/gtest.h>

#include "core/exploration/explorer.h"

namespace vantage {
namespace {

TEST(InitialScan, LiesOnAnArcOfTheStatedLengthDistanceAndElevation) {
  const ScanConfig config;
  const std::vector<Pose> poses = initialScanPoses(config);
  ASSERT_EQ(poses.size(), 30u);
  double length = 0.0;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    const Eigen::Vector3d offset = poses[n].translation() - config.scene_center_m;
    EXPECT_NEAR(offset.norm(), 1.0, 1e-12);
    EXPECT_NEAR(std::asin(offset.z()), config.initial_elevation_rad, 1e-12);
    EXPECT_NEAR((poses[n].linear().col(2) + offset.normalized()).norm(), 0.0, 1e-12);
    if (n > 0) length += (poses[n].translation() - poses[n - 1].translation()).norm();
  }
  EXPECT_NEAR(length, 0.6, 1e-3);
  // Centred on -y.
  EXPECT_NEAR(poses.front().translation().x(), -poses.back().translation().x(), 1e-12);
  EXPECT_LT(poses[15].translation().y(), -0.8);
}

TEST(InitialScan, OneFrameStandsInTheMiddleOfTheArc) {
  ScanConfig config;
  config.initial_frames = 1;
  const std::vector<Pose> poses = initialScanPoses(config);
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_NEAR(poses[0].translation().x(), 0.0, 1e-12);
}

TEST(TiltedScan, SwingsAboutTheImageXAxisAndKeepsThePosition) {
  const ScanConfig config;
  const Pose view = lookAt({0.3, -0.7, 0.5}, {0, 0, 0.1}, 0.4);
  const std::vector<Pose> poses = tiltedScanPoses(view, config);
  ASSERT_EQ(poses.size(), 15u);
  double largest = 0.0;
  for (const Pose& pose : poses) {
    EXPECT_EQ(pose.translation(), view.translation());
    EXPECT_NEAR(pose.linear().col(0).dot(view.linear().col(0)), 1.0, 1e-12);
    largest = std::max(largest, angleBetween(pose, view));
  }
  EXPECT_NEAR(largest, config.tilt_rad, 0.01 * config.tilt_rad);
  EXPECT_NEAR(angleBetween(poses[0], view), 0.0, 1e-7);
}

TEST(ScanConfig, NamesTheFieldAndRangeOfABadValue) {
  ScanConfig config;
  config.initial_frames = 0;
  try {
    config.validate();
    FAIL() << "0 frames were accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(), "scan.initial_frames = 0 is out of range; allowed: 1 .. 10000");
  }
}

}  // namespace
}  // namespace vantage
