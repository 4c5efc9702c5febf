// What the inspector's panels say and do, driven without a display.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/process.h"
#include "tests/viewer/ball_run.h"
#include "tests/viewer/inspector_driver.h"
#include "viewer/candidates.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::InspectorDriver;

class InspectorPanelsTest : public testing::WithBallRun<2> {};

std::string rowName(std::uint32_t id) {
  return "candidates/row " + std::to_string(id);
}

bool showsRow(InspectorDriver& driver, std::uint32_t id) {
  const WidgetBox* box = driver.inspector.widgets().find(rowName(id));
  return box && box->visible;
}

std::vector<CandidateRow> rowsOf(InspectorDriver& driver) {
  return candidateRows(driver.model().shown().frame());
}

/// A ranked view far down the table.
CandidateRow lateView(InspectorDriver& driver) {
  const std::vector<CandidateRow> rows = rowsOf(driver);
  return *std::ranges::max_element(rows, {}, [](const CandidateRow& r) { return r.rank.value_or(0); });
}

TEST_F(InspectorPanelsTest, TheTableComesBackToTheSelectedViewWhenTheFilterIsCleared) {
  for (const bool by_key : {false, true}) {
    InspectorDriver driver;
    driver.open(run());
    const std::uint32_t late = lateView(driver).id, chosen = driver.model().shown().record->chosen()->id;
    driver.model().selected_view = late;
    driver.ui.settle();
    ASSERT_TRUE(showsRow(driver, late));
    driver.ui.click("candidates/filter");
    driver.ui.type(std::to_string(chosen));
    driver.ui.frame();
    ASSERT_FALSE(showsRow(driver, late));
    if (by_key)
      driver.ui.press({Key::Escape});
    else
      driver.ui.click("candidates/clear filter");
    driver.ui.settle();
    EXPECT_TRUE(showsRow(driver, late)) << by_key;
    EXPECT_FALSE(showsRow(driver, chosen)) << "the table is at its begin";
    EXPECT_FALSE(driver.inspector.widgets().find("candidates/clear filter")->enabled);
  }
}

TEST_F(InspectorPanelsTest, TheTableFollowsTheSelectedViewWhenItsRankChanges) {
  InspectorDriver driver;
  driver.open(run());
  // The last view of the first segment, which is no longer the first one below.
  const std::vector<CandidateRow> before = rowsOf(driver);
  const auto rankInFirst = [](const CandidateRow& r) { return r.group == 0 ? r.rank.value_or(0) : 0; };
  const CandidateRow late = *std::ranges::max_element(before, {}, rankInFirst);
  ASSERT_GT(late.rank.value_or(0), 20u);
  driver.model().selected_view = late.id;
  driver.ui.settle();
  driver.tryValue("saliency.isolation_distance_m", "15");
  const std::vector<CandidateRow> rows = rowsOf(driver);
  const auto now =
      std::ranges::find_if(rows, [&](const CandidateRow& r) { return !r.pending() && r.id == late.id; });
  ASSERT_NE(now, rows.end());
  ASSERT_NE(now->rank, late.rank) << "its place must change for the test to mean anything";
  EXPECT_TRUE(showsRow(driver, late.id));
}

TEST_F(InspectorPanelsTest, EnterSelectsTheViewWhoseNumberIsTyped) {
  InspectorDriver driver;
  driver.open(run());
  const std::uint32_t late = lateView(driver).id;
  ASSERT_FALSE(driver.ui.has(rowName(late)));
  driver.ui.click("candidates/filter");
  driver.ui.type(std::to_string(late));
  driver.ui.frame();
  EXPECT_TRUE(showsRow(driver, late));
  EXPECT_FALSE(driver.model().selected_view) << "typing alone selects nothing";
  driver.ui.press({Key::Enter});
  driver.ui.settle();
  EXPECT_EQ(driver.model().selected_view, late);
  driver.ui.enter("candidates/filter", "no number");
  EXPECT_TRUE(driver.ui.has("candidates/nothing"));
  EXPECT_EQ(driver.model().selected_view, late);
}

TEST_F(InspectorPanelsTest, ViewsThatCannotBeTakenAreLeftOutOnRequest) {
  InspectorDriver driver;
  driver.open(run());
  const std::vector<CandidateRow> rows = rowsOf(driver);
  const auto refused =
      std::ranges::find_if(rows, [](const CandidateRow& r) { return isUnreachable(r.reachability); });
  ASSERT_NE(refused, rows.end());
  driver.ui.enter("candidates/filter", std::to_string(refused->id));
  driver.ui.settle();
  ASSERT_TRUE(driver.ui.has(rowName(refused->id)));
  driver.ui.click("candidates/reachable only");
  driver.ui.settle();
  EXPECT_FALSE(driver.ui.has(rowName(refused->id)));
  driver.ui.click("candidates/reachable only");
  driver.ui.settle();
  EXPECT_TRUE(driver.ui.has(rowName(refused->id)));
}

TEST_F(InspectorPanelsTest, NoColumnThatMattersIsCutAtTheDefaultSize) {
  InspectorDriver driver;
  driver.open(run());
  driver.tryValue("saliency.isolation_distance_m", "15");
  const Widgets& widgets = driver.inspector.widgets();
  const std::uint32_t chosen = driver.model().shown().record->chosen()->id;
  ASSERT_TRUE(widgets.find(rowName(chosen)));
  for (const char* column : {"rank", "change", "view", "gain", "segment", "saliency", "verdict"}) {
    const WidgetBox* box = widgets.find("candidates/column " + std::string(column));
    ASSERT_TRUE(box) << column;
    EXPECT_LE(box->right, widgets.find(rowName(chosen))->right + 1.0) << column;
  }
}

TEST_F(InspectorPanelsTest, WhatWasCancelledRunsAgain) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("tab/What if");
  ASSERT_TRUE(driver.whatIf().setText("segmentation.seed_m", "60"));
  driver.ui.frame();
  driver.ui.click("what-if/cancel");
  driver.ui.settle();
  EXPECT_EQ(driver.whatIf().state(), WhatIfState::Failed);
  EXPECT_FALSE(driver.ui.has("what-if/cancel"));
  driver.ui.click("what-if/run again");
  driver.ui.settle();
  EXPECT_EQ(driver.whatIf().state(), WhatIfState::Settled);
  EXPECT_FALSE(driver.ui.has("what-if/run again"));
  EXPECT_NE(driver.model().shown().record->labels->supervoxels,
            driver.model().recorded().record->labels->supervoxels);
}

TEST_F(InspectorPanelsTest, ScoringInTheBackgroundIsCancelledAndTakenUpAgain) {
  InspectorDriver driver;
  driver.inspector.open({run()});
  for (int i = 0; i < 2000 && driver.whatIf().pendingGroups() == 0; ++i) driver.ui.frame();
  ASSERT_GT(driver.whatIf().pendingGroups(), 0u);
  driver.whatIf().cancel();
  driver.ui.settle();
  EXPECT_GT(driver.whatIf().pendingGroups(), 0u);
  EXPECT_EQ(driver.whatIf().state(), WhatIfState::Recorded);
  EXPECT_FALSE(driver.whatIf().busy());
  driver.ui.click("tab/What if");
  driver.ui.click("what-if/run again");
  driver.ui.settle();
  EXPECT_EQ(driver.whatIf().pendingGroups(), 0u);
}

TEST_F(InspectorPanelsTest, ValuesOfEveryKindThatAreRefusedNameRangeAndUnit) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("tab/What if");
  driver.ui.click("what-if/group Views");
  struct Refused {
    std::string key, text, problem, allowed;
  };
  const std::string b = "saliency.isolation_distance_m", points = "saliency.min_points",
                    distances = "views.distances_m";
  const std::vector<Refused> all = {{b, "-5", "-5 mm is out of range", "0.001 .. 200 mm"},
                                    {b, "1e9", "1e9 mm is out of range", "0.001 .. 200 mm"},
                                    {b, "abc", "'abc' is not a number", "0.001 .. 200 mm"},
                                    {b, "", "a number is missing", "0.001 .. 200 mm"},
                                    {points, "1e9", "1e9 is out of range", "1 .. 1 000 000"},
                                    {points, "2.5", "2.5 is not a whole number", "1 .. 1 000 000"},
                                    {distances, "0.8, -1", "-1 m is out of range", "each 0.01 .. 100 m"},
                                    {distances, "abc", "'abc' is not a number", "each 0.01 .. 100 m"},
                                    {distances, "", "a number is missing", "each 0.01 .. 100 m"}};
  for (const Refused& refused : all) {
    const config::Value before = driver.whatIf().edits().value(refused.key);
    driver.ui.click("what-if/" + refused.key + "/text");
    driver.ui.press({keyOf('A'), true});
    driver.ui.press({Key::Delete});
    driver.ui.type(refused.text);
    driver.ui.press({Key::Enter});
    driver.ui.frame();
    EXPECT_TRUE(driver.ui.has("what-if/" + refused.key + "/error")) << refused.key << " " << refused.text;
    const std::string error = driver.whatIf().edits().error(refused.key);
    EXPECT_THAT(error, HasSubstr(refused.problem));
    EXPECT_THAT(error, HasSubstr("; allowed: "));
    EXPECT_THAT(error, HasSubstr(refused.allowed));
    EXPECT_EQ(driver.whatIf().edits().value(refused.key), before) << "the old value stays";
  }
  EXPECT_FALSE(driver.whatIf().edits().anyChanged());
}

TEST_F(InspectorPanelsTest, EmptyPanelsSayThatAFileIsBeingLoaded) {
  InspectorDriver driver;
  driver.ui.settle();
  driver.ui.click("tab/What if");
  for (const char* panel : {"what-if", "views", "explain"})
    EXPECT_TRUE(driver.ui.has(std::string(panel) + "/empty")) << panel;
  driver.inspector.open({run()});
  driver.ui.frame();
  for (const char* panel : {"what-if", "views", "explain"}) {
    EXPECT_TRUE(driver.ui.has(std::string(panel) + "/loading")) << panel;
    EXPECT_FALSE(driver.ui.has(std::string(panel) + "/empty")) << panel;
  }
  driver.ui.settle();
  for (const char* panel : {"what-if", "views", "explain"})
    EXPECT_FALSE(driver.ui.has(std::string(panel) + "/loading")) << panel;
}

TEST_F(InspectorPanelsTest, ANewConfigurationFileIsNamedAmongItsLikeAndAskedForBeforeItIsReplaced) {
  InspectorDriver driver;
  driver.open(run());
  std::filesystem::create_directories(*folder_ / "settings");
  test::writeFile(*folder_ / "settings/old.toml", "old");
  ASSERT_TRUE(driver.whatIf().setText("gain.threshold", "900"));
  driver.ui.settle();
  driver.ui.click("tab/What if");
  driver.ui.click("what-if/write config…");
  driver.ui.frame();
  EXPECT_FALSE(driver.ui.has("file/entry ball.vantage")) << "it is no configuration";
  driver.ui.click("file/entry settings");
  driver.ui.press({Key::Enter});
  driver.ui.frame();
  ASSERT_TRUE(driver.ui.has("file/entry old.toml"));
  driver.ui.enter("file/name", "old");
  ASSERT_TRUE(driver.ui.has("file/replace"));
  EXPECT_EQ(test::readFile(*folder_ / "settings/old.toml"), "old");
  driver.ui.click("file/replace");
  driver.ui.settle();
  EXPECT_THAT(test::readFile(*folder_ / "settings/old.toml"), HasSubstr("threshold = 900"));
}

TEST_F(InspectorPanelsTest, VoxelsAreNotCountedAnewWhileASliderIsMoved) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("tab/What if");
  ASSERT_TRUE(driver.ui.has("explain/voxels"));
  const auto hold = [&](const std::string& name) {
    driver.ui.hover(name);
    const WidgetBox box = *driver.inspector.widgets().find(name);
    driver.ui.pressMouse();
    driver.ui.frame();
    driver.ui.moveMouse(box.left + 0.31 * (box.right - box.left), box.y());
    driver.ui.frame();
    driver.ui.frame();
  };
  const std::string margin = "gain.sphere_margin_m", points = "saliency.min_points";
  hold("what-if/" + margin);
  ASSERT_TRUE(driver.whatIf().edits().changed(margin));
  EXPECT_FALSE(driver.ui.has("explain/voxels")) << "another sphere: a whole view would be cast";
  driver.ui.releaseMouse();
  driver.ui.settle();
  EXPECT_TRUE(driver.ui.has("explain/voxels"));

  driver.model().selected_view = driver.model().explainedView();
  driver.ui.settle();
  hold("what-if/" + points);
  ASSERT_TRUE(driver.whatIf().edits().changed(points));
  EXPECT_TRUE(driver.ui.has("explain/voxels")) << "ranks alone change: what was counted still holds";
  driver.ui.releaseMouse();
  driver.ui.settle();
}

TEST_F(InspectorPanelsTest, TheCheatSheetStaysInsideTheWindow) {
  struct Size {
    int width, height;
  };
  for (const Size size : {Size{1280, 800}, Size{900, 600}, Size{640, 400}}) {
    InspectorDriver driver({}, size.width, size.height);
    driver.ui.settle();
    driver.ui.press({Key::F1});
    driver.ui.settle();
    const WidgetBox* box = driver.inspector.widgets().find("cheat sheet");
    ASSERT_TRUE(box);
    EXPECT_GE(box->left, 0.0);
    EXPECT_LE(box->right, size.width);
    EXPECT_LE(box->bottom, size.height);
  }
}

}  // namespace
}  // namespace vantage
