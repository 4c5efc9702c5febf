#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace vantage::test {
namespace {

using Json = nlohmann::ordered_json;

/// One short exploration of the smallest scene serves all tests of this file.
class ExploreCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    result_ = vantage({"explore", "box", "--steps", "2", "-o", *folder_ / "box.vantage", "--json",
                       *folder_ / "box.json", "--snapshots", *folder_ / "pictures"});
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static Json json() { return Json::parse(readFile(*folder_ / "box.json")); }

  static TemporaryFolder* folder_;
  static ProcessResult result_;
};
TemporaryFolder* ExploreCommand::folder_ = nullptr;
ProcessResult ExploreCommand::result_;

/// Everything but what depends on the clock and on the number of threads asked for.
std::string withoutTimings(const std::string& path) {
  Json json = Json::parse(readFile(path));
  json.erase("threads");
  for (Json& step : json["steps"]) step.erase("timings_s");
  return json.dump();
}

TEST_F(ExploreCommand, SucceedsAndSaysWhatItDid) {
  EXPECT_EQ(result_.code, 0) << result_.err;
  EXPECT_EQ(result_.err, "");
  EXPECT_NE(result_.out.find("step 1"), std::string::npos) << result_.out;
  EXPECT_NE(result_.out.find("threshold 175 rays"), std::string::npos) << result_.out;
}

TEST_F(ExploreCommand, JsonHasEveryKeyOfTheContract) {
  const Json run = json();
  for (const char* key :
       {"version", "input", "planner", "robot", "seed", "threads", "compute", "stop_reason", "steps"})
    EXPECT_TRUE(run.contains(key)) << key;
  EXPECT_EQ(run["planner"], "contour");
  EXPECT_EQ(run["stop_reason"], "steps done");
  ASSERT_EQ(run["steps"].size(), 2u);
  for (const Json& step : run["steps"]) {
    for (const char* key : {"step",
                            "status",
                            "position_m",
                            "quaternion_xyzw",
                            "gain",
                            "gain_voxels",
                            "realised_voxels",
                            "poses_generated",
                            "poses_scored",
                            "poses_unreachable",
                            "rays",
                            "voxels_visited",
                            "unknown_voxels",
                            "coverage",
                            "timings_s",
                            "segment",
                            "saliency",
                            "toward_object",
                            "unknown_near_objects",
                            "unknown_in_boxes"})
      EXPECT_TRUE(step.contains(key)) << key;
    for (const char* phase : {"sense", "filter", "fuse", "contours", "surface", "segmentation", "saliency",
                              "generation", "evaluation", "collision_map", "motion_planning", "motion"})
      EXPECT_TRUE(step["timings_s"].contains(phase)) << phase;
    EXPECT_TRUE(step["timings_s"]["filter"].is_null());
    EXPECT_EQ(step["status"], "view");
    EXPECT_GT(step["gain"], 175);  // the threshold of this scene
    EXPECT_EQ(step["poses_generated"].get<int>() % 40, 0);
    double norm = 0.0;
    for (const double q : step["quaternion_xyzw"]) norm += q * q;
    EXPECT_NEAR(norm, 1.0, 1e-9);
  }
  EXPECT_LT(run["final"]["unknown_near_objects"], run["steps"][0]["unknown_near_objects"]);
}

TEST_F(ExploreCommand, LeavesOneRunFileAndNoSideFiles) {
  EXPECT_TRUE(std::filesystem::exists(*folder_ / "box.vantage"));
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "box.vantage-wal"));
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "box.vantage-shm"));
  const ProcessResult rows =
      runProcess({"/usr/bin/sqlite3", *folder_ / "box.vantage", "select step from step order by step"});
  EXPECT_EQ(rows.out, "1\n2\n") << rows.err;
  const ProcessResult products = runProcess(
      {"/usr/bin/sqlite3", *folder_ / "box.vantage", "select count(*) > 10 from product where step = 1"});
  EXPECT_EQ(products.out, "1\n") << products.err;
}

TEST_F(ExploreCommand, EveryStepHasFivePicturesAndTheRunAContactSheet) {
  int pictures = 0, sheets = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder_ / "pictures")) {
    if (entry.path().extension() != ".png") continue;
    EXPECT_GT(entry.file_size(), 5000u) << entry.path();
    EXPECT_EQ(readFile(entry.path()).substr(1, 3), "PNG");
    (entry.path().filename().string().find("-sheet") != std::string::npos ? sheets : pictures)++;
  }
  EXPECT_GE(pictures, 10);
  EXPECT_EQ(sheets, 1);
}

TEST_F(ExploreCommand, IsTheSameByteForByteForOneAndTwoThreadsAndInAnotherProcess) {
  for (const char* threads : {"1", "2"}) {
    const std::string name = std::string("again-") + threads;
    const ProcessResult again =
        vantage({"explore", "box", "--steps", "2", "-o", *folder_ / (name + ".vantage"), "--json",
                 *folder_ / (name + ".json"), "--threads", threads});
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(withoutTimings(*folder_ / (name + ".json")), withoutTimings(*folder_ / "box.json"));
    for (const char* command : {"contours", "views", "segment", "plan"}) {
      const auto csv = [&](const std::string& run) {
        const ProcessResult table =
            vantage({command, *folder_ / (run + ".vantage#2"), "-o", "-", "--threads", threads});
        EXPECT_EQ(table.code, 0) << table.err;
        EXPECT_GT(table.out.size(), 300u) << command;
        return table.out;
      };
      EXPECT_EQ(csv(name), csv("box")) << command;
    }
  }
}

TEST_F(ExploreCommand, AnotherSeedGivesOtherNoise) {
  const ProcessResult other = vantage({"explore", "box", "--steps", "1", "-o", *folder_ / "seed.vantage",
                                       "--json", *folder_ / "seed.json", "--seed", "2"});
  ASSERT_EQ(other.code, 0) << other.err;
  EXPECT_NE(Json::parse(readFile(*folder_ / "seed.json"))["steps"][0]["unknown_voxels"],
            json()["steps"][0]["unknown_voxels"]);
}

TEST_F(ExploreCommand, TheBaselineScoresEveryPose) {
  const ProcessResult baseline =
      vantage({"explore", "box", "--planner", "standard", "--steps", "1", "-o", *folder_ / "standard.vantage",
               "--json", *folder_ / "standard.json"});
  ASSERT_EQ(baseline.code, 0) << baseline.err;
  const Json step = Json::parse(readFile(*folder_ / "standard.json"))["steps"][0];
  EXPECT_EQ(step["poses_scored"], step["poses_generated"]);
  EXPECT_TRUE(step["timings_s"]["segmentation"].is_null());
  EXPECT_TRUE(step["segment"].is_null());
}

TEST_F(ExploreCommand, SnapshotDrawsOneStepOfOneRecipe) {
  const ProcessResult one = vantage({"snapshot", *folder_ / "box.vantage", "--step", "1", "--recipe",
                                     "segments", "--size", "640x400", "-o", *folder_ / "one.png"});
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_GT(std::filesystem::file_size(*folder_ / "one.png"), 5000u);
  expectRefused(
      vantage({"snapshot", *folder_ / "box.vantage", "--recipe", "segment", "-o", *folder_ / "x.png"}),
      {"segment", "did you mean 'segments'?"});
  expectRefused(vantage({"snapshot", *folder_ / "box.vantage", "--step", "9", "-o", *folder_ / "x.png"}),
                {"9"});
  expectRefused(vantage({"snapshot", *folder_ / "box.vantage", "--size", "12", "-o", *folder_ / "x.png"}),
                {"--size 12"});
}

TEST_F(ExploreCommand, InfoDescribesTheRun) {
  const ProcessResult info = vantage({"info", *folder_ / "box.vantage"});
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_NE(info.out.find("steps done"), std::string::npos) << info.out;
}

/// One step of an arm serves all tests of these.
TEST(ExploreRecord, KeepsEveryFrameInAFolderOfItsOwn) {
  const TemporaryFolder folder;
  const std::string frames = folder / "frames";
  const ProcessResult run =
      vantage({"explore", "box", "--steps", "0", "-o", folder / "box.vantage", "--record", frames});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("frames recorded in " + frames), std::string::npos) << run.out;
  EXPECT_TRUE(std::filesystem::exists(frames + "/frame-000029.pose.txt"));
  EXPECT_FALSE(std::filesystem::exists(frames + "/frame.part"));
  const ProcessResult info = vantage({"info", frames});
  EXPECT_EQ(info.code, 0) << info.err;
  expectRefused(
      vantage({"explore", "box", "--steps", "0", "-o", folder / "again.vantage", "--record", frames}),
      {frames, "there is something in it"});
  EXPECT_FALSE(std::filesystem::exists(folder / "again.vantage"));
}

TEST(ExploreLive, SaysWhatIsMissing) {
  const TemporaryFolder folder;
  ProcessOptions options;
  options.folder = folder.path();
  options.environment["ROS_MASTER_URI"] = "http://127.0.0.1:1";
  options.environment["ROS_HOME"] = folder.path();
  expectRefused(vantage({"explore", "ros:/camera/image_raw"}, options), {"held by an arm", "--controller"});
  const std::vector<std::string> live = {"explore", "ros:/camera/image_raw", "--robot",
                                         "ur5",     "--controller",          "ros:/arm"};
  expectRefused(vantage(live, options), {"arm.base_m", "has to be given"});
  std::vector<std::string> placed = live;
  placed.insert(placed.end(), {"--set", "arm.base_m=[0,0,0]", "--set", "arm.clear_boxes_m=[-1,-1,-1,1,1,1]"});
  expectRefused(vantage(placed, options), {"ros:/camera/image_raw"});
  placed[1] = "openni2:";
  expectRefused(vantage(placed, options), {"openni2:", "names no camera"});
  expectRefused(
      vantage({"explore", "ros:/camera/image_raw", "--robot", "ur5", "--controller", "arm"}, options),
      {"--controller arm", "vantage devices"});
  expectRefused(vantage({"explore", "box", "--controller", "ros:/arm"}, options), {"box is no live camera"});
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "nothing is left behind";
  options.environment["ROS_MASTER_URI"] = "somewhere";
  const ProcessResult nowhere = vantage({"devices"}, options);
  EXPECT_EQ(nowhere.code, 0) << nowhere.err;
  EXPECT_NE(nowhere.out.find("ros: "), std::string::npos) << nowhere.out;
  const ProcessResult devices = vantage({"devices", "--json", "-"}, options);
  ASSERT_EQ(devices.code, 0) << devices.err;
  const Json kinds = Json::parse(devices.out);
  ASSERT_EQ(kinds.size(), 2u);
  for (const Json& kind : kinds) EXPECT_NE(kind["note"], "") << "no camera and no master are here";
}

class ExploreByArm : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    result_ = vantage({"explore", "tabletop", "--robot", "smart_six", "--steps", "1", "-o",
                       *folder_ / "arm.vantage", "--json", *folder_ / "arm.json"});
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static TemporaryFolder* folder_;
  static ProcessResult result_;
};
TemporaryFolder* ExploreByArm::folder_ = nullptr;
ProcessResult ExploreByArm::result_;

TEST_F(ExploreByArm, MovesTheArmAndCountsWhatItCannotReach) {
  ASSERT_EQ(result_.code, 0) << result_.err;
  const Json run = Json::parse(readFile(*folder_ / "arm.json"));
  EXPECT_EQ(run["robot"], "smart_six");
  EXPECT_GT(run["steps"][0]["timings_s"]["motion"], 0.1);
  EXPECT_GT(run["steps"][0]["poses_unreachable"], 0);
}

TEST_F(ExploreByArm, ItsStepIsPlannedAgainWithTheSameArm) {
  const ProcessResult plan =
      vantage({"plan", *folder_ / "arm.vantage" + "#1", "--json", *folder_ / "plan.json"});
  ASSERT_EQ(plan.code, 0) << plan.err;
  const Json run = Json::parse(readFile(*folder_ / "arm.json"));
  const Json again = Json::parse(readFile(*folder_ / "plan.json"));
  EXPECT_EQ(again["position_m"], run["steps"][0]["position_m"]);
  EXPECT_EQ(again["quaternion_xyzw"], run["steps"][0]["quaternion_xyzw"]);
  EXPECT_EQ(again["poses_unreachable"], run["steps"][0]["poses_unreachable"]);
}

TEST_F(ExploreByArm, AnotherArmFindsAPathToTheView) {
  const std::string run = *folder_ / "arm.vantage" + "#1";
  const ProcessResult own =
      vantage({"path", run, "-o", *folder_ / "own.csv", "--json", *folder_ / "own.json"});
  ASSERT_EQ(own.code, 0) << own.err;
  const std::vector<std::string> rows = lines(readFile(*folder_ / "own.csv"));
  ASSERT_GT(rows.size(), 10u);
  EXPECT_EQ(rows[0], "t_s,axis_1,axis_2,axis_3,axis_4,axis_5,axis_6");
  const Json facts = Json::parse(readFile(*folder_ / "own.json"));
  EXPECT_EQ(facts["verdict"], "reachable");
  EXPECT_NEAR(facts["duration_s"], std::stod(rows.back()), 1e-9);
  const ProcessResult other = vantage({"path", run, "--robot", "ur5", "-o", *folder_ / "ur5.csv"});
  EXPECT_EQ(other.code, 0) << other.err;
  const ProcessResult flyer =
      vantage({"path", run, "--robot", "free", "--to", "0,-0.62,0.87,1,0,0,0", "-o", "-"});
  EXPECT_EQ(flyer.out.substr(0, 30), "t_s,x_m,y_m,z_m,qx,qy,qz,qw\n0,") << flyer.err;
  expectRefused(vantage({"path", run, "--to", "3,3,0.5,0,0,0,1", "-o", *folder_ / "none.csv"}), {"no path"},
                1);
  expectRefused(vantage({"path", run, "--to", "0,0,0.5,0,0,0,2", "-o", "-"}), {"--to", "length 2"});
  expectRefused(vantage({"path", run, "--from", "0,1,2", "-o", "-"}), {"--from", "3 numbers", "6 joints"});
  expectRefused(vantage({"path", run, "--from", "0,300,0,0,0,0", "-o", "-"}), {"--from", "limits"});
  expectRefused(vantage({"path", run, "--to", "0,x", "-o", "-"}), {"--to", "no list of numbers"});
  EXPECT_FALSE(std::filesystem::exists(*folder_ / "none.csv"));
}

TEST_F(ExploreByArm, APictureShowsItAndItsMotion) {
  const auto bytes = [&](const std::string& name, const std::string& recipe) {
    const ProcessResult drawn = vantage({"snapshot", *folder_ / "arm.vantage", "--step", "1", "--recipe",
                                         recipe, "--size", "640x400", "-o", *folder_ / name});
    EXPECT_EQ(drawn.code, 0) << drawn.err;
    return readFile(*folder_ / name);
  };
  EXPECT_NE(bytes("arm.png", "arm"), bytes("views.png", "views"));
}

/// What the octree's planners take for free without having seen it is none for an arm, nor could the contour
/// planner lead it out of there again.
TEST(ExploreRobots, AnArmStaysInSeenSpaceWithEveryPlanner) {
  const TemporaryFolder folder;
  const ProcessResult run =
      vantage({"explore", "tabletop", "--robot", "smart_six", "--planner", "hierarchical,contour", "--steps",
               "2", "-o", folder / "x.vantage", "--json", folder / "x.json"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  for (const Json& step : Json::parse(readFile(folder / "x.json"))["steps"])
    EXPECT_EQ(step["status"], "view");
  const ProcessResult vouched =
      vantage({"explore", "tabletop", "--robot", "smart_six", "--planner", "hierarchical", "--steps", "1",
               "-o", folder / "y.vantage", "--set", "octree.outside=free"});
  EXPECT_EQ(vouched.code, 0);
  EXPECT_NE(vouched.err.find("never seen"), std::string::npos) << vouched.err;
}

TEST(ExploreRobots, RefusesWhatCannotMove) {
  const TemporaryFolder folder;
  const auto explore = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"explore", "tabletop", "-o", folder / "x.vantage"});
    return vantage(words);
  };
  expectRefused(explore({"--robot", "smart_sox"}), {"smart_sox", "did you mean 'smart_six'?"});
  expectRefused(explore({"--robot", "smart_six", "--set", "arm.start_deg=[0,60,-90,0,90,0]"}),
                {"arm.start_deg", "would touch occupied or unknown space"});
  expectRefused(explore({"--robot", "smart_six", "--set", "arm.clear_boxes_m=[0,0,0,1,1]"}),
                {"arm.clear_boxes_m has 5 numbers"});
  expectRefused(explore({"--robot", "smart_six", "--set", "arm.clear_boxes_m=[1,0,0,0,1,1]"}),
                {"arm.clear_boxes_m"});
  expectRefused(explore({"--robot", "smart_six", "--set", "exploration.enforce_reachability=false"}),
                {"exploration.enforce_reachability"});
  EXPECT_FALSE(std::filesystem::exists(folder / "x.vantage"));
}

}  // namespace
}  // namespace vantage::test
