// What the window brings back from its last start, what is opened from it, and how it is used by keys alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"
#include "tests/viewer/ball_run.h"
#include "tests/viewer/inspector_driver.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::InspectorDriver;

class InspectorStartTest : public testing::WithBallRun<1> {};

/// Nothing is under the mouse.
void leave(InspectorDriver& driver) {
  driver.ui.moveMouse(5, 795);
  driver.ui.settle();
}

TEST_F(InspectorStartTest, TheNextStartLooksAsTheLastOneWasLeft) {
  const std::string state = *folder_ / "inspector.toml";
  RgbImage window;
  Preferences left;
  {
    InspectorDriver driver;
    driver.ui.press({keyOf('T')});
    driver.ui.press({Key::Equal, true});
    driver.open(run());
    driver.ui.drag("splitter/left", 0.5, 0.5, 10.5, 0.5);
    driver.ui.click("layers/occupied");
    driver.ui.drag("view", 0.8, 0.8, 0.6, 0.8);
    leave(driver);
    window = driver.ui.image();
    left = driver.inspector.preferences();
    savePreferences(state, driver.inspector.toKeep());
  }
  InspectorDriver driver(loadPreferences(state));
  driver.open(run());
  leave(driver);
  const Preferences& now = driver.inspector.preferences();
  EXPECT_EQ(now.theme, left.theme);
  EXPECT_NE(now.theme, Preferences().theme);
  EXPECT_DOUBLE_EQ(now.font_scale, 1.1);
  EXPECT_EQ(now.view.layers, left.view.layers);
  EXPECT_LT((now.eye->position - left.eye->position).norm(), 1e-6);
  EXPECT_LT((now.eye->focus - left.eye->focus).norm(), 1e-6);
  EXPECT_LT(InspectorDriver::differing(window, driver.ui.image()), 2000) << "the window looks the same";
}

TEST_F(InspectorStartTest, ADraggedBorderMakesItsPanelLarger) {
  struct Border {
    std::string name;
    double to_x, to_y;  ///< in widths and heights of the border, which is 6 pixels thick
  };
  for (const Border& border : {Border{"splitter/left", 10.5, 0.5}, Border{"splitter/right", -9.5, 0.5},
                               Border{"splitter/timeline", 0.5, -9.5}}) {
    InspectorDriver driver;
    driver.open(run());
    const WidgetBox before = *driver.inspector.widgets().find("view");
    driver.ui.drag(border.name, 0.5, 0.5, border.to_x, border.to_y);
    const WidgetBox after = *driver.inspector.widgets().find("view");
    const double smaller = (before.right - before.left) - (after.right - after.left) +
                           (before.bottom - before.top) - (after.bottom - after.top);
    EXPECT_NEAR(smaller, 60.0, 2.0) << border.name;
    const Preferences kept = driver.inspector.toKeep(), usual;
    EXPECT_GT(kept.left_em + kept.right_em + kept.timeline_em,
              usual.left_em + usual.right_em + usual.timeline_em + 3.0)
        << border.name;
  }
}

TEST_F(InspectorStartTest, ARecentFileIsOpenedFromTheMenu) {
  Preferences kept;
  kept.addRecent(run());
  InspectorDriver driver(kept);
  driver.ui.settle();
  driver.ui.click("menu/File");
  driver.ui.click("menu/recent " + run());
  driver.ui.settle();
  EXPECT_EQ(driver.model().file(), run());
  EXPECT_FALSE(driver.model().shown().empty());
}

TEST_F(InspectorStartTest, ARecipeThatIsOpenedOverARunBringsItsLayersAndItsCamera) {
  InspectorDriver driver;
  driver.open(run());
  leave(driver);
  const Eye before = *driver.inspector.preferences().eye;
  const RgbImage picture = driver.picture("view");
  driver.recipe.layers = {Layer::Occupied, Layer::Workspace};
  driver.recipe.camera.azimuth_rad += 1.0;
  test::writeFile(*folder_ / "recipe.toml", "layers = [\"occupied\", \"workspace\"]\n");
  driver.open(*folder_ / "recipe.toml");
  EXPECT_EQ(driver.inspector.preferences().view.layers, driver.recipe.layers);
  EXPECT_GT((driver.inspector.preferences().eye->position - before.position).norm(), 0.1);
  EXPECT_GT(InspectorDriver::differing(picture, driver.picture("view")), 2000);
  EXPECT_EQ(driver.model().file(), run());
  EXPECT_THAT(driver.ui.words(), HasSubstr("the view of recipe recipe.toml"));
}

TEST_F(InspectorStartTest, AfterF6KeysMoveInsideThePanels) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("layers/occupied");
  const LayerSet before = driver.inspector.preferences().view.layers;
  driver.ui.press({functionKey(6)});
  driver.ui.press({Key::Down});
  driver.ui.press({Key::Down});
  driver.ui.press({Key::Space});
  driver.ui.settle();
  LayerSet wanted = before;
  wanted.set(Layer::Free, !before.has(Layer::Free));
  EXPECT_EQ(driver.inspector.preferences().view.layers, wanted);
  EXPECT_FALSE(driver.model().player.playing()) << "the key was the panel's";
  driver.ui.press({functionKey(6)});
  driver.ui.press({Key::Space});
  EXPECT_TRUE(driver.model().player.playing());
  EXPECT_EQ(driver.inspector.preferences().view.layers, wanted);
}

TEST_F(InspectorStartTest, F6NeedsNoClickBefore) {
  InspectorDriver driver;
  driver.open(run());
  const LayerSet before = driver.inspector.preferences().view.layers;
  const auto explained = driver.model().explainedView();
  driver.ui.press({functionKey(6)});
  for (int i = 0; i < 3; ++i) driver.ui.press({Key::Down});
  driver.ui.press({Key::Space});
  driver.ui.settle();
  EXPECT_NE(driver.inspector.preferences().view.layers, before) << "a layer was switched";
  EXPECT_EQ(driver.model().explainedView(), explained) << "the arrows were the panel's";
}

TEST_F(InspectorStartTest, LoopAndSpeedAreSetBesideThePlayButton) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("timeline/loop");
  driver.ui.drag("timeline/speed", 0.4, 0.5, 0.99, 0.5);
  EXPECT_DOUBLE_EQ(driver.model().player.speed(), Player::kFastest);
  EXPECT_THAT(driver.ui.words(), HasSubstr("8 / s"));
  driver.ui.click("timeline/play");
  driver.ui.frame(0.11);  // at one step a second it would wait
  EXPECT_EQ(driver.model().place().step, 1) << "the map at the end";
  bool began_again = false;
  for (int i = 0; i < 1000 && !began_again; ++i) {
    driver.ui.frame(0.11);
    began_again = driver.model().place().step == 0;
  }
  EXPECT_TRUE(began_again);
  EXPECT_TRUE(driver.model().player.playing());
}

TEST_F(InspectorStartTest, ColoursAndSizeOfALayerChangeThePicture) {
  InspectorDriver driver;
  driver.open(run());
  const std::string layer = "layers/" + std::string(layerName(Layer::RankedViews));
  driver.ui.click(layer + "/more");
  leave(driver);
  const RgbImage own = driver.picture("view");
  driver.ui.click(layer + "/colour map");
  driver.ui.click(layer + "/colour map/cividis");
  leave(driver);
  EXPECT_EQ(driver.inspector.preferences().view.look(Layer::RankedViews).color_map, ColorMap::Cividis);
  const RgbImage cividis = driver.picture("view");
  EXPECT_GT(InspectorDriver::differing(own, cividis), 200);
  driver.ui.drag(layer + "/size", 0.5, 0.5, 0.9, 0.5);
  leave(driver);
  EXPECT_GT(driver.inspector.preferences().view.look(Layer::RankedViews).size, 2.0);
  EXPECT_GT(InspectorDriver::differing(cividis, driver.picture("view")), 200);
}

}  // namespace
}  // namespace vantage
