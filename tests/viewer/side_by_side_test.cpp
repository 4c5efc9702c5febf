// Two files side by side.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"
#include "tests/support/recorded_run.h"
#include "tests/viewer/inspector_driver.h"
#include "viewer/commands.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::InspectorDriver;

/// Records two runs of one scene once for all tests: with three steps and, of the other planner, with one.
class SideBySide : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    unsetenv("DISPLAY");
    folder_ = new test::TemporaryFolder;
    testing::recordRun(testing::ballScene(), {"exploration.steps=2"}, left());
    testing::recordRun(testing::ballScene(), {"exploration.steps=1", "exploration.planner=hierarchical"},
                       right());
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string left() { return *folder_ / "left.vantage"; }
  static std::string right() { return *folder_ / "right.vantage"; }
  static void openBoth(InspectorDriver& driver) {
    driver.inspector.open({left(), right()});
    driver.ui.settle();
  }
  static std::string fileOf(InspectorDriver& driver) { return driver.model().file().filename().string(); }

  static test::TemporaryFolder* folder_;
};
test::TemporaryFolder* SideBySide::folder_ = nullptr;

/// Pixels that differ in a widget's box.
int changed(InspectorDriver& driver, const RgbImage& before, const std::string& name) {
  const WidgetBox box = *driver.inspector.widgets().find(name);
  const RgbImage now = driver.ui.image();
  int count = 0;
  for (int y = static_cast<int>(box.top); y < static_cast<int>(box.bottom); ++y)
    for (int x = static_cast<int>(box.left); x < static_cast<int>(box.right); ++x)
      count += before.at(x, y) != now.at(x, y);
  return count;
}

TEST_F(SideBySide, TwoRunsHaveAViewEachAndTheFirstIsActive) {
  InspectorDriver driver;
  openBoth(driver);
  ASSERT_TRUE(driver.ui.has("view"));
  ASSERT_TRUE(driver.ui.has("view 2"));
  EXPECT_LE(driver.inspector.widgets().find("view")->right, driver.inspector.widgets().find("view 2")->left);
  EXPECT_TRUE(driver.ui.has("view 2/inset"));
  EXPECT_EQ(fileOf(driver), "left.vantage");
  EXPECT_EQ(driver.notices(), "");
}

TEST_F(SideBySide, AClickIntoTheOtherViewMakesItActive) {
  InspectorDriver driver;
  openBoth(driver);
  driver.ui.click("view 2");
  driver.ui.settle();
  EXPECT_EQ(fileOf(driver), "right.vantage");
  driver.ui.press({keyOf('X')});
  driver.ui.settle();
  EXPECT_EQ(fileOf(driver), "left.vantage");
}

TEST_F(SideBySide, WhereOneViewIsTurnedTheOtherFollows) {
  InspectorDriver driver;
  openBoth(driver);
  driver.ui.moveMouse(5, 790);
  driver.ui.settle();
  for (const std::string mine : {"view", "view 2"}) {
    const RgbImage before = driver.ui.image();
    const Eye eye_before = *driver.inspector.preferences().eye;
    driver.ui.drag(mine, 0.5, 0.5, 0.9, 0.4);
    driver.ui.moveMouse(5, 790);
    driver.ui.settle();
    EXPECT_GT(changed(driver, before, "view"), 2000) << mine;
    EXPECT_GT(changed(driver, before, "view 2"), 2000) << mine;
    const Eye turned = *driver.inspector.preferences().eye;
    EXPECT_GT((turned.position - eye_before.position).norm(), 0.1) << mine;
    driver.ui.press({keyOf('X')});  // the other one is active, and it is its eye that is kept
    driver.ui.settle();
    EXPECT_EQ(*driver.inspector.preferences().eye, turned) << mine;
  }
}

TEST_F(SideBySide, BothShowTheSameStepAndStageAsFarAsTheyHaveThem) {
  InspectorDriver driver;
  openBoth(driver);
  driver.ui.click("timeline/stage fused");
  driver.ui.click("timeline/step 2");
  driver.ui.settle();
  driver.ui.press({keyOf('X')});
  driver.ui.frame();
  EXPECT_EQ(driver.model().place().step, 1) << "the map at the end is its second and last place";
  EXPECT_EQ(driver.model().stages()[driver.model().place().stage].name, "fused");
}

TEST_F(SideBySide, WhatPlaysGoesOnWhenTheOtherOneBecomesActive) {
  InspectorDriver driver;
  openBoth(driver);
  driver.ui.click("timeline/by stage");
  driver.ui.click("timeline/play");
  driver.ui.press({keyOf('X')});
  driver.ui.frame();
  EXPECT_EQ(fileOf(driver), "right.vantage");
  EXPECT_TRUE(driver.model().player.playing());
  EXPECT_TRUE(driver.model().player.by_stage);
  for (int i = 0; i < 200 && driver.model().player.playing(); ++i) driver.ui.frame(0.5);
  driver.ui.settle();
  EXPECT_EQ(driver.model().place().step, static_cast<int>(driver.model().steps().size()) - 1);
}

TEST_F(SideBySide, LayersThatWereSwitchedByHandStayWhenTheOtherOneBecomesActive) {
  InspectorDriver driver;
  openBoth(driver);
  driver.ui.click("timeline/stage fused");
  driver.ui.press({keyOf('6')});
  driver.ui.settle();
  const LayerSet mine = driver.inspector.preferences().view.layers;
  ASSERT_TRUE(mine.has(Layer::Surface));
  driver.ui.press({keyOf('X')});
  driver.ui.settle();
  EXPECT_EQ(driver.inspector.preferences().view.layers, mine);
}

TEST_F(SideBySide, AStageHasTheLayersOfItsOwnPlannerInEachView) {
  InspectorDriver driver;
  openBoth(driver);
  const LayerSet contour = driver.inspector.preferences().view.layers;
  driver.ui.press({keyOf('X')});
  driver.ui.settle();
  EXPECT_TRUE(driver.inspector.preferences().view.layers.has(Layer::ObjectBox));
  driver.ui.press({keyOf('X')});
  driver.ui.settle();
  EXPECT_EQ(driver.inspector.preferences().view.layers, contour);
}

TEST_F(SideBySide, TheOtherFileIsClosedAndTheWholeRoomIsUsedAgain) {
  InspectorDriver driver;
  driver.open(left());
  const WidgetBox alone = *driver.inspector.widgets().find("view");
  driver.inspector.open({left(), right()});
  driver.ui.settle();
  driver.ui.press({keyOf('X')});
  driver.ui.press({keyOf('W'), true});
  driver.ui.settle();
  EXPECT_EQ(fileOf(driver), "right.vantage");
  EXPECT_FALSE(driver.ui.has("view"));
  EXPECT_DOUBLE_EQ(driver.inspector.widgets().find("view 2")->right, alone.right);
  driver.ui.press({keyOf('X')});
  driver.ui.settle();
  EXPECT_EQ(fileOf(driver), "right.vantage");
}

TEST_F(SideBySide, WhatGoesWrongBesideIsTold) {
  InspectorDriver driver;
  test::writeFile(*folder_ / "cut.vantage", test::readFile(left()).substr(0, 5000));
  driver.inspector.open({left(), *folder_ / "cut.vantage"});
  driver.ui.settle();
  EXPECT_THAT(driver.notices(), HasSubstr("cut.vantage"));
  EXPECT_EQ(fileOf(driver), "left.vantage");
}

TEST_F(SideBySide, AThirdFileIsLeftOutAndParametersAreTriedOnTheActiveOne) {
  InspectorDriver driver;
  driver.inspector.open({left(), right(), left()});
  driver.ui.settle();
  EXPECT_THAT(driver.notices(), HasSubstr("left out"));
  test::writeFile(*folder_ / "try.toml", "[saliency]\nisolation_distance_m = 0.01\n");
  driver.open(*folder_ / "try.toml");
  EXPECT_DOUBLE_EQ(std::get<double>(driver.whatIf().edits().value("saliency.isolation_distance_m")), 0.01);
}

TEST_F(SideBySide, AStepThatTheOtherFileCannotGiveIsToldOnce) {
  const std::string cut = *folder_ / "cut.vantage";
  std::filesystem::copy_file(left(), cut, std::filesystem::copy_options::overwrite_existing);
  InspectorDriver driver;
  driver.inspector.open({left(), cut});
  driver.ui.settle();
  std::filesystem::resize_file(cut, std::filesystem::file_size(cut) / 2);
  driver.ui.press({Key::End});
  driver.ui.settle();  // it comes to rest
  EXPECT_TRUE(driver.model().shown().record->closing);
  EXPECT_THAT(driver.notices(), HasSubstr("cut.vantage"));
  driver.ui.click("notices/dismiss");
  driver.ui.settle();
  EXPECT_EQ(driver.notices(), "");
}

}  // namespace
}  // namespace vantage
