// What becomes of files that are opened, that change while they are looked at, or that are no good.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "tests/support/process.h"
#include "tests/viewer/ball_run.h"
#include "tests/viewer/inspector_driver.h"
#include "viewer/commands.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using testing::InspectorDriver;

class InspectorFilesTest : public testing::WithBallRun<3> {
 protected:
  /// Lets time pass until the window says that.
  static void waitFor(InspectorDriver& driver, const std::string& words) {
    for (int i = 0; i < 60 && driver.notices().find(words) == std::string::npos; ++i) {
      driver.ui.frame(0.25);
      driver.ui.settle();
    }
    EXPECT_THAT(driver.notices(), HasSubstr(words));
  }
};

TEST_F(InspectorFilesTest, AFileThatIsNoRunIsToldInTheWindow) {
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

TEST_F(InspectorFilesTest, ARunCutShortIsToldAndTheWindowLives) {
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

TEST_F(InspectorFilesTest, AStepThatCannotBeReadIsToldAndWhatIsShownStays) {
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

TEST_F(InspectorFilesTest, ParametersCanBeTriedOnAStepThatWasLeftForAnUnreadableOne) {
  const std::string copy = *folder_ / "copy.vantage";
  std::filesystem::copy_file(run(), copy, std::filesystem::copy_options::overwrite_existing);
  InspectorDriver driver;
  driver.inspector.open({copy});
  while (driver.model().recorded().empty()) driver.ui.frame();
  EXPECT_FALSE(driver.whatIf().ready()) << "it is being prepared";
  std::filesystem::resize_file(copy, std::filesystem::file_size(copy) / 2);
  driver.model().goToStep(2);
  driver.ui.settle();
  EXPECT_EQ(driver.model().place().step, 0);
  EXPECT_TRUE(driver.whatIf().ready()) << stateText(driver.whatIf());
}

TEST_F(InspectorFilesTest, APictureThatCannotBeNamedIsToldInTheWindow) {
  const std::string run_with_long_name = *folder_ / (std::string(245, 'r') + ".vantage");
  std::filesystem::copy_file(run(), run_with_long_name);
  InspectorDriver driver;
  driver.open(run_with_long_name);
  driver.ui.press({keyOf('S'), true});
  EXPECT_THAT(driver.notices(), HasSubstr("File name too long"));
}

TEST_F(InspectorFilesTest, ParametersThatAreDroppedWhereNothingWasPlannedAreToldSo) {
  const std::string config = *folder_ / "late.toml";
  test::writeFile(config, "[saliency]\nisolation_distance_m = 0.01\n");
  InspectorDriver driver;
  driver.open(run());
  driver.ui.press({Key::End});
  driver.ui.settle();
  driver.open(config);
  EXPECT_THAT(driver.notices(), HasSubstr("nothing was planned"));
}

TEST_F(InspectorFilesTest, ARunThatComesBackIsFollowedAgain) {
  const std::string copy = *folder_ / "moved.vantage", away = *folder_ / "away.vantage";
  std::filesystem::copy_file(run(), copy);
  InspectorDriver driver;
  driver.open(copy);
  std::filesystem::rename(copy, away);
  waitFor(driver, "moved.vantage is gone");
  std::filesystem::rename(away, copy);
  waitFor(driver, "moved.vantage can be read again");
}

TEST_F(InspectorFilesTest, ARunFromANewerVersionIsToldAndWhatIsOpenStays) {
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

TEST_F(InspectorFilesTest, ARunThatIsDeletedAndWrittenAgainIsOpenedAgain) {
  const std::string copy = *folder_ / "again.vantage";
  std::filesystem::copy_file(run(), copy, std::filesystem::copy_options::overwrite_existing);
  InspectorDriver driver;
  driver.open(copy);
  std::filesystem::remove(copy);
  waitFor(driver, "again.vantage is gone");
  std::filesystem::copy_file(run(), copy);
  waitFor(driver, "written anew");
  driver.ui.settle();
  EXPECT_EQ(driver.model().place().step, 0);
  EXPECT_FALSE(driver.model().shown().empty());
}

TEST_F(InspectorFilesTest, ARunThatIsWholeAndThenDeletedIsTold) {
  const std::string copy = *folder_ / "copy.vantage";
  std::filesystem::copy_file(run(), copy, std::filesystem::copy_options::overwrite_existing);
  InspectorDriver driver;
  driver.open(copy);
  std::filesystem::remove(copy);
  waitFor(driver, "copy.vantage is gone");
  EXPECT_FALSE(driver.model().shown().empty());
}

TEST_F(InspectorFilesTest, WatchingARunThatIsWholeDrawsNothing) {
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

TEST_F(InspectorFilesTest, AFileWithoutAPlanShowsWhatItHolds) {
  InspectorDriver driver;
  driver.open(testing::ballScene());
  EXPECT_TRUE(driver.inspector.preferences().view.layers.has(Layer::Truth));
  driver.open(run());
  EXPECT_FALSE(driver.inspector.preferences().view.layers.has(Layer::Truth));
}

TEST_F(InspectorFilesTest, ViewsOfATableAreShownOverTheStep) {
  InspectorDriver driver;
  driver.open(run());
  const std::string table = *folder_ / "views.csv";
  test::writeFile(table, "id,x_m,y_m,z_m,qx,qy,qz,qw\n0,0.5,0,0.5,0,0,0,1\n1,0.4,0.1,0.5,0,0,0,1\n");
  driver.open(table);
  EXPECT_THAT(driver.notices(), HasSubstr("2 views of views.csv"));
  ASSERT_TRUE(driver.model().shown().record->positions);
  EXPECT_EQ(driver.model().shown().record->positions->size(), 2u);
}

TEST_F(InspectorFilesTest, ARunThatChangesPlannersKeepsAStageThatBothHave) {
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

}  // namespace
}  // namespace vantage
