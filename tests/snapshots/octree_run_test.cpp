// Pictures of runs whose steps were planned on the octree, on both maps, and of two runs side by side.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "io/error.h"
#include "snapshots/comparison.h"
#include "snapshots/snapshot.h"
#include "snapshots/step_maps.h"
#include "tests/support/synthetic_record.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Three run files of one scene: contour, hierarchical, and the first step contour, the second hierarchical.
class OctreeRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    unsetenv("DISPLAY");
    folder_ = fs::temp_directory_path() / ("vantage-octree-runs-" + std::to_string(getpid()));
    fs::create_directories(folder_);
    const test::SyntheticRun contour = test::makeSyntheticRun();
    const test::SyntheticOctreeRun octree = test::makeSyntheticOctreeRun();
    write("contour", contour.header, {contour.record});
    write("octree", octree.header, {octree.record});
    RunHeader both = octree.header;
    both.planner = "contour,hierarchical";
    StepRecord first = contour.record, second = octree.record;
    first.changed_octree_bricks = second.changed_octree_bricks;
    second.step = 2;
    second.changed_octree_bricks = std::make_shared<std::vector<OctreeBrick>>();
    second.changed_bricks = std::make_shared<std::vector<TsdfBrick>>();
    write("both", both, {first, second});
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static void write(const std::string& name, const RunHeader& header,
                    const std::vector<StepRecord>& records) {
    RunWriter writer(runPath(name), header);
    for (const StepRecord& record : records) writer.write(record);
    writer.finish("steps done");
  }
  static fs::path runPath(const std::string& name) { return folder_ / (name + ".vantage"); }

  static SnapshotRequest request(const std::string& output, std::vector<std::string> recipes = {}) {
    SnapshotRequest wanted;
    wanted.width = 320;
    wanted.height = 200;
    wanted.output = (folder_ / output).string();
    wanted.recipes = std::move(recipes);
    return wanted;
  }
  static std::set<std::string> namesIn(const std::vector<fs::path>& files) {
    std::set<std::string> names;
    for (const fs::path& file : files) {
      EXPECT_GT(fs::file_size(file), 1000u) << file;
      names.insert(file.filename().string());
    }
    return names;
  }
  static std::string messageOf(const auto& act) {
    try {
      act();
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no error";
  }

  static inline fs::path folder_;
};

std::string bytesOf(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(OctreeRun, EachStepHasThePicturesOfItsPlanner) {
  using testing::ElementsAre;
  EXPECT_THAT(namesIn(takeSnapshots(runPath("octree"), request("one"))),
              ElementsAre("octree-sheet.png", "octree-step01-octree.png", "octree-step01-rays.png",
                          "octree-step01-scene.png", "octree-step01-states.png", "octree-step01-utility.png",
                          "octree-step01-views.png"));
  EXPECT_THAT(namesIn(takeSnapshots(runPath("both"), request("two"))),
              ElementsAre("both-sheet.png", "both-step01-contours.png", "both-step01-scene.png",
                          "both-step01-segments.png", "both-step01-states.png", "both-step01-views.png",
                          "both-step02-octree.png", "both-step02-rays.png", "both-step02-scene.png",
                          "both-step02-states.png", "both-step02-utility.png", "both-step02-views.png"));
}

TEST_F(OctreeRun, ProductOfTheOtherPlannerIsAPictureThatSaysSo) {
  EXPECT_EQ(takeSnapshots(runPath("contour"), request("c.png", {"utility"})).size(), 1u);
  EXPECT_EQ(takeSnapshots(runPath("octree"), request("d.png", {"contours"})).size(), 1u);
}

TEST_F(OctreeRun, StatesComeFromTheMapOfTheStep) {
  const RunReader reader(runPath("both"));
  StepMaps maps(reader);
  const StepRecord first = reader.step(1, RunDetail::NoVolume), second = reader.step(2, RunDetail::NoVolume);
  EXPECT_EQ(maps.at(first).states.geometry(), reader.header().volume);
  EXPECT_EQ(maps.at(first).pyramid, nullptr);
  const SceneFrame frame = maps.at(second);
  ASSERT_NE(frame.pyramid, nullptr);
  const test::SyntheticOctreeRun made = test::makeSyntheticOctreeRun();
  ASSERT_EQ(frame.states.geometry(), made.pyramid.finest().geometry());
  EXPECT_TRUE(std::ranges::equal(frame.states.states(), made.pyramid.finest().states()));
  EXPECT_TRUE(std::ranges::equal(frame.pyramid->level(3).states(), made.pyramid.level(3).states()));
}

TEST_F(OctreeRun, StyleSettingsChangeThePicture) {
  SnapshotRequest wanted = request("level.png", {"octree"});
  takeSnapshots(runPath("octree"), wanted);
  const std::string before = bytesOf(folder_ / "level.png");
  wanted.style = {"octree_level=3"};
  takeSnapshots(runPath("octree"), wanted);
  EXPECT_NE(bytesOf(folder_ / "level.png"), before);
  const auto messageFor = [&](const std::string& setting, const std::string& recipe) {
    SnapshotRequest wrong = request("wrong.png", {recipe});
    wrong.style = {setting};
    return messageOf([&] { takeSnapshots(runPath("octree"), wrong); });
  };
  EXPECT_THAT(messageFor("octree_level=9", "octree"), HasSubstr("allowed: 0 .. 8"));
  EXPECT_THAT(messageFor("octree_lvel=2", "octree"), HasSubstr("did you mean 'octree_level'?"));
  EXPECT_THAT(messageFor("utility_factor=distanc", "utility"), HasSubstr("did you mean 'distance'?"));
  EXPECT_THAT(messageFor("view_id=320", "rays"), HasSubstr("no candidate of step 1; allowed: 0 .. 319"));
  EXPECT_THAT(messageFor("octree_level", "octree"), HasSubstr("KEY=VALUE"));
}

TEST_F(OctreeRun, TwoRunsOfOneSceneAreSetSideBySide) {
  ComparisonRequest wanted;
  wanted.output = (folder_ / "compared").string();
  const auto files = takeComparison(runPath("contour"), runPath("both"), wanted);
  EXPECT_THAT(namesIn(files), testing::ElementsAre("contour-both.png"));
  wanted.output = (folder_ / "named.png").string();
  wanted.step = 2;  // which the first run lacks
  wanted.recipes = {"utility"};
  EXPECT_THAT(namesIn(takeComparison(runPath("contour"), runPath("both"), wanted)),
              testing::ElementsAre("named.png"));
  wanted.step = 3;
  EXPECT_THAT(messageOf([&] { takeComparison(runPath("contour"), runPath("both"), wanted); }),
              HasSubstr("step 3: neither of the runs has it"));
}

TEST_F(OctreeRun, RunsOfDifferentScenesAreNotCompared) {
  test::SyntheticRun other = test::makeEmptyRun();
  other.header.input = "elsewhere";
  other.record.stage = Stage::Done;
  write("other", other.header, {other.record});
  ComparisonRequest wanted;
  wanted.output = (folder_ / "x.png").string();
  EXPECT_THAT(messageOf([&] { takeComparison(runPath("octree"), runPath("other"), wanted); }),
              HasSubstr("compare runs of one scene"));
}

TEST(Recipes, FitTheirPlanner) {
  for (const PlannerKind kind : kPlannerKinds) {
    for (const std::string& name : defaultRecipes(kind)) EXPECT_TRUE(recipeNamed(name).fits(kind)) << name;
  }
  EXPECT_FALSE(recipeNamed("rays").fits(PlannerKind::Contour));
  EXPECT_FALSE(recipeNamed("segments").fits(PlannerKind::Uniform));
  EXPECT_FALSE(recipeNamed("octree").planning());  // the map after the last scan has it
  EXPECT_TRUE(recipeNamed("utility").planning());
  RunHeader header;
  header.planner = "contour,hierarchical";
  EXPECT_EQ(defaultRecipesOf(header).size(), 8u);
}

}  // namespace
}  // namespace vantage
