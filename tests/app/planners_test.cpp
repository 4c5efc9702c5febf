// The hierarchical planner and runs of several planners, as users meet them.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace vantage::test {
namespace {

using Json = nlohmann::ordered_json;

/// Short explorations of the smallest scene serve all tests of this file.
class PlannerCommands : public testing::Test {
 protected:
  static std::string run(const std::string& planner) { return *folder_ / (planner + ".vantage"); }
  static ProcessResult explore(const std::string& planner, std::vector<std::string> more = {},
                               const std::string& steps = "2") {
    std::vector<std::string> words = {"explore",   "box",
                                      "--planner", planner,
                                      "--steps",   steps,
                                      "-o",        run(planner),
                                      "--json",    *folder_ / (planner + ".json"),
                                      "--set",     "scan.initial_frames=6",
                                      "--set",     "scan.frames=2",
                                      "--set",     "utility.min_occupied=100"};
    words.insert(words.end(), more.begin(), more.end());
    return vantage(words);
  }
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    hierarchical_ = explore("hierarchical");
    contour_ = explore("contour");
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static Json json(const std::string& planner) {
    return Json::parse(readFile(*folder_ / (planner + ".json")));
  }

  static TemporaryFolder* folder_;
  static ProcessResult hierarchical_, contour_;
};
TemporaryFolder* PlannerCommands::folder_ = nullptr;
ProcessResult PlannerCommands::hierarchical_, PlannerCommands::contour_;

TEST_F(PlannerCommands, HierarchicalExplorationHasTheFieldsOfTheContract) {
  ASSERT_EQ(hierarchical_.code, 0) << hierarchical_.err;
  EXPECT_NE(hierarchical_.out.find("rejected by position"), std::string::npos) << hierarchical_.out;
  const Json run = json("hierarchical");
  EXPECT_EQ(run["planner"], "hierarchical");
  ASSERT_GE(run["steps"].size(), 1u);
  const Json& step = run["steps"][0];
  ASSERT_EQ(step["status"], "view") << hierarchical_.out;
  EXPECT_EQ(step["poses_generated"], 320u);
  EXPECT_GT(step["rejected_position"], 0u);
  EXPECT_GE(step["occupied"], 100.0);
  EXPECT_GT(step["distance"], 0.0);
  EXPECT_LE(step["distance"], 1.0);
  EXPECT_GT(step["gain"], 0.0);
  EXPECT_GT(step["gain_voxels"], 0u);
  EXPECT_GT(step["rays"], 0u);
  EXPECT_GT(step["coverage"], 0.1);
  EXPECT_GT(step["timings_s"]["evaluation"], 0.0);
  EXPECT_TRUE(step["timings_s"]["contours"].is_null());
  EXPECT_TRUE(step["segment"].is_null());
}

TEST_F(PlannerCommands, PlanOnARecordedStepChoosesTheRecordedView) {
  ASSERT_EQ(hierarchical_.code, 0) << hierarchical_.err;
  const std::string plan = *folder_ / "plan.csv", file = *folder_ / "plan.json";
  const ProcessResult result = vantage({"plan", run("hierarchical") + "#1", "-o", plan, "--json", file});
  ASSERT_EQ(result.code, 0) << result.err;
  const Json planned = Json::parse(readFile(file)), recorded = json("hierarchical")["steps"][0];
  EXPECT_EQ(planned["position_m"], recorded["position_m"]);
  EXPECT_EQ(planned["gain"], recorded["gain"]);
  EXPECT_EQ(planned["utility"], recorded["utility"]);
  EXPECT_EQ(lines(readFile(plan)).size(), 321u);
}

TEST_F(PlannerCommands, PlanOnAReplayedStepChoosesTheRecordedView) {
  const std::string tray = std::string(VANTAGE_TEST_DATA) + "/rgbd_ur5_tray";
  if (!std::filesystem::exists(tray)) GTEST_SKIP() << "recorded data set not here: " << tray;
  const std::string run = *folder_ / "tray.vantage", file = *folder_ / "plan.json";
  // Views are offered only where a frame is left; recorded poses are candidates, and one of them is chosen.
  const ProcessResult explored = vantage(
      {"explore", tray, "--planner", "hierarchical", "--steps", "1", "-o", run, "--json",
       *folder_ / "tray.json", "--set", "dataset.serve_distance_m=0.02", "--set", "utility.min_occupied=50"});
  ASSERT_EQ(explored.code, 0) << explored.err;
  const Json steps = Json::parse(readFile(*folder_ / "tray.json"))["steps"];
  ASSERT_EQ(steps.size(), 1u) << explored.out;
  ASSERT_GT(steps[0]["poses_unreachable"], 0) << "no view was beyond the frames that are left";
  const ProcessResult planned = vantage({"plan", run + "#1", "--json", file});
  ASSERT_EQ(planned.code, 0) << planned.err;
  const Json plan = Json::parse(readFile(file));
  ASSERT_EQ(steps[0]["status"], "view") << explored.out;
  for (const char* key :
       {"status", "position_m", "quaternion_xyzw", "gain", "utility", "poses_generated", "poses_unreachable",
        "rejected_position", "rejected_registration", "unknown_voxels"})
    EXPECT_EQ(plan[key], steps[0][key]) << key;
  EXPECT_GT(plan["poses_generated"], 320u);  // the poses left are among them
  // The map after the last scan has no candidates of its own; the recording tells what is left.
  ASSERT_EQ(vantage({"plan", run + "#end", "--json", file}).code, 0);
  EXPECT_EQ(Json::parse(readFile(file))["poses_generated"], steps[0]["poses_generated"].get<int>() - 1);
}

TEST_F(PlannerCommands, PlanTakesOnePlannerAndABoxInTheMap) {
  ASSERT_EQ(hierarchical_.code, 0) << hierarchical_.err;
  const std::string step = run("hierarchical") + "#1";
  expectRefused(vantage({"plan", step, "--planner", "uniform,hierarchical"}), {"--planner", "name one"});
  const auto withBox = [&](const std::string& low, const std::string& high) {
    return vantage({"plan", step, "--json", *folder_ / "plan.json", "--set", "octree.object_min_m=" + low,
                    "--set", "octree.object_max_m=" + high});
  };
  expectRefused(withBox("[0.1,0.1,0.1]", "[0,0,0.3]"), {"octree.object_min_m", "not below"});
  expectRefused(withBox("[90,90,90]", "[91,91,91]"), {"octree.object_min_m", "outside the map"});
  const ProcessResult small = withBox("[-0.01,-0.01,0]", "[0.01,0.01,0.02]");
  ASSERT_EQ(small.code, 0) << small.err;
  EXPECT_LE(Json::parse(readFile(*folder_ / "plan.json"))["gain_voxels"].is_null()
                ? 0
                : Json::parse(readFile(*folder_ / "plan.json"))["gain_voxels"].get<int>(),
            8);
}

TEST_F(PlannerCommands, ACollisionCellBelowTheVoxelsIsNamedBeforeARunIsMade) {
  const ProcessResult result = explore("uniform", {"--set", "octree.voxel_size_m=0.05"});
  expectRefused(result, {"robot.cell_m = 0.04", "0.05"});
  EXPECT_FALSE(std::filesystem::exists(run("uniform")));
  expectRefused(vantage({"plan", run("hierarchical") + "#1", "--set", "robot.cell_m=0.008", "--set",
                         "robot.check_step_m=0.004"}),
                {"robot.cell_m"});
}

TEST_F(PlannerCommands, AnObjectOutsideTheMapIsWarnedOf) {
  const ProcessResult result = explore(
      "uniform", {"--set", "octree.object_min_m=[90,90,90]", "--set", "octree.object_max_m=[91,91,91]"}, "1");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.err.find("vantage: warning: octree.object_min_m"), std::string::npos) << result.err;
}

TEST_F(PlannerCommands, UniformSaysNothingOfCoarseLevels) {
  const ProcessResult result = explore("uniform", {}, "1");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("utility: every ray"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("coarse level"), std::string::npos) << result.out;
  EXPECT_NE(hierarchical_.out.find("utility: 2 coarse levels"), std::string::npos) << hierarchical_.out;
  EXPECT_NE(result.out.find(" after 1 step;"), std::string::npos) << result.out;
}

TEST_F(PlannerCommands, PlanRefusesAMapThatThePlannerCannotUse) {
  expectRefused(vantage({"plan", run("hierarchical") + "#1", "--planner", "contour"}), {"holds no TSDF"});
  expectRefused(vantage({"plan", run("contour") + "#1", "--planner", "uniform"}), {"holds no octree"});
}

TEST_F(PlannerCommands, ARunChangesPlannersFromViewToView) {
  const ProcessResult result = explore("uniform,contour");
  ASSERT_EQ(result.code, 0) << result.err;
  const Json run = json("uniform,contour");
  ASSERT_EQ(run["steps"].size(), 2u) << result.out;
  EXPECT_EQ(run["steps"][0]["planner"], "uniform");
  EXPECT_EQ(run["steps"][1]["planner"], "contour");
  EXPECT_TRUE(run["steps"][1]["rejected_position"].is_null());
}

TEST_F(PlannerCommands, RunsOfOneSceneAreComparedStepByStep) {
  ASSERT_EQ(contour_.code, 0) << contour_.err;
  const std::string table = *folder_ / "steps.csv", sheet = *folder_ / "sheet.png";
  const ProcessResult result =
      vantage({"compare", run("contour"), run("hierarchical"), "-o", table, "--picture", sheet});
  ASSERT_EQ(result.code, 0) << result.err;
  const std::vector<std::string> rows = lines(readFile(table));
  ASSERT_GE(rows.size(), 5u);
  EXPECT_EQ(rows[0],
            "step,run,planner,coverage,unknown_near_objects_dm3,unknown_in_boxes_dm3,nbv_s,rays,path_m");
  EXPECT_NE(rows[1].find(",contour,"), std::string::npos) << rows[1];
  EXPECT_NE(rows[2].find(",hierarchical,"), std::string::npos) << rows[2];
  EXPECT_EQ(readFile(sheet).substr(1, 3), "PNG");
  // Not the same map, not the same voxels: said once each.
  EXPECT_NE(result.out.find("note: measured on different maps (run 1: TSDF, run 2: octree)"),
            std::string::npos);
  EXPECT_NE(result.out.find("note: voxel sizes differ (run 1: 5.9 mm, run 2: 1 cm)"), std::string::npos);
  EXPECT_EQ(result.out.find("seeds differ"), std::string::npos) << result.out;
}

TEST_F(PlannerCommands, CompareQuotesPathsWithACommaAndWritesWhereAFolderIs) {
  const std::string comma = *folder_ / "a, b.vantage";
  std::filesystem::copy_file(run("contour"), comma);
  const ProcessResult result = vantage({"compare", comma, run("hierarchical"), "-o", "-"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(lines(result.out).at(1).rfind("1,\"" + comma + "\",contour,", 0), 0u) << result.out;
  expectRefused(vantage({"compare", comma, comma}), {"a, b.vantage", "is named twice"});
  const std::vector<std::string> both = {"compare", run("contour"), run("hierarchical"), "--picture"};
  const auto picture = [&](const std::string& name) {
    std::vector<std::string> words = both;
    words.push_back(*folder_ / name);
    return vantage(words);
  };
  expectRefused(picture("sheet.jpg"), {"--picture", "sheet.jpg", ".png"});
  expectRefused(picture("none/sheet.png"), {"none/sheet.png", "cannot be created"});
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "sheet.jpg"));
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "none"));
}

TEST_F(PlannerCommands, CompareRefusesRunsOfDifferentScenesAndOutputsThatAreInputs) {
  const std::string other = *folder_ / "room.vantage";
  ASSERT_EQ(vantage({"explore", "room", "--steps", "0", "-o", other, "--set", "scan.initial_frames=1"}).code,
            0);
  expectRefused(vantage({"compare", run("contour"), other}), {"room.vantage", "is about 'room'"});
  expectRefused(vantage({"compare", run("contour"), run("hierarchical"), "-o", run("contour")}),
                {"same file"});
  expectRefused(vantage({"compare", run("contour")}), {"compare"});
}

TEST_F(PlannerCommands, UnknownPlannersAreRefusedWithTheKnownOnes) {
  for (const char* planner : {"hierarchicl", "contour,", ",", "contour,magic"})
    expectRefused(vantage({"explore", "box", "--planner", planner}), {"is no planner", "hierarchical"});
}

TEST_F(PlannerCommands, SettingsOutOfRangeAreRefused) {
  expectRefused(explore("hierarchical", {"--set", "rays.coarse_levels=8"}),
                {"rays.coarse_levels", "allowed"});
  expectRefused(explore("hierarchical", {"--set", "octree.voxel_size_m=0"}),
                {"octree.voxel_size_m", "allowed"});
  expectRefused(explore("hierarchical", {"--set", "rays.max_range_m=0.2"}), {"range"});
  expectRefused(explore("hierarchical", {"--set", "rays.count=voxels"}), {"rays.refine_unknown"});
}

}  // namespace
}  // namespace vantage::test
