// Pictures of runs whose steps were planned on the octree, on both maps, and of two runs side by side.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "io/error.h"
#include "snapshots/comparison.h"
#include "snapshots/snapshot.h"
#include "tests/support/synthetic_record.h"
#include "viewer/run_session.h"

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

TEST_F(OctreeRun, ProductsOfTheOtherPlannerAreRefused) {
  const auto messageFor = [&](const std::string& run, const std::string& recipe, std::optional<int> step) {
    SnapshotRequest wanted = request("foreign.png", {recipe});
    wanted.step = step;
    return messageOf([&] { takeSnapshots(runPath(run), wanted); });
  };
  for (const char* recipe : {"octree", "rays", "utility"})
    EXPECT_THAT(messageFor("contour", recipe, 1),
                testing::AllOf(HasSubstr(std::string("recipe '") + recipe + "'"), HasSubstr("step 1"),
                               HasSubstr("contour planner; try scene, states, contours")));
  for (const char* recipe : {"contours", "segments", "normals", "poses", "labels"})
    EXPECT_THAT(messageFor("octree", recipe, 1),
                HasSubstr("hierarchical planner; try scene, states, octree"));
  EXPECT_THAT(messageFor("contour", "utility", std::nullopt), HasSubstr("no step has anything of it"));
  EXPECT_FALSE(fs::exists(folder_ / "foreign.png"));
  // Of a run of both planners the steps that have it are drawn; an overview is of either.
  EXPECT_THAT(namesIn(takeSnapshots(runPath("both"), request("some", {"utility"}))),
              testing::Contains("both-step02-utility.png"));
  EXPECT_EQ(messageFor("octree", "overview", 1), "no error");
  EXPECT_EQ(messageFor("octree", "counted", 1), "no error");
}

TEST_F(OctreeRun, ViewIdIsForPicturesOfRays) {
  SnapshotRequest wanted = request("rays17.png", {"utility"});
  wanted.style = {"view_id=17"};
  EXPECT_THAT(messageOf([&] { takeSnapshots(runPath("octree"), wanted); }),
              testing::AllOf(HasSubstr("view_id"), HasSubstr("'utility'"), HasSubstr("try recipe rays")));
  wanted.recipes = {"rays"};
  EXPECT_EQ(takeSnapshots(runPath("octree"), wanted).size(), 1u);
}

TEST_F(OctreeRun, AFileIsWrittenWhereAFolderIs) {
  EXPECT_THAT(messageOf([&] { takeSnapshots(runPath("octree"), request("none/a.png", {"states"})); }),
              testing::AllOf(HasSubstr("none/a.png"), HasSubstr("there is no folder")));
  EXPECT_FALSE(fs::exists(folder_ / "none"));
}

TEST_F(OctreeRun, StatesComeFromTheMapOfTheStep) {
  RunSession session(runPath("both"));
  const StepData first = session.load(1), second = session.load(2);
  EXPECT_EQ(first.states->geometry(), session.header()->volume);
  EXPECT_EQ(first.pyramid, nullptr);
  const SceneFrame frame = second.frame();
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

TEST(Comparison, NamesWhatElseDiffers) {
  RunHeader a, b;
  a.planner = b.planner = "contour";
  a.volume.voxel_size_m = b.volume.voxel_size_m = 0.005;
  a.seed = b.seed = 1;
  EXPECT_THAT(differencesOf({a, b}), testing::IsEmpty());
  b.planner = "hierarchical";
  b.octree.emplace().map.voxel_size_m = 0.01;
  b.seed = 7;
  EXPECT_THAT(differencesOf({a, b}),
              testing::ElementsAre("measured on different maps (run 1: TSDF, run 2: octree)",
                                   "voxel sizes differ (run 1: 5 mm, run 2: 1 cm)",
                                   "seeds differ (run 1: 1, run 2: 7)"));
  b.planner = "contour,hierarchical";  // keeps the TSDF too
  EXPECT_THAT(differencesOf({a, b}), testing::ElementsAre("seeds differ (run 1: 1, run 2: 7)"));
}

TEST(Comparison, OneRecordingIsOneSceneHoweverItsPathIsSpelt) {
  RunHeader a, b;
  a.replay = b.replay = true;
  a.input = "recordings/tray";
  for (const std::string& same :
       {std::string("./recordings/tray/"), (fs::current_path() / "recordings/tray").string()}) {
    b.input = same;
    EXPECT_NO_THROW(requireOneScene({"a", "b"}, {a, b})) << same;
  }
  b.input = "recordings/room";
  EXPECT_THROW(requireOneScene({"a", "b"}, {a, b}), InputError);
  b.input = a.input;  // the scene of that name was changed
  a.truth.vertices = b.truth.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  a.truth.triangles = b.truth.triangles = {{0, 1, 2}};
  EXPECT_NO_THROW(requireOneScene({"a", "b"}, {a, b}));
  b.truth.vertices[1].x() = 2;
  EXPECT_THROW(requireOneScene({"a", "b"}, {a, b}), InputError);
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
