// What stands around and over the 3-D view: stages, legend, pictures beside the scene, small windows; and
// what becomes of a file that is looked at.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <thread>

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
  const RgbImage labels = driver.ui.image();
  EXPECT_TRUE(driver.inspector.preferences().view.layers.has(Layer::SegmentLabels));
  driver.ui.click("timeline/stage saliency");
  driver.ui.moveMouse(5, 790);
  driver.ui.settle();
  EXPECT_GT(InspectorDriver::differing(labels, driver.ui.image()), 2000);
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

TEST_F(InspectorViewTest, ARunThatChangesPlannersKeepsAStageThatBothHave) {
  const std::string mixed = *folder_ / "mixed.vantage";
  testing::recordRun(testing::ballScene(),
                     {"exploration.steps=2", "exploration.planner=contour,hierarchical"}, mixed);
  InspectorDriver driver;
  driver.open(mixed);
  for (const auto& [stage, found] :
       {std::pair{"path", "path"}, {"scores", "scores"}, {"segments", "overview"}}) {
    driver.ui.press({Key::Home});
    driver.ui.settle();
    driver.ui.click(std::string("timeline/stage ") + stage);
    driver.ui.press({Key::Right});
    driver.ui.settle();
    ASSERT_EQ(driver.model().shown().record->step, 2);
    const auto& stages = driver.model().stages();
    ASSERT_LT(driver.model().place().stage, static_cast<int>(stages.size()));
    EXPECT_EQ(stages[driver.model().place().stage].name, found);
    EXPECT_EQ(driver.inspector.preferences().view.layers, stages[driver.model().place().stage].layers);
  }
}

TEST_F(InspectorViewTest, ParametersThatAreOpenedWithARunWaitForIt) {
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

TEST_F(InspectorViewTest, ViewsOfATableAreShownOverTheStep) {
  InspectorDriver driver;
  driver.open(run());
  const std::string table = *folder_ / "views.csv";
  test::writeFile(table, "id,x_m,y_m,z_m,qx,qy,qz,qw\n0,0.5,0,0.5,0,0,0,1\n1,0.4,0.1,0.5,0,0,0,1\n");
  driver.open(table);
  EXPECT_THAT(driver.notices(), HasSubstr("2 views of views.csv"));
  ASSERT_TRUE(driver.model().shown().record->positions);
  EXPECT_EQ(driver.model().shown().record->positions->size(), 2u);
}

TEST_F(InspectorViewTest, AHeldKeyTurnsTheSceneButSavesOnePicture) {
  InspectorDriver driver;
  driver.open(run());
  EXPECT_TRUE(driver.inspector.commands().find("view.left")->repeats);
  EXPECT_FALSE(driver.inspector.commands().find("file.screenshot")->repeats);
  EXPECT_FALSE(driver.inspector.commands().find("timeline.play")->repeats);
}

TEST_F(InspectorViewTest, TheEyeIsPlacedAfterTheShownStepWasReplaced) {
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

TEST_F(InspectorViewTest, WhatIsTypedIntoAFieldCountsWhenTheFieldIsLeftAndNotAfterEscape) {
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

TEST_F(InspectorViewTest, TabGoesFromFieldToFieldAndNeverIntoASlider) {
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

TEST_F(InspectorViewTest, ARunThatIsDeletedAndWrittenAgainIsOpenedAgain) {
  const std::string copy = *folder_ / "again.vantage";
  std::filesystem::copy_file(run(), copy, std::filesystem::copy_options::overwrite_existing);
  InspectorDriver driver;
  driver.open(copy);
  const auto waitFor = [&](const std::string& words) {
    for (int i = 0; i < 60 && driver.notices().find(words) == std::string::npos; ++i) {
      driver.ui.frame(0.25);
      driver.ui.settle();
    }
    EXPECT_THAT(driver.notices(), HasSubstr(words));
  };
  std::filesystem::remove(copy);
  waitFor("again.vantage is gone");
  std::filesystem::copy_file(run(), copy);
  waitFor("written anew");
  driver.ui.settle();
  EXPECT_EQ(driver.model().place().step, 0);
  EXPECT_FALSE(driver.model().shown().empty());
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

TEST_F(InspectorViewTest, APictureOfOtherParametersSaysSo) {
  InspectorDriver driver;
  driver.open(run());
  driver.ui.click("tab/What if");
  driver.ui.enter("what-if/saliency.isolation_distance_m/text", "31");
  driver.ui.settle();
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder_->path());
  driver.ui.click("status/save picture");
  std::filesystem::current_path(before);
  EXPECT_EQ(driver.picture_title, "saliency.isolation_distance_m = 0.031");
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

TEST_F(InspectorViewTest, ARunThatIsWholeAndThenDeletedIsTold) {
  const std::string copy = *folder_ / "copy.vantage";
  std::filesystem::copy_file(run(), copy, std::filesystem::copy_options::overwrite_existing);
  InspectorDriver driver;
  driver.open(copy);
  std::filesystem::remove(copy);
  for (int i = 0; i < 60 && driver.notices().empty(); ++i) {
    driver.ui.frame(0.25);
    driver.ui.settle();
  }
  EXPECT_THAT(driver.notices(), HasSubstr("copy.vantage is gone"));
  EXPECT_FALSE(driver.model().shown().empty());
}

TEST_F(InspectorViewTest, ARunFromANewerVersionIsToldAndWhatIsOpenStays) {
  const std::string newer = *folder_ / "newer.vantage";
  std::string bytes = test::readFile(run());
  constexpr std::size_t kUserVersion = 60;  // in the header of an SQLite file, four bytes, high ones first
  bytes.replace(kUserVersion, 4, std::string("\0\0\0\x63", 4));
  test::writeFile(newer, bytes);
  InspectorDriver driver;
  driver.open(run());
  driver.open(newer);
  EXPECT_THAT(driver.notices(), HasSubstr("newer.vantage: has version 99"));
  EXPECT_EQ(driver.model().file().filename(), "ball.vantage");
  EXPECT_FALSE(driver.model().shown().empty());
}

TEST_F(InspectorViewTest, WatchingARunThatIsWholeDrawsNothing) {
  InspectorDriver driver;
  driver.open(run());
  const std::uint64_t before = driver.inspector.picturesRendered();
  bool changed = false;
  for (int i = 0; i < 100; ++i) {
    changed |= driver.inspector.update(0.25);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_FALSE(changed) << "a window would draw a frame";
  EXPECT_EQ(driver.inspector.picturesRendered(), before);
}

TEST_F(InspectorViewTest, AFileWithoutAPlanShowsWhatItHolds) {
  InspectorDriver driver;
  driver.open(testing::ballScene());
  EXPECT_TRUE(driver.inspector.preferences().view.layers.has(Layer::Truth));
  driver.open(run());
  EXPECT_FALSE(driver.inspector.preferences().view.layers.has(Layer::Truth));
}

}  // namespace
}  // namespace vantage
