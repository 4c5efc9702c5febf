// Parameters that are tried in the window: by sliders, fields, keys and files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"
#include "tests/viewer/ball_run.h"
#include "tests/viewer/inspector_driver.h"
#include "viewer/commands.h"

namespace vantage {
namespace {

using ::testing::AnyOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using testing::InspectorDriver;

class InspectorWhatIfTest : public testing::WithBallRun<2> {};

const std::string kB = "saliency.isolation_distance_m";

double wanted(InspectorDriver& driver, const std::string& key) {
  return std::get<double>(driver.whatIf().edits().value(key));
}

TEST_F(InspectorWhatIfTest, AThresholdReRanksAtOnceAndIsSettledByAPathCheck) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("tab/What if");
  const auto then = driver.model().recorded().record->chosen()->id;
  ASSERT_EQ(driver.whatIf().state(), WhatIfState::Recorded);
  driver.ui.click("what-if/" + kB + "/text");
  driver.ui.press({keyOf('A'), true});
  driver.ui.type("15");
  driver.ui.hold({Key::Enter});  // one frame
  EXPECT_THAT(driver.whatIf().state(), AnyOf(WhatIfState::Checking, WhatIfState::Settled));
  ASSERT_TRUE(driver.model().shown().record->hasView());
  EXPECT_NE(driver.model().shown().record->chosen()->id, then);
  driver.ui.release({Key::Enter});
  EXPECT_THAT(driver.ui.words(), HasSubstr("Decision: view " + std::to_string(then) + " → view "));
  driver.ui.settle();
  EXPECT_DOUBLE_EQ(wanted(driver, kB), 0.015);
  EXPECT_EQ(driver.whatIf().state(), WhatIfState::Settled);
  EXPECT_THAT(driver.ui.words(), HasSubstr("\nnow chosen\n")) << "where the arrow in the scene ends";
  EXPECT_THAT(driver.ui.words(), HasSubstr("\n▲")) << "rows that came forward";
  const StepRecord& now = *driver.model().shown().record;
  ASSERT_TRUE(now.hasView());
  EXPECT_NE(now.chosen()->id, then);
  EXPECT_EQ(now.search->chosen->search, 0u);
  EXPECT_GT(now.chosen()->gain_voxels, 0u);
  EXPECT_EQ(driver.model().recorded().record->chosen()->id, then) << "the record itself must not change";
}

TEST_F(InspectorWhatIfTest, UndoRedoAndResetComeBack) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("tab/What if");
  driver.ui.drag("what-if/" + kB, 0.7, 0.5, 0.3, 0.5);
  driver.ui.settle();
  const double moved = wanted(driver, kB);
  EXPECT_LT(moved, 0.03);
  driver.ui.press({keyOf('Z'), true});
  driver.ui.settle();
  EXPECT_EQ(wanted(driver, kB), 0.05);
  EXPECT_EQ(driver.whatIf().state(), WhatIfState::Recorded);
  driver.ui.press({keyOf('Y'), true});
  driver.ui.settle();
  EXPECT_EQ(wanted(driver, kB), moved);
  driver.ui.click("what-if/" + kB + "/reset");
  driver.ui.settle();
  EXPECT_EQ(wanted(driver, kB), 0.05);
}

TEST_F(InspectorWhatIfTest, TextThatIsNoValueIsToldAndChangesNothing) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("tab/What if");
  driver.ui.enter("what-if/" + kB + "/text", "wide");
  EXPECT_TRUE(driver.ui.has("what-if/" + kB + "/error"));
  driver.ui.enter("what-if/" + kB + "/text", "-3");
  EXPECT_TRUE(driver.ui.has("what-if/" + kB + "/error"));
  EXPECT_EQ(wanted(driver, kB), 0.05);
  driver.ui.enter("what-if/" + kB + "/text", "20");
  EXPECT_FALSE(driver.ui.has("what-if/" + kB + "/error"));
}

TEST_F(InspectorWhatIfTest, WhatIsTypedIntoAFieldCountsWhenTheFieldIsLeftAndNotAfterEscape) {
  const std::string key = "saliency.isolation_distance_m";
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("tab/What if");
  const auto typeOver = [&](const std::string& text) {
    driver.ui.click("what-if/" + key + "/text");
    driver.ui.press({keyOf('A'), true});
    driver.ui.type(text);
  };
  const auto value = [&] { return std::get<double>(driver.whatIf().edits().value(key)); };
  const double before = value();
  typeOver("31");
  driver.ui.press({Key::Escape});
  driver.ui.settle();
  EXPECT_DOUBLE_EQ(value(), before);
  typeOver("32");
  driver.ui.press({Key::Tab});
  driver.ui.settle();
  EXPECT_DOUBLE_EQ(value(), 0.032);
  typeOver("33");
  driver.ui.click("tab/What if");
  driver.ui.settle();
  EXPECT_DOUBLE_EQ(value(), 0.033);
}

TEST_F(InspectorWhatIfTest, TabGoesFromFieldToFieldAndNeverIntoASlider) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("tab/What if");
  driver.ui.click("what-if/saliency.isolation_distance_m/text");
  driver.ui.press({Key::Tab});
  driver.ui.type("30");
  driver.ui.press({Key::Enter});
  driver.ui.settle();
  // In the field's unit: a slider would have taken it for 30 m.
  EXPECT_DOUBLE_EQ(std::get<double>(driver.whatIf().edits().value("gain.sphere_margin_m")), 0.30);
}

TEST_F(InspectorWhatIfTest, SegmentationRunsAgainInTheBackground) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("tab/What if");
  driver.ui.click("what-if/group Segmentation");
  driver.ui.enter("what-if/segmentation.seed_m/text", "60");
  EXPECT_NE(driver.whatIf().state(), WhatIfState::Recorded) << "it is at it, or done already";
  driver.ui.settle();
  EXPECT_EQ(driver.whatIf().state(), WhatIfState::Settled);
  EXPECT_NE(driver.model().shown().record->labels->supervoxels,
            driver.model().recorded().record->labels->supervoxels);
  EXPECT_EQ(driver.model().shown().record->contours, driver.model().recorded().record->contours)
      << "contours do not depend on segments and are kept";
}

TEST_F(InspectorWhatIfTest, TheStatusBarTellsHowFarARerunHasCome) {
  InspectorDriver driver;
  driver.open(run());
  EXPECT_THAT(driver.ui.words(), HasSubstr("ready"));
  ASSERT_TRUE(driver.whatIf().setText("segmentation.seed_m", "60"));
  std::string told;
  while (driver.whatIf().state() == WhatIfState::Rerunning) {
    driver.ui.frame();
    told += driver.ui.words();
  }
  EXPECT_THAT(told, ContainsRegex("(segmentation|saliency|generation) [0-9]+ %")) << "whichever a frame met";
  driver.ui.settle();
  EXPECT_THAT(driver.ui.words(), HasSubstr("ready"));
}

TEST_F(InspectorWhatIfTest, ARerunCanBeCancelled) {
  InspectorDriver driver;
  driver.open(run());
  ASSERT_TRUE(driver.whatIf().setText("segmentation.seed_m", "60"));
  EXPECT_EQ(driver.whatIf().state(), WhatIfState::Rerunning);
  driver.inspector.commands().run("what-if.cancel");
  EXPECT_EQ(driver.whatIf().state(), WhatIfState::Failed);
  driver.ui.settle();
  EXPECT_EQ(driver.model().shown().record->labels, driver.model().recorded().record->labels);
  driver.ui.press({keyOf('R'), true});
  driver.ui.settle();
  EXPECT_EQ(driver.whatIf().state(), WhatIfState::Recorded);
}

TEST_F(InspectorWhatIfTest, ParametersStayFromStepToStep) {
  InspectorDriver driver;
  driver.open(run());
  driver.tryValue("gain.threshold", "100000");
  EXPECT_FALSE(driver.model().shown().record->hasView());
  driver.ui.press({Key::Right});
  driver.ui.settle();
  EXPECT_EQ(wanted(driver, "gain.threshold"), 100000.0);
  EXPECT_FALSE(driver.model().shown().record->hasView());
  EXPECT_TRUE(driver.model().recorded().record->hasView());
}

TEST_F(InspectorWhatIfTest, AConfigurationFileIsTriedOnTheStep) {
  InspectorDriver driver;
  driver.open(run());
  const std::string config = *folder_ / "try.toml";
  test::writeFile(config, "[saliency]\nisolation_distance_m = 0.01\n");
  driver.open(config);
  EXPECT_DOUBLE_EQ(wanted(driver, kB), 0.01);
  EXPECT_EQ(driver.whatIf().state(), WhatIfState::Settled);
}

TEST_F(InspectorWhatIfTest, ParametersThatAreOpenedWithARunWaitForIt) {
  const std::string config = *folder_ / "with.toml";
  test::writeFile(config, "[saliency]\nisolation_distance_m = 0.01\n");
  for (const bool config_first : {false, true}) {
    InspectorDriver driver;
    if (config_first)
      driver.inspector.open({config, run()});
    else
      driver.inspector.open({run(), config});
    driver.ui.settle();
    ASSERT_FALSE(driver.model().shown().empty());
    EXPECT_DOUBLE_EQ(std::get<double>(driver.whatIf().edits().value("saliency.isolation_distance_m")), 0.01);
  }
}

TEST_F(InspectorWhatIfTest, APictureOfOtherParametersSaysSo) {
  InspectorDriver driver;
  driver.open(run());
  driver.tryValue("saliency.isolation_distance_m", "31");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder_->path());
  driver.ui.click("status/save picture");
  std::filesystem::current_path(before);
  EXPECT_EQ(driver.picture_title, "saliency.isolation_distance_m = 0.031");
}

TEST_F(InspectorWhatIfTest, TheEyeIsPlacedAfterTheShownStepWasReplaced) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("tab/What if");
  for (int i = 0; i < 5; ++i) {  // each drag makes another step of its own that is shown
    driver.ui.drag("what-if/saliency.isolation_distance_m", 0.6 - 0.1 * i, 0.5, 0.5 - 0.1 * i, 0.5);
    driver.ui.press({keyOf('R')});
  }
  driver.ui.settle();
  EXPECT_TRUE(driver.inspector.preferences().eye->position.allFinite());
}

TEST_F(InspectorWhatIfTest, ASelectionEndsWhereCandidatesAreNumberedAnew) {
  InspectorDriver driver;
  driver.open(run());
  const auto chosen = *driver.model().explainedView();
  driver.ui.press({Key::Down});
  ASSERT_NE(driver.model().explainedView(), chosen);
  ASSERT_TRUE(driver.whatIf().setText(kB, "31"));  // the same candidates in another order
  driver.ui.settle();
  EXPECT_TRUE(driver.model().selected_view);
  ASSERT_TRUE(driver.whatIf().setText("views.rolls", "4"));
  driver.ui.settle();
  EXPECT_FALSE(driver.model().selected_view);
}

}  // namespace
}  // namespace vantage
