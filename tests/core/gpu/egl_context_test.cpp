#include "core/gpu/egl_context.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <thread>

#include "core/gpu/driver_messages.h"

namespace vantage {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(EglContext, ComesUpWithoutADisplayAndDescribesItself) {
  unsetenv("DISPLAY");
  EglContext context;
  EXPECT_TRUE(context.isCurrent());
  EXPECT_THAT(context.describe(), HasSubstr("OpenGL"));
  ASSERT_FALSE(context.attempts().empty());
  EXPECT_EQ(context.attempts().back().reason, "");
  EXPECT_NE(context.function("glClear"), nullptr);
}

TEST(EglContext, TwoContextsLiveSideBySideAndOneOutlivesTheOther) {
  EglContext first;
  {
    EglContext second;
    EXPECT_FALSE(first.isCurrent());
    EXPECT_TRUE(second.isCurrent());
  }
  first.makeCurrent();
  EXPECT_TRUE(first.isCurrent());
}

TEST(EglContext, ReleasedContextMovesToAnotherThread) {
  EglContext context;
  context.release();
  EXPECT_FALSE(context.isCurrent());
  bool current = false;
  std::thread([&] {
    context.makeCurrent();
    current = context.isCurrent();
    context.release();
  }).join();
  EXPECT_TRUE(current);
}

/// Makes a context in a fresh process under a changed environment; ends with 3 and the error's text if that
/// fails.
void openInChild(const char* variable, int major) {
  if (variable) setenv(variable, "/nonexistent", 1);
  unsetenv("DISPLAY");
  try {
    EglContext context(major, 2);
    std::_Exit(0);
  } catch (const GlUnavailable& error) {
    std::fprintf(stderr, "%s\n", error.what());
    std::_Exit(3);
  }
}

class EglContextDeathTest : public testing::Test {
 protected:
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_F(EglContextDeathTest, WithoutVendorLibraryNamesItsPackage) {
  EXPECT_EXIT(openInChild("__EGL_VENDOR_LIBRARY_DIRS", 3), testing::ExitedWithCode(3),
              "no context.*pbuffer: .*0x300.*(install libegl-mesa0|NVIDIA_DRIVER_CAPABILITIES)");
}

TEST_F(EglContextDeathTest, WithoutDriverNamesItsPackageAndQuotesTheLoader) {
  EXPECT_EXIT(openInChild("LIBGL_DRIVERS_PATH", 3), testing::ExitedWithCode(3),
              "surfaceless: .*0x3001.*(install libgl1-mesa-dri|NVIDIA_DRIVER_CAPABILITIES)");
}

TEST_F(EglContextDeathTest, SuccessPrintsNothing) {
  EXPECT_EXIT(openInChild(nullptr, 3), testing::ExitedWithCode(0), "^$");
}

TEST(EglContextErrors, ImpossibleVersionIsRefusedWithEveryAttempt) {
  try {
    EglContext context(9, 9);
    FAIL() << "OpenGL 9.9 can't exist";
  } catch (const GlUnavailable& error) {
    EXPECT_FALSE(error.failure().attempts.empty());
    for (const GlAttempt& attempt : error.failure().attempts)
      EXPECT_NE(attempt.reason, "") << attempt.platform;
    EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
  }
}

TEST(GlAdvice, FollowsTheSymptoms) {
  GlFailure failure;
  EXPECT_THAT(adviseOnGl(failure), HasSubstr("libegl-mesa0"));
  failure.vendor_library = true;
  EXPECT_THAT(adviseOnGl(failure), HasSubstr("libgl1-mesa-dri"));
  failure.nvidia_device = true;
  EXPECT_THAT(adviseOnGl(failure), HasSubstr("NVIDIA_DRIVER_CAPABILITIES=all"));
  EXPECT_THAT(adviseOnGl(failure), HasSubstr("10_nvidia.json"));
  failure.nvidia_vendor_file = true;
  EXPECT_THAT(adviseOnGl(failure), HasSubstr("libgl1-mesa-dri"));
  failure.driver_messages = "MESA-LOADER: failed to open swrast: version `GLIBCXX_3.4.30' not found";
  EXPECT_THAT(adviseOnGl(failure), HasSubstr("LD_LIBRARY_PATH"));
}

TEST(DriverMessages, KeepsTheDriversLinesAndPassesOthersOn) {
  testing::internal::CaptureStderr();
  DriverMessages messages;
  std::fprintf(stderr, "libEGL warning: DRI2: failed to create dri screen\nvantage: a line of ours\n");
  EXPECT_EQ(messages.finish(), "libEGL warning: DRI2: failed to create dri screen");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "vantage: a line of ours\n");
}

}  // namespace
}  // namespace vantage
