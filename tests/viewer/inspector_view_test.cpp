// What stands around and over the 3-D view: stages, legend, pictures beside the scene, what is under the
// mouse, small windows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/support/process.h"
#include "tests/viewer/ball_run.h"
#include "tests/viewer/inspector_driver.h"
#include "viewer/commands.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::InspectorDriver;

class InspectorViewTest : public testing::WithBallRun<2> {};

/// Colours in a widget's box.
std::size_t coloursIn(InspectorDriver& driver, const std::string& name) {
  const WidgetBox* box = driver.inspector.widgets().find(name);
  if (!box) return 0;
  const RgbImage image = driver.ui.image();
  std::set<std::array<std::uint8_t, 3>> colours;
  for (int y = static_cast<int>(box->top) + 3; y < static_cast<int>(box->bottom) - 3; ++y)
    for (int x = static_cast<int>(box->left) + 3; x < static_cast<int>(box->right) - 3; ++x)
      colours.insert(image.at(x, y));
  return colours.size();
}

TEST_F(InspectorViewTest, TheOverviewIsAStageThatOneComesBackTo) {
  InspectorDriver driver;
  driver.open(run());
  const LayerSet overview = driver.model().stages().front().layers;
  EXPECT_EQ(driver.inspector.preferences().view.layers, overview);
  driver.ui.press({Key::PageDown});
  driver.ui.settle();
  EXPECT_EQ(driver.model().stages()[driver.model().place().stage].name, "scan");
  driver.ui.click("timeline/stage overview");
  driver.ui.settle();
  EXPECT_EQ(driver.inspector.preferences().view.layers, overview);
}

TEST_F(InspectorViewTest, TheOverviewOfTheMapAtTheEndShowsWhatIsOccupied) {
  InspectorDriver driver;
  driver.open(run());
  EXPECT_FALSE(driver.inspector.preferences().view.layers.has(Layer::Occupied));
  driver.ui.press({Key::End});
  driver.ui.settle();
  ASSERT_TRUE(driver.model().shown().record->closing);
  EXPECT_TRUE(driver.inspector.preferences().view.layers.has(Layer::Occupied));
  driver.ui.press({Key::Home});
  driver.ui.settle();
  EXPECT_FALSE(driver.inspector.preferences().view.layers.has(Layer::Occupied));
}

TEST_F(InspectorViewTest, LayersThatWereSwitchedByHandStayFromStepToStep) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.press({keyOf('4')});  // occupied voxels, beside the overview
  driver.ui.settle();
  const LayerSet mine = driver.inspector.preferences().view.layers;
  ASSERT_TRUE(mine.has(Layer::Occupied));
  driver.ui.press({Key::End});
  driver.ui.settle();
  EXPECT_EQ(driver.inspector.preferences().view.layers, mine);
}

TEST_F(InspectorViewTest, SegmentsHaveAColourEachInTheirStage) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("timeline/stage segments");
  driver.ui.moveMouse(5, 790);
  driver.ui.settle();
  const RgbImage labels = driver.picture("view");
  EXPECT_TRUE(driver.inspector.preferences().view.layers.has(Layer::SegmentLabels));
  driver.ui.click("timeline/stage saliency");
  driver.ui.moveMouse(5, 790);
  driver.ui.settle();
  EXPECT_GT(InspectorDriver::differing(labels, driver.picture("view")), 2000);
}

TEST_F(InspectorViewTest, TheScanComesWithItsDepthImage) {
  InspectorDriver driver;
  driver.open(run());
  EXPECT_FALSE(driver.ui.has("view/depth"));
  driver.ui.click("timeline/stage scan");
  driver.ui.settle();
  ASSERT_TRUE(driver.ui.has("view/depth"));
  EXPECT_GT(coloursIn(driver, "view/depth"), 20u);
}

TEST_F(InspectorViewTest, TheLegendIsFoldedAwayAndDoesNotStandInTheMousesWay) {
  InspectorDriver driver;
  driver.open(run());
  ASSERT_TRUE(driver.ui.has("view/legend"));
  const Eye before = *driver.inspector.preferences().eye;
  const WidgetBox legend = *driver.inspector.widgets().find("view/legend");
  driver.ui.moveMouse(legend.x(), legend.y());
  driver.ui.pressMouse();
  driver.ui.frame();
  driver.ui.moveMouse(legend.x() + 50.0, legend.y());
  driver.ui.frame();
  driver.ui.releaseMouse();
  driver.ui.settle();
  EXPECT_GT((driver.inspector.preferences().eye->position - before.position).norm(), 0.1);
  driver.ui.click("view/legend/fold");
  driver.ui.settle();
  EXPECT_FALSE(driver.ui.has("view/legend"));
  driver.ui.click("view/legend/fold");
  driver.ui.settle();
  EXPECT_TRUE(driver.ui.has("view/legend"));
}

TEST_F(InspectorViewTest, InASmallWindowStagesAreChosenFromAList) {
  InspectorDriver driver({}, 700, 500);
  driver.open(run());
  EXPECT_FALSE(driver.ui.has("timeline/stage scan"));
  driver.ui.click("timeline/stages");
  driver.ui.click("timeline/stages/Scan");
  driver.ui.settle();
  EXPECT_TRUE(driver.inspector.preferences().view.layers.has(Layer::Sensor));
  EXPECT_LE(driver.inspector.widgets().find("timeline/stages")->right, 700.0);
}

TEST_F(InspectorViewTest, ButtonsOfANarrowPanelGoOnInTheNextLine) {
  InspectorDriver driver({}, 700, 500);
  driver.open(run());
  driver.ui.click("tab/What if");
  const double border = driver.inspector.widgets().find("splitter/left")->right;
  for (const char* button : {"undo", "redo", "reset all", "cancel", "copy", "write config…"}) {
    const WidgetBox* box = driver.inspector.widgets().find(std::string("what-if/") + button);
    ASSERT_TRUE(box) << button;
    EXPECT_LE(box->right, border) << button;
  }
}

TEST_F(InspectorViewTest, TheTitleNeverRunsOffTheWindow) {
  for (const int width : {420, 700, 1280}) {
    InspectorDriver driver({}, width, 500);
    driver.open(run());
    const WidgetBox* title = driver.inspector.widgets().find("menu/title");
    ASSERT_TRUE(title);
    EXPECT_LE(title->right, width) << width;
  }
}

TEST_F(InspectorViewTest, TheButtonSavesAPictureAndSaysWhere) {
  InspectorDriver driver;
  driver.ui.settle();
  EXPECT_FALSE(driver.inspector.widgets().find("status/save picture")->enabled) << "there is nothing to save";
  driver.open(run());
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder_->path());
  driver.ui.click("status/save picture");
  driver.ui.click("status/save picture");
  driver.ui.settle();
  std::filesystem::current_path(before);
  EXPECT_EQ(driver.pictures_taken, 2);
  EXPECT_TRUE(std::filesystem::exists(*folder_ / "ball-step1-view.png"));
  EXPECT_TRUE(std::filesystem::exists(*folder_ / "ball-step1-view-2.png")) << "the first one is kept";
  EXPECT_THAT(driver.notices(), HasSubstr("ball-step1-view-2.png"));
}

TEST_F(InspectorViewTest, AHeldKeyTurnsTheSceneButSavesOnePicture) {
  InspectorDriver driver;
  driver.open(run());
  EXPECT_TRUE(driver.inspector.commands().find("view.left")->repeats);
  EXPECT_FALSE(driver.inspector.commands().find("file.screenshot")->repeats);
  EXPECT_FALSE(driver.inspector.commands().find("timeline.play")->repeats);
}

TEST_F(InspectorViewTest, LayersThatAStageBroughtAreNotKeptForTheNextStart) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.press({Key::End});
  driver.ui.settle();
  EXPECT_EQ(driver.inspector.toKeep().view.layers, LayerSet());
  driver.ui.press({keyOf('6')});
  driver.ui.settle();
  EXPECT_TRUE(driver.inspector.toKeep().view.layers.has(Layer::Surface));
}

TEST_F(InspectorViewTest, OneSliceComesAtATime) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("slices/x");
  driver.ui.settle();
  const ViewSettings& view = driver.inspector.preferences().view;
  EXPECT_TRUE(view.layers.has(Layer::Slices));
  EXPECT_TRUE(view.style.slices[0].shown);
  EXPECT_FALSE(view.style.slices[1].shown);
  driver.ui.click("slices/x");
  driver.ui.settle();
  EXPECT_FALSE(view.layers.has(Layer::Slices));
}

TEST_F(InspectorViewTest, WhereTheLegendHasNoRoomItIsToldUnderTheMouse) {
  InspectorDriver driver({}, 700, 500);
  driver.open(run());
  EXPECT_FALSE(driver.ui.has("view/legend"));
  driver.ui.moveMouse(5, 495);
  driver.ui.settle();
  const RgbImage before = driver.ui.image();
  driver.ui.hover("view/legend/fold");
  driver.ui.settle();
  EXPECT_GT(InspectorDriver::differing(before, driver.ui.image()), 5000);
}

TEST_F(InspectorViewTest, HoverTellsWhatIsUnderTheMouse) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.hover("view");
  driver.ui.settle();
  EXPECT_TRUE(driver.ui.has("view/hover"));
}

TEST_F(InspectorViewTest, TwoClicksMeasureADistance) {
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

TEST_F(InspectorViewTest, ADoubleClickLooksAtThePoint) {
  InspectorDriver driver;
  driver.open(run());
  const Eye before = *driver.inspector.preferences().eye;
  driver.ui.doubleClick("view");
  driver.ui.settle();
  const Eye after = *driver.inspector.preferences().eye;
  EXPECT_GT((after.focus - before.focus).norm(), 1e-3);
  EXPECT_NEAR(after.distance(), before.distance(), 1e-6);
}

TEST_F(InspectorViewTest, WhatLiesUnderAPictureIsNotUnderTheMouse) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.press({keyOf('V')});  // through the view: the scene fills the picture
  driver.ui.hover("view/inset");
  driver.ui.settle();
  EXPECT_FALSE(driver.ui.has("view/hover"));
  const Eye before = *driver.inspector.preferences().eye;
  driver.ui.drag("view/inset", 0.3, 0.3, 0.7, 0.3);
  EXPECT_EQ(driver.inspector.preferences().eye->position, before.position);
}

}  // namespace
}  // namespace vantage
