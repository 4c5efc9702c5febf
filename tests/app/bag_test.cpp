#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"
#include "tests/support/bag_sequence.h"

namespace vantage::test {
namespace {

using ::testing::HasSubstr;

class Bag : public ::testing::Test {
 protected:
  void SetUp() override { BagSequence().write(bag, BagPacking::Lz4); }

  TemporaryFolder folder;
  const std::string bag = folder / "desk.bag", run = folder / "desk.vantage";
};

TEST_F(Bag, GoesWhereAFolderGoes) {
  const auto info = vantage({"info", bag, "--json", "-"});
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_EQ(nlohmann::json::parse(info.out)["frames"], 6);
  const auto fused = vantage({"fuse", bag, "-o", folder / "desk.vti", "--voxel-size", "0.02", "--json", "-"});
  ASSERT_EQ(fused.code, 0) << fused.err;
  EXPECT_GT(nlohmann::json::parse(fused.out)["voxels_updated"], 1000);
  expectRefused(vantage({"fuse", bag, "-o", folder / "x.vti", "--json", bag}),
                {"is the same file as DATASET"});
}

TEST_F(Bag, IsExploredAndFoundAgainByItsRun) {
  const std::vector<std::string> coarse = {"--set", "volume.voxel_size_m=0.02", "--set",
                                           "fusion.truncation_m=0.1"};
  std::vector<std::string> words = {"explore", bag, "--steps", "1", "-o", run};
  words.insert(words.end(), coarse.begin(), coarse.end());
  const auto explored = vantage(words);
  ASSERT_EQ(explored.code, 0) << explored.err;
  const std::vector<std::string> plan = {"plan", run + "#1", "--set", "dataset.serve_distance_m=0.5"};
  const auto planned = vantage(plan);
  EXPECT_EQ(planned.code, 0) << planned.err;
  std::filesystem::remove(bag);
  expectRefused(vantage(plan), {"the recording of this run is not here"});
  expectRefused(vantage({"explore", bag}), {"desk.bag: cannot be read; check that the file exists"});
}

}  // namespace
}  // namespace vantage::test
