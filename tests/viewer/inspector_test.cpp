// The inspector, driven without a display: clicks, drags, keys and typing on its real widgets.
#include "viewer/inspector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/support/process.h"
#include "tests/viewer/ball_run.h"
#include "tests/viewer/inspector_driver.h"
#include "viewer/commands.h"

namespace vantage {
namespace {

using testing::InspectorDriver;

class InspectorTest : public testing::WithBallRun<3> {};

const std::string kB = "saliency.isolation_distance_m";

double wanted(InspectorDriver& driver, const std::string& key) {
  return std::get<double>(driver.whatIf().edits().value(key));
}

TEST_F(InspectorTest, AnEmptyWindowSaysHowToBegin) {
  InspectorDriver driver;
  driver.ui.settle();
  EXPECT_TRUE(driver.inspector.idle());
  EXPECT_FALSE(driver.ui.has("timeline/play"));
  EXPECT_TRUE(driver.ui.has("menu/File"));
}

TEST_F(InspectorTest, OpensARunAtItsFirstStepWithTheChosenView) {
  InspectorDriver driver;
  driver.open(run());
  ASSERT_EQ(driver.model().steps().size(), 4u);  // three steps and the map at the end
  EXPECT_EQ(driver.model().place(), (TimelinePlace{0, 0}));
  ASSERT_FALSE(driver.model().shown().empty());
  EXPECT_TRUE(driver.model().shown().record->hasView());
  EXPECT_EQ(driver.notices(), "");
  EXPECT_TRUE(driver.ui.has("view/legend"));
  EXPECT_TRUE(driver.ui.has("view/inset"));
}

TEST_F(InspectorTest, AnIdleWindowDrawsNoNewPictures) {
  InspectorDriver driver;
  driver.open(run());
  const auto pictures = driver.inspector.picturesRendered();
  for (int i = 0; i < 30; ++i) driver.ui.frame();
  EXPECT_EQ(driver.inspector.picturesRendered(), pictures);
  driver.ui.press({keyOf('D')});
  driver.ui.settle();
  EXPECT_GT(driver.inspector.picturesRendered(), pictures);
}

TEST_F(InspectorTest, KeepsNoMapOfAStepThatWasLeft) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("timeline/next");  // to where parameters can be tried
  driver.ui.settle();
  for (const char* to : {"timeline/last", "timeline/previous", "timeline/first"}) {
    const std::weak_ptr<const StateGrid> left = driver.model().recorded().states;
    ASSERT_FALSE(left.expired());
    driver.ui.click(to);
    driver.ui.settle();
    EXPECT_TRUE(left.expired()) << to;
  }
}

TEST_F(InspectorTest, TheTimelineIsScrubbedAndSteppedAndPlayed) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("timeline/step 3");
  driver.ui.settle();
  EXPECT_EQ(driver.model().shown().record->step, 3);
  driver.ui.click("timeline/previous");
  driver.ui.settle();
  EXPECT_EQ(driver.model().shown().record->step, 2);
  driver.ui.drag("timeline/strip", 0.05, 0.5, 0.95, 0.5);
  driver.ui.settle();
  EXPECT_TRUE(driver.model().shown().record->closing);
  driver.ui.press({Key::Home});
  driver.ui.settle();
  EXPECT_EQ(driver.model().shown().record->step, 1);
  driver.ui.click("timeline/play");
  EXPECT_TRUE(driver.model().player.playing());
  for (int i = 0; i < 1000 && driver.model().player.playing(); ++i) driver.ui.frame(0.5);
  driver.ui.settle();
  EXPECT_TRUE(driver.model().shown().record->closing);
  EXPECT_FALSE(driver.model().player.playing());
}

TEST_F(InspectorTest, StagesInsideAStepAreShownOneByOne) {
  InspectorDriver driver;
  driver.open(run());
  for (const StageView& stage : driver.model().stages()) {
    driver.ui.click("timeline/stage " + stage.name);
    driver.ui.settle();
    EXPECT_EQ(driver.inspector.preferences().view.layers, stage.layers) << stage.name;
  }
  driver.ui.press({Key::PageUp});
  driver.ui.settle();
  const auto& stages = driver.model().stages();
  EXPECT_EQ(driver.model().place().stage, static_cast<int>(stages.size()) - 2);
  EXPECT_EQ(driver.inspector.preferences().view.layers, stages[stages.size() - 2].layers);
}

TEST_F(InspectorTest, PlayingByStageShowsEveryStage) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("timeline/by stage");
  driver.ui.click("timeline/play");
  std::vector<int> seen;
  for (int i = 0; i < 200 && driver.model().place().step == 0; ++i) {
    if (seen.empty() || seen.back() != driver.model().place().stage)
      seen.push_back(driver.model().place().stage);
    driver.ui.frame(0.25);
  }
  std::vector<int> all(driver.model().stages().size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  EXPECT_EQ(seen, all);
}

TEST_F(InspectorTest, LayersAreSwitchedAndChangeThePicture) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.moveMouse(5, 790);
  driver.ui.settle();
  const RgbImage before = driver.ui.image();
  driver.ui.click("layers/occupied");
  driver.ui.moveMouse(5, 790);
  driver.ui.settle();
  EXPECT_TRUE(driver.inspector.preferences().view.layers.has(Layer::Occupied));
  EXPECT_GT(InspectorDriver::differing(before, driver.ui.image()), 500);
  driver.ui.click("layers/occupied/more");
  driver.ui.drag("layers/occupied/opacity", 0.98, 0.5, 0.2, 0.5);
  driver.ui.settle();
  EXPECT_LT(driver.inspector.preferences().view.look(Layer::Occupied).opacity, 0.5);
}

TEST_F(InspectorTest, SlicesAndTheClippingBoxFollowTheirSliders) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("slices/z");
  driver.ui.drag("slices/z/at", 0.5, 0.5, 0.2, 0.5);
  const ViewSettings& view = driver.inspector.preferences().view;
  EXPECT_TRUE(view.layers.has(Layer::Slices));
  ASSERT_TRUE(view.style.slices[2].at_m.has_value());
  EXPECT_LT(*view.style.slices[2].at_m, driver.model().shown().header->workspace.center().z());
  driver.ui.click("clip/on");
  driver.ui.settle();
  ASSERT_TRUE(view.clip.has_value());
  driver.ui.drag("clip/x to", 0.98, 0.5, 0.5, 0.5);
  driver.ui.settle();
  EXPECT_LT(view.clip->max().x(), driver.model().shown().header->workspace.max().x() - 0.1);
}

TEST_F(InspectorTest, DraggingOrbitsAndTheWheelComesNearer) {
  InspectorDriver driver;
  driver.open(run());
  const Eye before = *driver.inspector.preferences().eye;
  driver.ui.drag("view", 0.9, 0.8, 0.7, 0.8);  // beside the legend
  driver.ui.settle();
  const Eye turned = *driver.inspector.preferences().eye;
  EXPECT_GT((turned.position - before.position).norm(), 0.1);
  EXPECT_NEAR(turned.distance(), before.distance(), 1e-6);
  driver.ui.hover("view");
  driver.ui.wheel(2.0);
  driver.ui.settle();
  EXPECT_LT(driver.inspector.preferences().eye->distance(), turned.distance());
  driver.ui.press({keyOf('R')});
  driver.ui.settle();
  EXPECT_NEAR((driver.inspector.preferences().eye->position - before.position).norm(), 0.0, 1e-6);
}

TEST_F(InspectorTest, BookmarksKeepACamera) {
  InspectorDriver driver;
  driver.open(run());
  const Eye kept = *driver.inspector.preferences().eye;
  driver.ui.press({keyOf('K'), true});
  driver.ui.press({keyOf('3')});
  driver.ui.settle();
  EXPECT_NE(driver.inspector.preferences().eye->position, kept.position);
  driver.ui.press({keyOf('1'), true});
  driver.ui.settle();
  EXPECT_EQ(driver.inspector.preferences().eye->position, kept.position);
  driver.ui.press({keyOf('2')});
  driver.ui.settle();
  driver.ui.click("bookmarks/1/go");
  driver.ui.settle();
  EXPECT_EQ(driver.inspector.preferences().eye->position, kept.position);
  driver.ui.enter("bookmarks/1/name", "from the robot");
  EXPECT_EQ(driver.inspector.preferences().bookmarks.at(0).name, "from the robot");
  driver.ui.click("bookmarks/1/forget");
  EXPECT_TRUE(driver.inspector.preferences().bookmarks.empty());
}

TEST_F(InspectorTest, ThemesAndTextSizeChangeAtOnce) {
  InspectorDriver driver;
  driver.open(run());
  for (int i = 0; i < 3; ++i) {
    const RgbImage before = driver.ui.image();
    driver.ui.press({keyOf('T')});
    driver.ui.settle();
    EXPECT_GT(InspectorDriver::differing(before, driver.ui.image()), 1280 * 800 / 4);
  }
  driver.ui.press({Key::Equal, true});
  driver.ui.settle();
  EXPECT_NEAR(driver.inspector.preferences().font_scale, 1.1, 1e-9);
  driver.ui.press({keyOf('0'), true});
  EXPECT_EQ(driver.inspector.preferences().font_scale, 1.0);
}

TEST_F(InspectorTest, ThePaletteRunsACommandAndF1ListsTheKeys) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.press({keyOf('P'), true});
  driver.ui.frame();
  driver.ui.type("last step");
  driver.ui.frame();
  driver.ui.press({Key::Enter});
  driver.ui.settle();
  EXPECT_TRUE(driver.model().shown().record->closing);
  EXPECT_FALSE(driver.ui.has("palette/query"));
  driver.ui.press({Key::F1});
  driver.ui.frame();
  EXPECT_TRUE(driver.ui.has("cheat sheet"));
  driver.ui.press({Key::Escape});
  driver.ui.frame();
  EXPECT_FALSE(driver.ui.has("cheat sheet"));
}

TEST_F(InspectorTest, EveryCommandRunsWithoutFailing) {
  InspectorDriver driver({}, 640, 400);
  driver.open(run());
  ASSERT_GT(driver.inspector.commands().all().size(), 50u);
  for (const Command& command : driver.inspector.commands().all()) {
    if (command.id == "file.quit" || command.id == "file.screenshot") continue;
    if (command.enabled()) command.run();
    driver.ui.frame(0.01);
    driver.ui.press({Key::Escape});
  }
  driver.model().player.pause();
  driver.ui.settle();
  EXPECT_FALSE(driver.inspector.wantsToClose());
}

TEST_F(InspectorTest, AThresholdReRanksAtOnceAndIsSettledByAPathCheck) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("tab/What if");
  const auto then = driver.model().recorded().record->chosen()->id;
  ASSERT_EQ(driver.whatIf().state(), WhatIfState::Recorded);
  driver.ui.enter("what-if/" + kB + "/text", "15");
  driver.ui.settle();
  EXPECT_DOUBLE_EQ(wanted(driver, kB), 0.015);
  EXPECT_EQ(driver.whatIf().state(), WhatIfState::Settled);
  const StepRecord& now = *driver.model().shown().record;
  ASSERT_TRUE(now.hasView());
  EXPECT_NE(now.chosen()->id, then);
  EXPECT_EQ(now.search->chosen->search, 0u);
  EXPECT_GT(now.chosen()->gain_voxels, 0u);
  EXPECT_EQ(driver.model().recorded().record->chosen()->id, then) << "the record itself must not change";
}

TEST_F(InspectorTest, UndoRedoAndResetComeBack) {
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

TEST_F(InspectorTest, TextThatIsNoValueIsToldAndChangesNothing) {
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

TEST_F(InspectorTest, SegmentationRunsAgainInTheBackground) {
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

TEST_F(InspectorTest, ARerunCanBeCancelled) {
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

TEST_F(InspectorTest, ParametersStayFromStepToStep) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("tab/What if");
  driver.ui.enter("what-if/gain.threshold/text", "100000");
  driver.ui.settle();
  EXPECT_FALSE(driver.model().shown().record->hasView());
  driver.ui.press({Key::Right});
  driver.ui.settle();
  EXPECT_EQ(wanted(driver, "gain.threshold"), 100000.0);
  EXPECT_FALSE(driver.model().shown().record->hasView());
  EXPECT_TRUE(driver.model().recorded().record->hasView());
}

TEST_F(InspectorTest, HoverTellsWhatIsUnderTheMouse) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.hover("view");
  driver.ui.settle();
  EXPECT_TRUE(driver.ui.has("view/hover"));
}

TEST_F(InspectorTest, TwoClicksMeasureADistance) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.press({keyOf('M')});
  driver.ui.settle();
  const WidgetBox view = *driver.inspector.widgets().find("view");
  const auto clickAt = [&](double share) {
    driver.ui.moveMouse(view.left + share * (view.right - view.left), view.y());
    driver.ui.pressMouse();
    driver.ui.releaseMouse();
    driver.ui.settle();
    return view.left + share * (view.right - view.left);
  };
  const double from = clickAt(0.45);
  EXPECT_FALSE(driver.ui.has("view/measured"));
  const double to = clickAt(0.55);
  ASSERT_TRUE(driver.ui.has("view/measured"));
  const WidgetBox line = *driver.inspector.widgets().find("view/measured");
  EXPECT_NEAR(line.left, from, 2.0) << "it ends where it was clicked";
  EXPECT_NEAR(line.right, to, 2.0);
  driver.ui.press({keyOf('M')});
  driver.ui.settle();
  EXPECT_FALSE(driver.ui.has("view/measured"));
}

TEST_F(InspectorTest, ADoubleClickLooksAtThePoint) {
  InspectorDriver driver;
  driver.open(run());
  const Eye before = *driver.inspector.preferences().eye;
  driver.ui.doubleClick("view");
  driver.ui.settle();
  const Eye after = *driver.inspector.preferences().eye;
  EXPECT_GT((after.focus - before.focus).norm(), 1e-3);
  EXPECT_NEAR(after.distance(), before.distance(), 1e-6);
}

TEST_F(InspectorTest, AFileThatIsNoRunIsToldInTheWindow) {
  InspectorDriver driver;
  driver.open(run());
  const std::string broken = *folder_ / "broken.vantage";
  test::writeFile(broken, std::string(20000, 'x'));
  driver.open(broken);
  EXPECT_NE(driver.notices().find("broken.vantage"), std::string::npos) << driver.notices();
  EXPECT_EQ(driver.model().file().filename(), "ball.vantage") << "what was open stays";
  driver.open(*folder_ / "missing.vantage");
  EXPECT_NE(driver.notices().find("missing.vantage"), std::string::npos) << driver.notices();
  driver.ui.click("notices/dismiss");
  EXPECT_EQ(driver.notices(), "");
}

TEST_F(InspectorTest, ARunCutShortIsToldAndTheWindowLives) {
  const std::string whole = test::readFile(run());
  for (const double share : {0.1, 0.5, 0.9}) {
    const std::string cut = *folder_ / "cut.vantage";
    test::writeFile(cut, whole.substr(0, static_cast<std::size_t>(share * whole.size())));
    InspectorDriver driver;
    driver.open(cut);
    for (const char* step : {"timeline/step 2", "timeline/step 3"}) {
      if (!driver.ui.has(step)) continue;
      driver.ui.click(step);
      driver.ui.settle();
    }
    EXPECT_NE(driver.notices().find("cut.vantage"), std::string::npos) << share << driver.notices();
    const auto& notices = driver.model().notices();
    EXPECT_TRUE(std::ranges::any_of(notices, [](const Notice& n) { return n.level != Notice::Level::Info; }))
        << driver.notices();
  }
}

TEST_F(InspectorTest, AStepThatCannotBeReadIsToldAndWhatIsShownStays) {
  const std::string copy = *folder_ / "copy.vantage";
  std::filesystem::copy_file(run(), copy, std::filesystem::copy_options::overwrite_existing);
  InspectorDriver driver;
  driver.open(copy);
  std::filesystem::resize_file(copy, std::filesystem::file_size(copy) / 2);
  driver.ui.click("timeline/step 3");
  driver.ui.settle();
  EXPECT_NE(driver.notices().find("copy.vantage"), std::string::npos) << driver.notices();
  ASSERT_FALSE(driver.model().shown().empty());
  EXPECT_EQ(driver.model().shown().record->step, 1);
  EXPECT_EQ(driver.model().place().step, 0) << "the timeline stands where the picture does";
  EXPECT_FALSE(driver.model().loading());
}

TEST_F(InspectorTest, AConfigurationFileIsTriedOnTheStep) {
  InspectorDriver driver;
  driver.open(run());
  const std::string config = *folder_ / "try.toml";
  test::writeFile(config, "[saliency]\nisolation_distance_m = 0.01\n");
  driver.open(config);
  EXPECT_DOUBLE_EQ(wanted(driver, kB), 0.01);
  EXPECT_EQ(driver.whatIf().state(), WhatIfState::Settled);
}

}  // namespace
}  // namespace vantage
