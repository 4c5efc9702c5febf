#include "hardware/frame_inbox.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "core/exploration/ports.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;

/// Calls a function with 0, 1, 2, ... every 5 ms until it is destroyed.
class Driver {
 public:
  template <class Send>
  explicit Driver(Send send)
      : thread_([send](std::stop_token stop) {
          for (int i = 0; !stop.stop_requested(); ++i) {
            send(i);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
          }
        }) {}

 private:
  std::jthread thread_;
};

DepthImage image(int width, float depth_m) {
  DepthImage depth(width, 4);
  depth.at(0, 0) = depth_m;
  return depth;
}

std::string lossOf(FrameInbox& inbox) {
  try {
    inbox.next();
  } catch (const DeviceLost& lost) {
    return lost.what();
  }
  return "";
}

TEST(FrameInbox, GivesTheImageBehindTheOneThatMayHaveBeenOnItsWay) {
  FrameInbox inbox("camera", 5.0);
  std::atomic<int> sent = 0;
  inbox.put(image(6, 1.0f), 0.0);
  const Driver driver([&](int i) { inbox.put(image(6, static_cast<float>(sent = i + 2)), i + 1.0); });
  const int before = sent;
  EXPECT_GE(inbox.next().at(0, 0), static_cast<float>(before + 2));
  EXPECT_EQ(inbox.trouble(), "");
}

TEST(FrameInbox, SilenceIsALoss) {
  FrameInbox inbox("camera", 0.05);
  EXPECT_THAT(lossOf(inbox), HasSubstr("camera: no image for"));
  EXPECT_THAT(inbox.trouble(), HasSubstr("no image for"));
}

TEST(FrameInbox, FrozenStampsAreALoss) {
  FrameInbox inbox("camera", 0.1);
  const Driver driver([&](int) { inbox.put(image(6, 1.0f), 12.5); });
  EXPECT_THAT(lossOf(inbox), HasSubstr("time stamps of its images stand still at 12.500000 s"));
}

TEST(FrameInbox, StampsThatAreNoNumbersAreALoss) {
  FrameInbox inbox("camera", 0.1);
  const Driver driver([&](int) { inbox.put(image(6, 1.0f), std::nan("")); });
  EXPECT_THAT(lossOf(inbox), HasSubstr("time stamps"));
}

TEST(FrameInbox, ImagesOfAnotherSizeAreALoss) {
  FrameInbox inbox("camera", 0.1);
  const Driver driver([&](int i) { inbox.put(image(i < 1 ? 6 : 8, 1.0f), i); });
  EXPECT_THAT(lossOf(inbox), HasSubstr("its images are 8x4 now, and were 6x4"));
}

TEST(FrameInbox, SaysWhatTheDriverSaid) {
  FrameInbox inbox("camera", 0.05);
  inbox.refuse("its encoding is rgb8");
  EXPECT_EQ(lossOf(inbox), "camera: its encoding is rgb8");
}

}  // namespace
}  // namespace vantage
