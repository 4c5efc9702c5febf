#include "viewer/what_if.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <optional>
#include <thread>

#include "tests/support/synthetic_record.h"

namespace vantage {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

/// A step whose search left groups unscored. \param whole false: planning it again fails
StepData stepData(bool whole = true) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  StepData data;
  data.header = std::make_shared<RunHeader>(run.header);
  data.states = std::make_shared<StateGrid>(run.states);
  data.volume = std::make_shared<TsdfVolume>(run.volume);
  auto record = std::make_shared<StepRecord>(run.record);
  if (!whole) {
    auto positions = std::make_shared<std::vector<ViewPosition>>(*record->positions);
    positions->back().first_id += 1;
    record->positions = positions;
  }
  data.record = record;
  return data;
}

class WhatIfTest : public ::testing::Test {
 protected:
  BackgroundWork work_{[] {}};
  WhatIf what_if_{work_};
};

TEST_F(WhatIfTest, SaysWhyNothingCanBeTried) {
  const StepData data = stepData();
  what_if_.setStep(data, nullptr);
  EXPECT_EQ(stateText(what_if_), "preparing…");
  EXPECT_EQ(scoredText(what_if_), "") << "nothing is known yet";
  what_if_.refuse("there is no room");
  EXPECT_EQ(stateText(what_if_), "cannot be tried: there is no room");
  EXPECT_EQ(scoredText(what_if_), "");
  EXPECT_FALSE(what_if_.shown().empty()) << "the step itself stays";

  StepData cut = data;
  auto record = std::make_shared<StepRecord>(*data.record);
  record->search.reset();
  cut.record = record;
  what_if_.setStep(cut, makeWhatIfContext(data, {}));
  EXPECT_EQ(what_if_.state(), WhatIfState::Unavailable);
  EXPECT_THAT(stateText(what_if_), HasSubstr("cut before its views were searched"));
  EXPECT_EQ(scoredText(what_if_), "");

  what_if_.setStep(data, makeWhatIfContext(data, {}));
  EXPECT_EQ(stateText(what_if_), "as recorded");
}

TEST_F(WhatIfTest, TellsWaitingCancelledAndFailedViewsApart) {
  const StepData data = stepData(false);
  what_if_.setStep(data, makeWhatIfContext(data, {}));
  ASSERT_GT(what_if_.pendingGroups(), 0u);
  EXPECT_THAT(scoredText(what_if_), EndsWith("not scored yet"));
  what_if_.cancel();
  EXPECT_THAT(scoredText(what_if_), EndsWith("not scored: cancelled"));
  EXPECT_FALSE(what_if_.failed());
  ASSERT_TRUE(what_if_.set("gain.threshold", 900.0));
  ASSERT_EQ(what_if_.state(), WhatIfState::Failed);
  EXPECT_TRUE(what_if_.failed());
  EXPECT_THAT(stateText(what_if_), HasSubstr("view search"));
  EXPECT_THAT(scoredText(what_if_), EndsWith("not scored: failed"));
  EXPECT_FALSE(what_if_.busy()) << "nothing is left to cancel";
}

TEST_F(WhatIfTest, AFileOfParametersNamesWhatPlanningAgainDoesNotAskFor) {
  const StepData data = stepData();
  what_if_.setStep(data, makeWhatIfContext(data, {}));
  const auto others = what_if_.load("[exploration]\nsteps = 77\n[gain]\nthreshold = 900\n", "file");
  EXPECT_EQ(others, (std::vector<std::string>{"exploration.steps"}));
  EXPECT_TRUE(what_if_.edits().changed("gain.threshold"));
  EXPECT_FALSE(what_if_.edits().changed("exploration.steps"));
}

/// Keeps the worker from everything that comes after it until it is let go.
class Hold {
 public:
  explicit Hold(BackgroundWork& work) {
    work.start("hold", [free = free_.get_future().share()](const RunControl&) {
      free.wait();
      return BackgroundWork::Finish();
    });
  }
  void letGo() { free_.set_value(); }

 private:
  std::promise<void> free_;
};

TEST_F(WhatIfTest, ACheckOfEarlierParametersNeverCountsForLaterOnes) {
  const StepData data = stepData();
  Hold hold(work_);
  what_if_.setStep(data, makeWhatIfContext(data, {}));
  // The first is decided by what is scored, so that its path is checked; the second needs a group more.
  std::optional<double> ranked, unscored;
  for (double threshold = 100.0; threshold < 1e6; threshold *= 1.3) {
    ASSERT_TRUE(what_if_.set("gain.threshold", threshold));
    if (what_if_.state() == WhatIfState::Checking) ranked = threshold;
    if (what_if_.state() == WhatIfState::Scoring) unscored = threshold;
  }
  ASSERT_TRUE(ranked && unscored);
  ASSERT_TRUE(what_if_.set("gain.threshold", *ranked));
  ASSERT_EQ(what_if_.state(), WhatIfState::Checking);
  ASSERT_TRUE(what_if_.set("gain.threshold", *unscored));
  ASSERT_EQ(what_if_.state(), WhatIfState::Scoring);
  hold.letGo();
  while (work_.busy()) {
    work_.poll();
    ASSERT_EQ(what_if_.shown().header->contour_config.gain.gain_threshold, *unscored);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(what_if_.state(), WhatIfState::Settled);
}

TEST_F(WhatIfTest, ViewsAreScoredWhileASliderMoves) {
  const StepData data = stepData();
  what_if_.setStep(data, makeWhatIfContext(data, {}));
  ASSERT_GT(what_if_.pendingGroups(), 0u);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  for (int i = 0; what_if_.pendingGroups() > 0 && std::chrono::steady_clock::now() < end; ++i) {
    ASSERT_TRUE(what_if_.set("gain.threshold", 1e5 + i));  // no view is that good: all groups are wanted
    work_.poll();
  }
  EXPECT_EQ(what_if_.pendingGroups(), 0u);
}

}  // namespace
}  // namespace vantage
