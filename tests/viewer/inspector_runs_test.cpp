// Runs in the window: one that is still written, one of the other planner; views and values in them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <ranges>

#include "tests/support/process.h"
#include "tests/viewer/ball_run.h"
#include "tests/viewer/inspector_driver.h"
#include "viewer/candidates.h"
#include "viewer/explanation.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::InspectorDriver;
using ::testing::Not;

class InspectorRunsTest : public testing::WithBallRun<1> {};

TEST_F(InspectorRunsTest, ARunThatIsWrittenIsFollowedToItsNewestStep) {
  const std::string file = *folder_ / "growing.vantage";
  InspectorDriver driver;
  const auto follow = [&](const auto& reached) {
    for (int i = 0; i < 100 && !reached(); ++i) {
      driver.ui.frame(0.25);
      driver.ui.settle();
    }
  };
  const auto expectShown = [&](const StepRecord& record) {
    if (record.step == 1) driver.open(file);
    const auto count = static_cast<std::size_t>(record.step);
    follow([&] { return driver.model().steps().size() >= count; });
    ASSERT_EQ(driver.model().steps().size(), count);
    EXPECT_EQ(driver.model().shown().record->step, record.step) << "who is at the end stays there";
    EXPECT_TRUE(
        driver.ui.has(record.closing ? "timeline/step end" : "timeline/step " + std::to_string(count)));
    EXPECT_THAT(driver.ui.words(), HasSubstr("the run is being written"));
    EXPECT_EQ(driver.notices(), "");
  };
  testing::recordRun(testing::ballScene(), {"exploration.steps=2"}, file, expectShown);
  EXPECT_EQ(driver.model().steps().size(), 3u);
  follow([&] { return !driver.model().growing(); });
  EXPECT_THAT(driver.ui.words(), Not(HasSubstr("the run is being written")));
}

TEST_F(InspectorRunsTest, WhoLooksAtAnEarlierStepIsLeftThereWhileTheRunGrows) {
  const std::string file = *folder_ / "earlier.vantage";
  InspectorDriver driver;
  testing::recordRun(testing::ballScene(), {"exploration.steps=2"}, file, [&](const StepRecord& record) {
    if (record.step == 1) return;
    if (record.step == 2) {
      driver.open(file);
      ASSERT_EQ(driver.model().steps().size(), 2u);
      return;
    }
    for (int i = 0; i < 100 && driver.model().steps().size() < 3; ++i) {
      driver.ui.frame(0.25);
      driver.ui.settle();
    }
    ASSERT_EQ(driver.model().steps().size(), 3u);
    EXPECT_EQ(driver.model().shown().record->step, 1);
  });
}

TEST_F(InspectorRunsTest, ARunThatIsDeletedWhileItIsWrittenIsTold) {
  const std::string file = *folder_ / "deleted.vantage", copy = *folder_ / "kept.vantage";
  testing::recordRun(testing::ballScene(), {"exploration.steps=2"}, file, [&](const StepRecord& record) {
    if (record.step != 1) return;
    InspectorDriver driver;
    driver.open(file);
    EXPECT_THAT(driver.ui.words(), HasSubstr("the run is being written"));
    std::filesystem::rename(file, copy);
    for (int i = 0; i < 100 && driver.notices().empty(); ++i) {
      driver.ui.frame(0.25);
      driver.ui.settle();
    }
    EXPECT_THAT(driver.notices(), HasSubstr("deleted.vantage is gone"));
    EXPECT_EQ(driver.model().shown().record->step, 1) << "what is shown stays";
    std::filesystem::rename(copy, file);
  });
}

TEST_F(InspectorRunsTest, FilteredRunsHaveAStageThatShowsWhatWasRemoved) {
  const std::string file = *folder_ / "filtered.vantage";
  testing::recordRun(testing::ballScene(),
                     {"exploration.steps=1", "camera.faults=true", "filter.shadow=true", "filter.veil=true"},
                     file);
  InspectorDriver driver;
  driver.open(file);
  driver.ui.click("timeline/stage filtered");
  driver.ui.settle();
  EXPECT_TRUE(driver.inspector.preferences().view.layers.has(Layer::FilteredDepth));
  EXPECT_THAT(driver.ui.words(), HasSubstr("last depth image, filtered"));
  EXPECT_THAT(driver.ui.words(), HasSubstr("px removed: shadow"));
  EXPECT_THAT(driver.ui.words(), HasSubstr("px removed: veil"));
  driver.open(run());
  EXPECT_FALSE(driver.ui.has("timeline/stage filtered")) << "nothing was filtered there";
}

TEST_F(InspectorRunsTest, ParametersOfTheHierarchicalPlannerReRankItsViews) {
  const std::string file = *folder_ / "hierarchical.vantage";
  testing::recordRun(testing::ballScene(), {"exploration.steps=1", "exploration.planner=hierarchical"}, file);
  InspectorDriver driver;
  driver.open(file);
  const std::uint32_t then = driver.model().recorded().record->chosen()->id;
  driver.ui.click("tab/What if");
  EXPECT_FALSE(driver.ui.has("what-if/saliency.isolation_distance_m")) << "the other planner's";
  driver.ui.enter("what-if/utility.rotation_weight_m_per_rad/text", "5");
  driver.ui.settle();
  EXPECT_EQ(driver.whatIf().state(), WhatIfState::Settled);
  ASSERT_TRUE(driver.model().shown().record->hasView());
  EXPECT_NE(driver.model().shown().record->chosen()->id, then);
  EXPECT_EQ(driver.model().recorded().record->chosen()->id, then);
  driver.ui.click("what-if/reset all");
  driver.ui.settle();
  EXPECT_EQ(driver.model().shown().record->chosen()->id, then);
}

TEST_F(InspectorRunsTest, AClickOnAFrustumSelectsItsRow) {
  InspectorDriver driver;
  driver.open(run());
  const SceneFrame frame = driver.model().shown().frame();
  const auto limit = static_cast<std::uint32_t>(driver.inspector.preferences().view.style.ranked_views);
  struct Apex {
    std::uint32_t id;
    Eigen::Vector2d at;
  };
  std::vector<Apex> apexes;  // one of each place: rolls about it share it
  const std::uint32_t group = driver.model().shown().record->search->chosen->search;
  for (const CandidateRow& row : candidateRows(frame)) {
    const Eigen::Vector2d at = driver.inWindow(poseOfCandidate(frame, row.id)->translation());
    const auto same = [&](const Apex& known) { return (known.at - at).norm() < 1e-6; };
    if (row.rank && row.group == group && apexes.size() < limit && std::ranges::none_of(apexes, same))
      apexes.push_back({row.id, at});
  }
  const WidgetBox inset = *driver.inspector.widgets().find("view/inset");
  const auto standsAlone = [&](const Apex& apex) {
    return (apex.at.x() < inset.left || apex.at.y() > inset.bottom) &&
           std::ranges::none_of(apexes, [&](const Apex& other) {
             return other.id != apex.id && (other.at - apex.at).norm() < 14.0;
           });
  };
  int clicked = 0;
  for (const Apex& apex : apexes | std::views::drop(1) | std::views::filter(standsAlone)) {
    driver.ui.moveMouse(apex.at.x(), apex.at.y());
    driver.ui.pressMouse();
    driver.ui.releaseMouse();
    driver.ui.settle();
    EXPECT_EQ(driver.model().selected_view, apex.id);
    const WidgetBox* row = driver.inspector.widgets().find("candidates/row " + std::to_string(apex.id));
    EXPECT_TRUE(row && row->visible) << apex.id;
    if (++clicked == 3) break;
  }
  EXPECT_EQ(clicked, 3) << "too few frusta stand apart";
}

TEST_F(InspectorRunsTest, AViewThatCannotBeTakenSaysWhyBesideTheChosenOne) {
  InspectorDriver driver;
  driver.open(run());
  const SceneFrame frame = driver.model().shown().frame();
  const std::vector<CandidateRow> rows = candidateRows(frame);
  const auto refused =
      std::ranges::find_if(rows, [](const CandidateRow& r) { return isUnreachable(r.reachability); });
  ASSERT_NE(refused, rows.end());
  driver.ui.enter("candidates/filter", std::to_string(refused->id));
  driver.ui.settle();
  std::string words = driver.ui.words();
  std::ranges::replace(words, '\n', ' ');  // the panel breaks lines
  const std::string why = explain(frame, rows, refused->id).sentence;
  EXPECT_THAT(why, ::testing::StartsWith("Rejected: "));
  EXPECT_THAT(words, HasSubstr(why));
  const std::uint32_t chosen = driver.model().shown().record->chosen()->id;
  EXPECT_THAT(words, HasSubstr("view " + std::to_string(refused->id) + " chosen: " + std::to_string(chosen)));
}

TEST_F(InspectorRunsTest, TheTickOnASliderStandsAtThePapersValue) {
  const std::string key = "saliency.isolation_distance_m";
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("tab/What if");
  const WidgetBox slider = *driver.inspector.widgets().find("what-if/" + key);
  const auto wordsAt = [&](double share) {
    driver.ui.moveMouse(slider.left + share * (slider.right - slider.left), slider.y());
    driver.ui.frame();
    return driver.ui.words();
  };
  EXPECT_THAT(wordsAt(0.5), HasSubstr("the paper: 20 mm")) << "the middle of 2 to 200 mm";
  EXPECT_THAT(wordsAt(0.3), Not(HasSubstr("the paper: 20 mm")));
  driver.ui.drag("what-if/" + key, 0.7, 0.5, 0.5, 0.5);
  driver.ui.settle();
  EXPECT_NEAR(std::get<double>(driver.whatIf().edits().value(key)), 0.020, 0.001) << "where the handle is";
}

}  // namespace
}  // namespace vantage
