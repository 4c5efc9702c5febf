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

TEST(Reproduce, RefusesWhatItCannotRun) {
  const TemporaryFolder folder;
  expectRefused(vantage({"reproduce", "A4", "-o", folder / "out"}), {"A4"});
  expectRefused(vantage({"reproduce", "A1"}), {"-o"});
  expectRefused(reproduce({"A1", "--quick", "--mesh", folder / "none.obj", "-o", folder / "out"}),
                {"none.obj"});
  expectRefused(reproduce({"A1", "--quick", "--sizes", "9", "-o", folder / "out"}), {"--sizes 9", "0.6 m"});
  expectRefused(reproduce({"A3", "--quick", "--dataset", folder / "none", "-o", folder / "out"}), {"none"});
  writeFile(folder.path() / "file", "x");
  expectRefused(reproduce({"A1", "--quick", "-o", folder / "file"}), {"file", "no folder"});
  expectRefused(reproduce({"A1", "--quick", "--set", "rays.coarse=2", "-o", folder / "out"}),
                {"rays.coarse", "did you mean"});
}

}  // namespace
}  // namespace vantage::test
