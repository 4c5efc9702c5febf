// Built with the files that stand in for ROS and OpenNI2 where these are absent.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hardware/openni_camera.h"
#include "hardware/ros_bridge.h"
#include "io/error.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;

template <class Act>
std::string errorOf(const Act& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(AbsentDevices, SayWhatToInstall) {
  EXPECT_THAT(
      errorOf([] {
        openOpenNiCamera("test://depth", {0.5, 8.0});
      }),
      HasSubstr("openni2:test://depth: this program was built without OpenNI2; install libopenni2-dev"));
  EXPECT_THAT(errorOf([] {
                openRosCamera("/camera/image_raw", {0.5, 8.0});
              }),
              HasSubstr("ros:/camera/image_raw: this program was built without ROS; install libroscpp-dev"));
  EXPECT_THAT(errorOf([] { rosArmLink({}, {"/arm"}); }),
              HasSubstr("ros:/arm: this program was built without ROS"));
}

TEST(AbsentDevices, AreListedAsNotBuilt) {
  for (const DeviceKind& kind : {openNiDevices(), rosDevices()}) {
    EXPECT_FALSE(kind.built) << kind.kind;
    EXPECT_THAT(kind.note, HasSubstr("built without"));
    EXPECT_TRUE(kind.devices.empty());
  }
}

}  // namespace
}  // namespace vantage
