// The hierarchical planner and runs of several planners, as users meet them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace vantage::test {
namespace {

using Json = nlohmann::ordered_json;

/// Short explorations of the smallest scene serve all tests of this file.
class PlannerCommands : public testing::Test {
 protected:
  static std::string run(const std::string& planner) { return *folder_ / (planner + ".vantage"); }
  static ProcessResult explore(const std::string& planner, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"explore",   "box",
                                      "--planner", planner,
                                      "--steps",   "2",
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
}

TEST_F(PlannerCommands, CompareRefusesRunsOfDifferentScenesAndOutputsThatAreInputs) {
  const std::string other = *folder_ / "room.vantage";
  ASSERT_EQ(vantage({"explore", "room", "--steps", "0", "-o", other, "--set", "scan.initial_frames=1"}).code,
            0);
  expectRefused(vantage({"compare", run("contour"), other}), {"room.vantage", "is about room"});
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
