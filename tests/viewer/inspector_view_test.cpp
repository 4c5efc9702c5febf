// What stands around and over the 3-D view: stages, legend, pictures beside the scene, what is under the
// mouse, small windows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "tests/support/process.h"
#include "tests/viewer/ball_run.h"
#include "tests/viewer/inspector_driver.h"
#include "viewer/commands.h"
#include "viewer/pick_text.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::InspectorDriver;
using ::testing::StartsWith;

class InspectorViewTest : public testing::WithBallRun<2> {};

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
  EXPECT_GT(driver.coloursIn("view/depth", 0.5), 20u);
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
  const auto holdForASecond = [&](const Shortcut& keys) {
    driver.ui.hold(keys);
    for (int i = 0; i < 60; ++i) driver.ui.frame();
    driver.ui.release(keys);
    driver.ui.settle();
  };
  const auto azimuth = [&] {
    const Eye& eye = *driver.inspector.preferences().eye;
    return std::atan2(eye.position.y() - eye.focus.y(), eye.position.x() - eye.focus.x());
  };
  const double before = azimuth();
  driver.ui.press({keyOf('A')});
  const double once = std::remainder(azimuth() - before, 2.0 * std::numbers::pi);
  ASSERT_GT(std::abs(once), 0.01);
  holdForASecond({keyOf('A')});
  EXPECT_GT(std::remainder(azimuth() - before, 2.0 * std::numbers::pi) / once, 4.0);
  const std::filesystem::path folder = std::filesystem::current_path();
  std::filesystem::current_path(folder_->path());
  holdForASecond({keyOf('S'), true});
  std::filesystem::current_path(folder);
  EXPECT_EQ(driver.pictures_taken, 1);
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
  const WidgetBox view = *driver.inspector.widgets().find("view");
  const auto expectWordsAt = [&](const Eigen::Vector2d& at, const std::string& begin) {
    const double x = std::floor(at.x()), y = std::floor(at.y());  // a mouse is on whole pixels
    driver.ui.moveMouse(x, y);
    driver.ui.settle();
    Picker picker;
    const StepData& step = driver.model().shown();
    const auto picked =
        picker.at(step.frame(), driver.inspector.preferences().view, *driver.inspector.preferences().eye,
                  {x - view.left, y - view.top}, driver.pictureSize());
    ASSERT_TRUE(picked);
    const std::string text = textOf(*picked, step, candidateRows(step.frame()));
    EXPECT_THAT(text, StartsWith(begin));
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) EXPECT_THAT(driver.ui.words(), HasSubstr(line));
  };
  expectWordsAt({view.x(), view.y()}, "segment with label");
  const ChosenView& chosen = *driver.model().shown().record->chosen();
  expectWordsAt(driver.inWindow(chosen.T_world_camera.translation()),
                "view " + std::to_string(chosen.id) + ", rank 1");
  driver.ui.moveMouse(5, 790);
  driver.ui.settle();
  EXPECT_FALSE(driver.ui.has("view/hover"));
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

TEST_F(InspectorViewTest, ThePictureOfAViewIsNeverThatOfAnotherStep) {
  InspectorDriver driver;
  driver.open(run());
  ASSERT_TRUE(driver.ui.has("view/inset"));
  driver.ui.press({Key::Right});
  while (driver.model().recorded().record->step == 1) driver.ui.frame();
  const std::string ours = "view " + std::to_string(*driver.model().explainedView()) + ": predicted";
  EXPECT_TRUE(!driver.ui.has("view/inset") || driver.ui.words().find(ours) != std::string::npos);
  driver.ui.settle();
  EXPECT_TRUE(driver.ui.has("view/inset"));
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
