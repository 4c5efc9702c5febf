#include "hardware/openni_camera.h"

#include <OpenNI.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"

namespace vantage::test {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;

constexpr double kPatience_s = 0.4;

/// Number of the image that the test driver made.
int numberOf(const DepthImage& depth) {
  return static_cast<int>(std::lround((depth.at(1, 0) * 1000.0f - 501.0f) / 7.0f));
}

template <class Act>
std::string errorOf(const Act& act) {
  try {
    act();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(OpenNiCamera, IsListed) {
  const DeviceKind kind = openNiDevices();
  EXPECT_EQ(kind.note, "");
  EXPECT_THAT(kind.devices, Contains(Field(&DeviceEntry::name, "openni2:test://depth")));
}

TEST(OpenNiCamera, DeliversMillimetresAndItsCalibration) {
  const auto camera = openOpenNiCamera("test://depth", {0.5, 8.0});
  EXPECT_EQ(camera->model().width, 320);
  EXPECT_EQ(camera->model().height, 240);
  EXPECT_NEAR(camera->model().horizontalFov_rad(), 1.0144, 1e-6);
  EXPECT_NEAR(camera->model().verticalFov_rad(), 0.7898, 1e-6);
  EXPECT_EQ(camera->model().max_range_m, 8.0);
  const Pose pose = makePose({1, 2, 3}, Eigen::Quaterniond::Identity());
  const auto first = camera->capture(pose, 0), second = camera->capture(pose, 1);
  ASSERT_TRUE(first && second);
  EXPECT_TRUE(first->T_world_camera.isApprox(pose));
  EXPECT_TRUE(std::isnan(first->depth.at(0, 0)));
  const int n = numberOf(first->depth);
  EXPECT_NEAR(first->depth.at(319, 239), (500 + 7 * n + 319) * 1e-3, 1e-6);
  EXPECT_GE(numberOf(second->depth), n + 2) << "the next one may have been on its way";
}

TEST(OpenNiCamera, TwoUsesFollowEachOther) {
  for (int i = 0; i < 2; ++i)
    EXPECT_TRUE(openOpenNiCamera("test://depth", {0.5, 8.0})->capture(Pose::Identity(), 0)) << i;
}

/// Records images of the driver with OpenNI itself.
int record(const std::string& path, int images) {
  openni::OpenNI::initialize();
  openni::Device device;
  EXPECT_EQ(device.open("test://depth"), openni::STATUS_OK);
  openni::VideoStream stream;
  EXPECT_EQ(stream.create(device, openni::SENSOR_DEPTH), openni::STATUS_OK);
  openni::Recorder recorder;
  EXPECT_EQ(recorder.create(path.c_str()), openni::STATUS_OK);
  EXPECT_EQ(recorder.attach(stream), openni::STATUS_OK);
  stream.start();
  recorder.start();
  int first = -1;
  for (int i = 0; i < images; ++i) {
    openni::VideoFrameRef frame;
    EXPECT_EQ(stream.readFrame(&frame), openni::STATUS_OK);
    if (i == 0) first = frame.getFrameIndex();
  }
  recorder.stop();
  recorder.destroy();
  stream.stop();
  stream.destroy();
  device.close();
  return first;
}

TEST(OpenNiCamera, PlaysARecordingImageByImage) {
  const TemporaryFolder folder;
  const std::string path = folder / "session.oni";
  record(path, 12);
  const auto camera = openOpenNiCamera(path, {0.5, 8.0});
  EXPECT_EQ(camera->model().width, 320);
  EXPECT_NEAR(camera->model().horizontalFov_rad(), 1.0144, 1e-6);
  int images = 0, last = 0;
  while (const auto frame = camera->capture(Pose::Identity(), images)) {
    const int n = numberOf(frame->depth);
    if (images > 0) {
      EXPECT_EQ(n, last + 1);
    }
    EXPECT_NEAR(frame->depth.at(319, 239), (500 + 7 * n + 319) * 1e-3, 1e-6);
    EXPECT_TRUE(std::isnan(frame->depth.at(0, 0)));
    last = n;
    ++images;
  }
  EXPECT_GE(images, 10);
  EXPECT_EQ(camera->trouble(), "");
}

std::string lossOf(const std::string& uri) {
  const auto camera = openOpenNiCamera(uri, {0.5, 8.0}, kPatience_s);
  return errorOf([&] {
    for (int i = 0; i < 100; ++i) camera->capture(Pose::Identity(), i);
  });
}

TEST(OpenNiCamera, SilenceIsALoss) {
  EXPECT_THAT(lossOf("test://silent"), HasSubstr("camera openni2:test://silent: no image for"));
}
TEST(OpenNiCamera, FrozenStampsAreALoss) {
  EXPECT_THAT(lossOf("test://frozen"), HasSubstr("time stamps of its images stand still at 0.66"));
}
TEST(OpenNiCamera, ImagesOfAnotherSizeAreALoss) {
  EXPECT_THAT(lossOf("test://size"), HasSubstr("its images are 160x120 now, and were 320x240"));
}
TEST(OpenNiCamera, AnUnpluggedCameraIsALoss) {
  EXPECT_THAT(lossOf("test://unplugged"), HasSubstr("was disconnected"));
}

TEST(OpenNiCamera, RefusesWhatIsNotThere) {
  const TemporaryFolder folder;
  EXPECT_THAT(errorOf([] {
                openOpenNiCamera("test://nobody", {0.5, 8.0});
              }),
              HasSubstr("openni2:test://nobody: "));
  EXPECT_THAT(errorOf([&] { openOpenNiCamera(folder / "none.oni", {0.5, 8.0}); }), HasSubstr("is no file"));
  writeFile(folder / "text.oni", "this is no recording\n");
  EXPECT_THAT(errorOf([&] { openOpenNiCamera(folder / "text.oni", {0.5, 8.0}); }), HasSubstr("text.oni"));
  const std::string path = folder / "cut.oni";
  record(path, 12);
  writeFile(path, readFile(path).substr(0, 20000));
  EXPECT_THAT(errorOf([&] { openOpenNiCamera(path, {0.5, 8.0}); }), HasSubstr("cut.oni"));
}

}  // namespace
}  // namespace vantage::test
