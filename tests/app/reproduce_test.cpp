#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace vantage::test {
namespace {

/// Coarse voxels and few candidates: seconds instead of minutes.
const std::vector<std::string> kTiny = {
    "--set", "octree.voxel_size_m=0.04",      "--set", "candidates.subdivisions=1",
    "--set", "utility.min_occupied=5",        "--set", "utility.stop_gain=2",
    "--set", "candidates.workspace_views=60", "--set", "exploration.steps=2"};

ProcessResult reproduce(std::vector<std::string> words) {
  words.insert(words.begin(), "reproduce");
  words.insert(words.end(), kTiny.begin(), kTiny.end());
  return vantage(words);
}

TEST(Reproduce, PrintsTheTableAndTheSummaryAndWritesThreeForms) {
  const TemporaryFolder folder;
  const ProcessResult result =
      reproduce({"A1", "--quick", "-o", folder / "out", "--json", folder / "report.json", "--threads", "2"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  for (const char* part : {"threads used: 2", "processor:", "A1: simulated reconstruction", "m=3 resume",
                           "A1 (1)", "A1 (5)", "0 of ", "Defaults that were used"})
    EXPECT_NE(result.out.find(part), std::string::npos) << part;
  for (const char* file :
       {"out/a1.csv", "out/a1_steps.csv", "out/summary.csv", "out/report.json", "out/report.html"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / file)) << file;
  EXPECT_EQ(readFile(folder.path() / "report.json"), readFile(folder.path() / "out/report.json"));
  const auto json = nlohmann::json::parse(readFile(folder.path() / "report.json"));
  EXPECT_GE(json["tables"]["a1"]["rows"].size(), 3u);
}

TEST(Reproduce, TakesAMesh) {
  const TemporaryFolder folder;
  writeFile(
      folder.path() / "pyramid.obj",
      "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0.5 1 0.5\nf 1 2 3 4\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\n");
  const ProcessResult result = reproduce({"A1", "--quick", "--mesh", folder / "pyramid.obj", "--up", "y",
                                          "--sizes", "0.3", "-o", folder / "out"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("pyramid"), std::string::npos);
}

TEST(Reproduce, TakesAListAndRunsEachOnce) {
  const TemporaryFolder folder;
  ProcessOptions in_folder;
  in_folder.folder = folder.path();
  std::vector<std::string> words = {"reproduce", "A1", "A2", "A3", "-o", "tables", "--quick"};
  words.insert(words.end(), kTiny.begin(), kTiny.end());
  const ProcessResult result = vantage(words, in_folder);
  ASSERT_EQ(result.code, 0) << result.err;
  for (const char* file : {"a1.csv", "a2.csv", "a3.csv", "summary.csv", "report.html"})
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "tables" / file)) << file;
  EXPECT_NE(readFile(folder.path() / "tables/report.html").find("Reproduction of A1, A2, A3 (quick)"),
            std::string::npos);
  EXPECT_NE(result.out.find("mean of its 1 run with m=2 resume"), std::string::npos) << "A3 knows A1's times";
}

TEST(Reproduce, OrderAndRepetitionOfTheListDoNotMatter) {
  const TemporaryFolder folder;
  const ProcessResult result = reproduce({"A3", "A1", "A3", "--quick", "-o", folder / "out"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_LT(result.out.find("A1 compact"), result.out.find("A3 room"));
  const auto json = nlohmann::json::parse(readFile(folder.path() / "out/report.json"));
  EXPECT_EQ(json["tables"]["a1"]["rows"].size(), 3u);
  EXPECT_EQ(json["title"], "Reproduction of A1, A3 (quick)");
  EXPECT_TRUE(json["not_run"].empty());
}

TEST(Reproduce, KeepsItsPlannerWhateverIsSet) {
  const TemporaryFolder folder;
  const ProcessResult result =
      reproduce({"A3", "--quick", "--set", "exploration.planner=contour", "-o", folder / "out"});
  EXPECT_EQ(result.code, 0) << result.err;
}

TEST(Reproduce, AnInterruptionKeepsWhatIsFinished) {
  const TemporaryFolder folder;
  ProcessOptions interrupted;
  interrupted.interrupt_after_s = 10;  // some of the forty runs, not all
  std::vector<std::string> words = {"reproduce", "all", "-o", folder / "out", "--json", folder / "out.json"};
  words.insert(words.end(), kTiny.begin(), kTiny.end());
  words.insert(words.end(), {"--set", "octree.voxel_size_m=0.03", "--set", "exploration.steps=12"});
  const ProcessResult result = vantage(words, interrupted);
  expectRefused(result, {"out: interrupted", "not run: A1 ", "A2 (0 of 3 runs finished)", "A3 room, seed 1"},
                1);
  const auto json = nlohmann::json::parse(readFile(folder.path() / "out.json"));
  EXPECT_GE(json["tables"]["a1"]["rows"].size(), 1u);
  EXPECT_FALSE(json["not_run"].empty());
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/report.html"));
}

TEST(Reproduce, RefusesWhatItCannotRun) {
  const TemporaryFolder folder;
  expectRefused(vantage({"reproduce", "A4", "-o", folder / "out"}), {"A4"});
  expectRefused(vantage({"reproduce", "A1"}), {"-o"});
  expectRefused(reproduce({"A1", "--quick", "--mesh", folder / "none.obj", "-o", folder / "out"}),
                {"none.obj"});
  expectRefused(reproduce({"A1", "--quick", "--sizes", "9", "-o", folder / "out"}), {"--sizes 9", "0.6 m"});
  expectRefused(reproduce({"A3", "--quick", "--dataset", folder / "none", "-o", folder / "out"}), {"none"});
  const ProcessResult missing =
      reproduce({"A1", "A3", "--quick", "--dataset", folder / "none", "-o", folder / "out"});
  expectRefused(missing, {"--dataset", "none", "no recording"});
  EXPECT_EQ(missing.out.find("views"), std::string::npos) << "nothing was run before";
  writeFile(folder.path() / "file", "x");
  expectRefused(reproduce({"A1", "--quick", "-o", folder / "file"}), {"file", "no folder"});
  expectRefused(reproduce({"A1", "--quick", "--set", "rays.coarse=2", "-o", folder / "out"}),
                {"rays.coarse", "did you mean"});
}

TEST(Reproduce, RefusesOptionsThatWouldChangeNothing) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  expectRefused(vantage({"reproduce", "A1", "--dataset", "x", "-o", out}), {"--dataset", "A3"});
  expectRefused(vantage({"reproduce", "A3", "--mesh", "x.obj", "-o", out}), {"--mesh", "add A1"});
  expectRefused(vantage({"reproduce", "A3", "--sizes", "0.3", "-o", out}), {"--sizes", "add A1"});
  expectRefused(vantage({"reproduce", "A1", "--up", "y", "-o", out}), {"--up", "--mesh"});
  expectRefused(vantage({"reproduce", "A2", "--sizes", "0.2,0.3", "-o", out}), {"--sizes", "one"});
  expectRefused(vantage({"reproduce", "A2", "--mesh", "a.obj", "--mesh", "b.obj", "-o", out}),
                {"--mesh", "one"});
  expectRefused(vantage({"reproduce", "B4", "--set", "filter.emitter_offset_m=0.2", "-o", folder / "out"}),
                {"--set", "B4 are exact"});
}

TEST(Reproduce, QuickTakesEverySizeThatIsAskedFor) {
  const TemporaryFolder folder;
  const ProcessResult result = reproduce({"A1", "--quick", "--sizes", "0.25,0.35", "-o", folder / "out"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("compact 0.25 m"), std::string::npos);
  EXPECT_NE(result.out.find("compact 0.35 m"), std::string::npos);
}

}  // namespace
}  // namespace vantage::test
