// The inspector, driven without a display: clicks, drags, keys and typing on its real widgets.
#include "viewer/inspector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"
#include "tests/viewer/ball_run.h"
#include "tests/viewer/inspector_driver.h"
#include "viewer/commands.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::InspectorDriver;
using ::testing::IsSubsetOf;
using ::testing::Not;

class InspectorTest : public testing::WithBallRun<3> {};

TEST_F(InspectorTest, AnEmptyWindowSaysHowToBegin) {
  InspectorDriver driver;
  driver.ui.settle();
  EXPECT_TRUE(driver.inspector.idle());
  EXPECT_FALSE(driver.ui.has("timeline/play"));
  EXPECT_TRUE(driver.ui.has("menu/File"));
  EXPECT_THAT(driver.ui.words(), HasSubstr("Open a run with Ctrl+O, or drop a file here."));
  driver.open(run());
  EXPECT_THAT(driver.ui.words(), Not(HasSubstr("or drop a file here")));
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
  ASSERT_TRUE(driver.ui.has("view/inset"));
  EXPECT_GT(driver.coloursIn("view/inset", 0.5), 20u) << "it shows a picture, not paper";
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
  const RgbImage before = driver.picture("view");
  driver.ui.click("layers/occupied");
  driver.ui.settle();
  EXPECT_TRUE(driver.inspector.preferences().view.layers.has(Layer::Occupied));
  EXPECT_GT(InspectorDriver::differing(before, driver.picture("view")), 500);
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
  const std::string sheet = driver.ui.words();
  for (const Command& command : driver.inspector.commands().all()) {
    if (command.keys.key == Key::None) continue;
    EXPECT_THAT(sheet, HasSubstr("\n" + textOf(command.keys) + " " + command.title));
  }
  driver.ui.press({Key::Escape});
  driver.ui.frame();
  EXPECT_FALSE(driver.ui.has("cheat sheet"));
}

TEST_F(InspectorTest, EveryCommandRunsWithoutFailing) {
  InspectorDriver driver({}, 640, 400);
  driver.open(run());
  ASSERT_GT(driver.inspector.commands().all().size(), 50u);
  ASSERT_TRUE(driver.whatIf().setText("gain.threshold", "900"));  // something to undo and to reset
  std::vector<std::string> left_out;
  for (const Command& command : driver.inspector.commands().all()) {
    if (command.id == "file.quit" || command.id == "file.screenshot") continue;
    if (!command.enabled()) left_out.push_back(command.id);
    if (command.enabled()) command.run();
    driver.ui.frame(0.01);
    driver.ui.press({Key::Escape});
    EXPECT_EQ(driver.inspector.error(), std::nullopt) << command.id;
    driver.model().dismissNotices();
  }
  driver.model().player.pause();
  driver.ui.settle();
  EXPECT_EQ(driver.inspector.error(), std::nullopt);
  EXPECT_THAT(left_out, IsSubsetOf({"file.close beside", "file.switch", "view.bookmark 2", "view.bookmark 3",
                                    "view.bookmark 4", "what-if.cancel", "what-if.run again"}));
  EXPECT_FALSE(driver.inspector.wantsToClose());
}

TEST_F(InspectorTest, LayersMayAllBeSwitchedOff) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("timeline/stage fused");
  for (const Layer layer : {Layer::Workspace, Layer::Axes, Layer::Occupied, Layer::Unknown, Layer::Surface})
    if (driver.inspector.preferences().view.layers.has(layer))
      driver.ui.click("layers/" + std::string(layerName(layer)));
  driver.ui.settle();
  EXPECT_EQ(driver.inspector.preferences().view.layers, LayerSet());
}

}  // namespace
}  // namespace vantage
