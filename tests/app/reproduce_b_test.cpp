// The experiments of the contour-based planner as users call them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace vantage::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

/// Coarse voxels and a coarse camera: a run takes half a second.
const std::vector<std::string> kTiny = {"--set", "volume.voxel_size_m=0.015",
                                        "--set", "volume.size=[200,134,80]",
                                        "--set", "fusion.truncation_m=0.06",
                                        "--set", "camera.width=128",
                                        "--set", "camera.height=106",
                                        "--set", "camera.fx=91.25",
                                        "--set", "camera.fy=91.25",
                                        "--set", "camera.cx=63.5",
                                        "--set", "camera.cy=52.5",
                                        "--set", "segmentation.voxel_m=0.02",
                                        "--set", "segmentation.seed_m=0.06",
                                        "--set", "contours.group_distance_m=0.05"};

std::vector<std::string> tinyB2(const TemporaryFolder& folder) {
  std::vector<std::string> words = {"reproduce", "B2", "--seeds", "1", "-o", folder / "out"};
  words.insert(words.end(), kTiny.begin(), kTiny.end());
  return words;
}

std::size_t filesIn(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(ReproduceB, QuickPrintsEveryTableAndJudgesEveryCriterion) {
  const TemporaryFolder folder;
  const ProcessResult result =
      vantage({"reproduce", "B1", "B2", "B3", "B4", "--quick", "-o", folder / "out"});
  ASSERT_EQ(result.code, 0) << result.err;
  const json report = json::parse(readFile(folder.path() / "out/report.json"));
  for (const char* table :
       {"b1", "b1_runs", "b1_table1", "b1_table2", "b1_table3", "b2", "b2_normals", "b3", "b4"}) {
    EXPECT_TRUE(report["tables"].contains(table)) << table;
    EXPECT_FALSE(report["tables"][table]["rows"].empty()) << table;
    EXPECT_TRUE(fs::exists(folder.path() / "out" / (std::string(table) + ".csv"))) << table;
  }
  std::vector<std::string> judged;
  for (const json& claim : report["claims"]) {
    const std::string name = claim["experiment"], verdict = claim["verdict"];
    if (verdict != "not run") judged.push_back(name);
    // Counts that no machine changes, on the one scene and seed.
    const bool counted = name == "B1 (1)" || name == "B1 (3b)";
    if (counted || name.starts_with("B3") || name.starts_with("B4")) {
      EXPECT_EQ(verdict, "pass") << name << ": " << claim["ours"];
    }
  }
  for (const char* name :
       {"B1 (1)", "B1 (2a)", "B1 (2b)", "B1 (2c)", "B1 (3a)", "B1 (3b)", "B1 (4a)", "B1 (4b)", "B1 (5)",
        "B1 (6)", "B2 (a)", "B2 (b)", "B3 (1)", "B3 (2)", "B3 (3)", "B4 (1)", "B4 (2)", "B4 (3)", "B4 (4)"})
    EXPECT_THAT(judged, ::testing::Contains(name));
  const std::string page = readFile(folder.path() / "out/report.html");
  for (const char* part : {"Fig. 18", "gain threshold", "bilateral filter", "Table 3"})
    EXPECT_THAT(page, HasSubstr(part));
}

TEST(ReproduceB, AnInterruptionKeepsRunsAndTheNextCallGoesOnFromThere) {
  const TemporaryFolder folder;
  ProcessOptions interrupted;
  interrupted.interrupt_after_s = 5;  // some of the eighteen runs, not all
  expectRefused(vantage(tinyB2(folder), interrupted), {"out: interrupted", "not run: B2 ("}, 1);
  const std::size_t kept = filesIn(folder.path() / "out/runs");
  ASSERT_GE(kept, 1u);
  const json part = json::parse(readFile(folder.path() / "out/report.json"));
  ASSERT_EQ(part["tables"]["b2"]["rows"].size(), kept);

  const ProcessResult result = vantage(tinyB2(folder));
  ASSERT_EQ(result.code, 0) << result.err;
  std::size_t taken_over = 0;
  for (std::size_t at = 0; (at = result.out.find("kept from before", at)) != std::string::npos; ++at)
    ++taken_over;
  EXPECT_EQ(taken_over, kept);
  EXPECT_GT(filesIn(folder.path() / "out/runs"), kept);
  const json whole = json::parse(readFile(folder.path() / "out/report.json"));
  EXPECT_TRUE(whole["not_run"].empty());
  ASSERT_EQ(whole["tables"]["b2"]["rows"].size(), filesIn(folder.path() / "out/runs"));
  for (std::size_t row = 0; row < kept; ++row)
    EXPECT_EQ(whole["tables"]["b2"]["rows"][row], part["tables"]["b2"]["rows"][row]);
}

}  // namespace
}  // namespace vantage::test
