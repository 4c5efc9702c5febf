#include "hardware/replay_depth_camera.h"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "tests/io/dataset_support.h"

namespace vantage {
namespace {

class ReplayDepthCameraTest : public DatasetTest {};

TEST(PoseDistance, JoinsMetresAndHalfAMetreARadian) {
  const Pose a = Pose::Identity();
  EXPECT_DOUBLE_EQ(poseDistance_m(a, a), 0.0);
  EXPECT_DOUBLE_EQ(poseDistance_m(a, Pose(Eigen::Translation3d(0.3, 0, 0.4))), 0.5);
  const Pose turned(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY()));
  EXPECT_NEAR(poseDistance_m(a, turned), std::numbers::pi / 4, 1e-9);
  EXPECT_NEAR(poseDistance_m(a, Eigen::Translation3d(0, 1, 0) * turned),
              std::hypot(1.0, std::numbers::pi / 4), 1e-9);
}

TEST_F(ReplayDepthCameraTest, ServesTheNearestFrameNotYetServed) {
  addSequence();
  ReplayDepthCamera camera(openDataset(folder_));
  EXPECT_EQ(camera.model().width, kWidth);
  ASSERT_EQ(camera.recordedPoses().size(), 3u);
  EXPECT_TRUE(camera.recordedPoses()[0].isApprox(poseOf(3)));
  std::vector<int> served;
  for (int i = 0; i < 3; ++i) {
    const auto frame = camera.capture(poseOf(8), i);
    ASSERT_TRUE(frame.has_value());
    EXPECT_TRUE(frame->T_world_camera.isApprox(poseOf(frame->frame)));
    EXPECT_FLOAT_EQ(frame->depth.at(0, 0), 2.0f);
    served.push_back(frame->frame);
  }
  EXPECT_EQ(served, (std::vector<int>{7, 12, 3}));
  EXPECT_EQ(camera.framesLeft(), 0u);
  EXPECT_FALSE(camera.capture(poseOf(8), 3).has_value());
}

TEST_F(ReplayDepthCameraTest, TiesGoToTheLowerNumber) {
  addFrame(4);
  addFrame(6);
  write("camera-intrinsics.txt", "10 10 4 3");
  for (int run = 0; run < 2; ++run) {
    ReplayDepthCamera camera(openDataset(folder_));
    EXPECT_EQ(camera.capture(Pose(Eigen::Translation3d(0.5, 0, 0)), 0)->frame, 4);
  }
}

TEST(ReplayRecorded, EveryFrameOfTheTraySequenceIsServedOnce) {
  VANTAGE_RECORDED(folder, "rgbd_ur5_tray");
  ReplayDepthCamera camera(openDataset(folder));
  std::set<int> served;
  Pose at = camera.recordedPoses().front();
  while (const auto frame = camera.capture(at, served.size())) {
    EXPECT_TRUE(served.insert(frame->frame).second);
    at = frame->T_world_camera;
  }
  EXPECT_EQ(served.size(), 24u);
}

}  // namespace
}  // namespace vantage
