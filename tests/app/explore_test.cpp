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

}  // namespace
}  // namespace vantage::test
