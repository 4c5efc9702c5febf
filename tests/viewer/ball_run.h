#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "tests/support/process.h"
#include "tests/support/recorded_run.h"

namespace vantage::testing {

/// Tests of the window on a run of the ball between two blocks, with so many steps, recorded once for all of
/// them.
template <int steps>
class WithBallRun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    unsetenv("DISPLAY");
    folder_ = std::make_unique<test::TemporaryFolder>();
    recordRun(ballScene(), {"exploration.steps=" + std::to_string(steps)}, run());
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::string run() { return *folder_ / "ball.vantage"; }

  static inline std::unique_ptr<test::TemporaryFolder> folder_;
};

}  // namespace vantage::testing
