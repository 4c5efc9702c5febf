// Candidate views of an octree map: on an icosphere around the object's box, and anywhere in the map.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/volume/occupancy_octree.h"
#include "io/table_file.h"
#include "tests/app/program.h"

namespace vantage::test {
namespace {

using Eigen::Vector3d;

class Views : public testing::Test {
 protected:
  void SetUp() override {
    const GridGeometry g = OccupancyOctree::gridAround(Box(Vector3d(-1, -1, 0), Vector3d(1, 1, 2)), 0.1);
    OccupancyOctree map(g, Box(), VoxelState::Free, {});
    map.set({10, 10, 10}, 1.0f);
    std::ofstream out(folder_ / "map.ot", std::ios::binary);
    map.write(out, OccupancyOctree::Format::Ot);
  }
  ProcessResult views(std::vector<std::string> more) {
    std::vector<std::string> words = {"views", folder_ / "map.ot", "-o", folder_ / "views.csv"};
    words.insert(words.end(), more.begin(), more.end());
    return vantage(words);
  }
  std::vector<ViewRow> rows() const { return readViews(folder_ / "views.csv"); }

  TemporaryFolder folder_;
  const std::vector<std::string> box_ = {"--set", "octree.object_min_m=[-0.1,-0.2,0.3]", "--set",
                                         "octree.object_max_m=[0.3,0.2,0.7]"};
};

TEST_F(Views, OnAnIcosphereLookAtTheMiddleOfTheObjectsBox) {
  std::vector<std::string> words = {"--generator", "icosphere", "--count",
                                    "80",          "--set",     "candidates.radius_m=0.7"};
  words.insert(words.end(), box_.begin(), box_.end());
  const ProcessResult result = views(words);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("80 views"), std::string::npos) << result.out;
  const std::vector<ViewRow> all = rows();
  ASSERT_EQ(all.size(), 80u);
  for (const ViewRow& row : all) {
    EXPECT_FALSE(row.group.has_value());
    EXPECT_NEAR((row.T_world_camera * Vector3d(0, 0, 0.7) - Vector3d(0.1, 0.0, 0.5)).norm(), 0.0, 1e-9);
  }
}

TEST_F(Views, OnAnIcosphereAre320UnlessAskedFor) {
  ASSERT_EQ(views({"--generator", "icosphere"}).code, 0);
  EXPECT_EQ(rows().size(), 320u);
}

TEST_F(Views, OfAnIcosphereComeInNumbersOfFaces) {
  expectRefused(views({"--generator", "icosphere", "--count", "300"}), {"--count 300", "80 and 320"});
  expectRefused(views({"--generator", "icosphere", "--count", "21"}), {"20 and 80"});
  expectRefused(views({"--generator", "icosphere", "--count", "3"}), {"20 and 80"});
  expectRefused(views({"--generator", "icosphere", "--count", "500000"}), {"at most 81920"});
  expectRefused(views({"--generator", "icosphere", "--count", "-1"}), {"--count"});
}

TEST_F(Views, InTheWorkspaceLieInTheMapAndFollowTheSeed) {
  ASSERT_EQ(views({"--generator", "workspace", "--count", "50", "--seed", "3"}).code, 0);
  const std::vector<ViewRow> first = rows();
  ASSERT_EQ(first.size(), 50u);
  const Box map(Vector3d(-1.2, -1.2, -0.2), Vector3d(1.2, 1.2, 2.2));
  for (const ViewRow& row : first) EXPECT_TRUE(map.contains(row.T_world_camera.translation()));
  ASSERT_EQ(views({"--generator", "workspace", "--count", "50", "--seed", "3"}).code, 0);
  EXPECT_EQ(rows()[7].T_world_camera.matrix(), first[7].T_world_camera.matrix());
  ASSERT_EQ(views({"--generator", "workspace", "--count", "50", "--seed", "4"}).code, 0);
  EXPECT_NE(rows()[7].T_world_camera.matrix(), first[7].T_world_camera.matrix());
}

TEST_F(Views, WriteJsonThatNamesTheGenerator) {
  ASSERT_EQ(views({"--generator", "workspace", "--count", "4", "--json", folder_ / "v.json"}).code, 0);
  const auto json = nlohmann::json::parse(readFile(folder_.path() / "v.json"));
  EXPECT_EQ(json["views"], 4);
  EXPECT_EQ(json["generator"], "workspace");
}

TEST_F(Views, FollowTheConfiguredGeneratorIfNoneIsAskedFor) {
  const ProcessResult result = views({"--set", "candidates.generator=workspace", "--count", "7"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("7 views drawn in the mapped volume"), std::string::npos) << result.out;
  ASSERT_EQ(views({"--set", "candidates.generator=workspace", "--generator", "icosphere"}).code, 0);
  EXPECT_EQ(rows().size(), 320u);
  EXPECT_NE(views({"--generator", "workspace", "--count", "1"}).out.find("1 view drawn"), std::string::npos);
}

TEST_F(Views, ABoxOutsideTheMapIsRefused) {
  expectRefused(views({"--generator", "icosphere", "--set", "octree.object_min_m=[50,50,50]", "--set",
                       "octree.object_max_m=[51,51,51]"}),
                {"octree.object_min_m", "outside the map"});
}

TEST_F(Views, OfContoursNeedATsdfAndTakeNoCount) {
  expectRefused(views({}), {"map.ot", "octree", "TSDF", "--generator icosphere"});
  expectRefused(views({"--count", "20"}), {"--count", "contour"});
}

}  // namespace
}  // namespace vantage::test
