// Every stage as a command of its own, on a map that a short exploration left.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/app/program.h"

namespace vantage::test {
namespace {

class Stages : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    explore_ = vantage(
        {"explore", "box", "--steps", "1", "-o", *folder_ / "box.vantage", "--json", *folder_ / "box.json"});
    map_ = *folder_ / "box.vantage#1";
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  void SetUp() override { ASSERT_EQ(explore_.code, 0) << explore_.err; }

  /// Rows of a table that a command printed, without the header; checks the header.
  static std::vector<std::vector<std::string>> table(const std::vector<std::string>& words,
                                                     const std::string& header) {
    const ProcessResult result = vantage(words);
    EXPECT_EQ(result.code, 0) << result.err;
    std::vector<std::vector<std::string>> rows;
    const std::vector<std::string> text = lines(result.out);
    if (text.empty() || text[0] != header) {
      ADD_FAILURE() << "header is " << (text.empty() ? "missing" : text[0]);
      return rows;
    }
    for (std::size_t n = 1; n < text.size(); ++n) {
      rows.emplace_back();
      std::istringstream line(text[n]);
      for (std::string cell; std::getline(line, cell, ',');) rows.back().push_back(cell);
    }
    return rows;
  }

  static TemporaryFolder* folder_;
  static ProcessResult explore_;
  static std::string map_;
};
TemporaryFolder* Stages::folder_ = nullptr;
ProcessResult Stages::explore_;
std::string Stages::map_;

TEST_F(Stages, ContoursWritesUnitNormalsAndGroups) {
  const auto voxels = table({"contours", map_, "-o", "-"}, "i,j,k,x_m,y_m,z_m,nx,ny,nz,group");
  ASSERT_GT(voxels.size(), 50u);
  for (const auto& row : voxels) {
    ASSERT_EQ(row.size(), 10u);
    EXPECT_NEAR(std::hypot(std::stod(row[6]), std::stod(row[7]), std::stod(row[8])), 1.0, 1e-5);
  }
  const auto points = table({"contours", map_, "-o", *folder_ / "v.csv", "--points", "-"},
                            "group,x_m,y_m,z_m,nx,ny,nz,voxels");
  std::size_t grouped = 0;
  for (const auto& row : points) grouped += std::stoul(row[7]);
  EXPECT_EQ(grouped, voxels.size());
}

TEST_F(Stages, ViewsWritesFortyPosesAPoint) {
  const auto points = table({"contours", map_, "-o", *folder_ / "v.csv", "--points", "-"},
                            "group,x_m,y_m,z_m,nx,ny,nz,voxels");
  const auto views = table({"views", map_, "-o", "-"}, "id,x_m,y_m,z_m,qx,qy,qz,qw,group");
  EXPECT_EQ(views.size(), 40 * points.size());
  ASSERT_FALSE(points.empty());
}

TEST_F(Stages, SegmentsComeByDecreasingSaliency) {
  const auto segments =
      table({"segment", map_, "-o", "-"},
            "segment,points,saliency,isolation,roundness,d1_m,d2_m,d3_m,cx_m,cy_m,cz_m,radius_m");
  ASSERT_GE(segments.size(), 2u);
  for (std::size_t n = 0; n < segments.size(); ++n) {
    const auto& row = segments[n];
    EXPECT_NEAR(std::stod(row[2]), std::stod(row[3]) * std::stod(row[4]), 1e-9);
    EXPECT_GE(std::stod(row[5]), std::stod(row[6]));
    EXPECT_GE(std::stod(row[6]), std::stod(row[7]));
    if (n > 0) {
      EXPECT_LE(std::stod(row[2]), std::stod(segments[n - 1][2]));
    }
  }
}

TEST_F(Stages, LabelledCloudsKeepThePointsAndReadBack) {
  ASSERT_EQ(vantage({"segment", map_, "-o", *folder_ / "s.csv", "--cloud", *folder_ / "l.pcd"}).code, 0);
  const ProcessResult info = vantage({"info", *folder_ / "l.pcd", "--json", "-"});
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_GT(nlohmann::json::parse(info.out)["points"].get<int>(), 1000);
  EXPECT_NE(readFile(*folder_ / "l.pcd").find("label"), std::string::npos);
  // A cloud goes in where a map does.
  EXPECT_GE(table({"segment", *folder_ / "l.pcd", "-o", "-"},
                  "segment,points,saliency,isolation,roundness,d1_m,d2_m,d3_m,cx_m,cy_m,cz_m,radius_m")
                .size(),
            2u);
}

TEST_F(Stages, GainAtFullResolutionAgreesWithThePlannersGain) {
  const auto run = nlohmann::json::parse(readFile(*folder_ / "box.json"));
  const auto& step = run["steps"][0];
  ASSERT_EQ(step["status"], "view");
  std::ostringstream view;
  view.precision(17);
  view << "id,x_m,y_m,z_m,qx,qy,qz,qw\n0";
  for (const double x : step["position_m"]) view << ',' << x;
  for (const double q : step["quaternion_xyzw"]) view << ',' << q;
  writeFile(*folder_ / "view.csv", view.str() + "\n");
  // The sphere of the segment that the view was chosen for.
  const auto segments =
      table({"segment", map_, "-o", "-"},
            "segment,points,saliency,isolation,roundness,d1_m,d2_m,d3_m,cx_m,cy_m,cz_m,radius_m");
  std::string sphere;
  for (const auto& row : segments)
    if (std::stoi(row[0]) == step["segment"].get<int>())
      sphere = row[8] + "," + row[9] + "," + row[10] + "," + std::to_string(std::stod(row[11]) + 0.2);
  ASSERT_FALSE(sphere.empty());
  const auto gains = table({"gain", map_, *folder_ / "view.csv", "-o", "-", "--sphere", sphere},
                           "id,unknown,occupied,rays,visited,reject");
  ASSERT_EQ(gains.size(), 1u);
  EXPECT_EQ(gains[0][3], "54272");  // 256 x 212 pixels in this scene
  EXPECT_NEAR(std::stod(gains[0][1]), step["gain"].get<double>(), 0.05 * step["gain"].get<double>());
  const auto distinct =
      table({"gain", map_, *folder_ / "view.csv", "-o", "-", "--sphere", sphere, "--count", "voxels"},
            "id,unknown,occupied,rays,visited,reject");
  EXPECT_NEAR(std::stod(distinct.at(0)[1]), step["gain_voxels"].get<double>(),
              2.0 + 0.01 * step["gain_voxels"].get<double>());
}

TEST_F(Stages, PlanChoosesTheViewThatTheExplorationChose) {
  ASSERT_EQ(vantage({"plan", map_, "--json", *folder_ / "plan.json", "-o", *folder_ / "plan.csv"}).code, 0);
  const auto plan = nlohmann::json::parse(readFile(*folder_ / "plan.json"));
  const auto step = nlohmann::json::parse(readFile(*folder_ / "box.json"))["steps"][0];
  EXPECT_EQ(plan["position_m"], step["position_m"]);
  EXPECT_EQ(plan["quaternion_xyzw"], step["quaternion_xyzw"]);
  EXPECT_EQ(plan["gain"], step["gain"]);
  EXPECT_EQ(plan["poses_scored"], step["poses_scored"]);
}

TEST_F(Stages, AnotherThresholdChangesTheDecision) {
  ASSERT_EQ(vantage({"plan", map_, "--json", *folder_ / "none.json", "--set", "gain.threshold=200000"}).code,
            0);
  EXPECT_EQ(nlohmann::json::parse(readFile(*folder_ / "none.json"))["status"], "none");
}

TEST_F(Stages, ReplayedRecordingsRunTheLoop) {
  const std::string tray = std::string(VANTAGE_TEST_DATA) + "/rgbd_ur5_tray";
  if (!std::filesystem::exists(tray)) GTEST_SKIP() << "recorded data set not here: " << tray;
  const ProcessResult result = vantage(
      {"explore", tray, "--steps", "2", "-o", *folder_ / "tray.vantage", "--json", *folder_ / "tray.json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto run = nlohmann::json::parse(readFile(*folder_ / "tray.json"));
  ASSERT_EQ(run["steps"].size(), 2u);
  std::vector<int> frames;
  for (const auto& step : run["steps"]) {
    EXPECT_EQ(step["status"], "view");
    EXPECT_TRUE(step["coverage"].is_null());
    EXPECT_EQ(step["served_position_m"].size(), 3u);
    frames.push_back(step["frame"].get<int>());
  }
  EXPECT_NE(frames[0], frames[1]);
}

TEST_F(Stages, ARecordingInItsFirstCamerasFrameIsPlacedUpright) {
  const std::string box = std::string(VANTAGE_TEST_DATA) + "/rgbd_realsense_box";
  if (!std::filesystem::exists(box)) GTEST_SKIP() << "recorded data set not here: " << box;
  const ProcessResult result =
      vantage({"explore", box, "--steps", "2", "-o", *folder_ / "rs.vantage", "--json", *folder_ / "rs.json",
               "--set", "dataset.position_m=[-0.0494148,-0.346473,0.223853]", "--set",
               "dataset.quaternion_xyzw=[-0.818964,0.0184919,0.0,0.573547]"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto run = nlohmann::json::parse(readFile(*folder_ / "rs.json"));
  ASSERT_EQ(run["steps"].size(), 2u);
  for (const auto& step : run["steps"]) {
    EXPECT_EQ(step["status"], "view");
    // The floor of the box is z = 0 there: whoever recorded it held the camera above.
    EXPECT_GT(step["served_position_m"][2].get<double>(), 0.1);
    EXPECT_LT(step["served_position_m"][2].get<double>(), 0.6);
  }
}

TEST_F(Stages, FusedRecordingsGiveAMapAndAMesh) {
  const std::string tray = std::string(VANTAGE_TEST_DATA) + "/rgbd_ur5_tray";
  if (!std::filesystem::exists(tray)) GTEST_SKIP() << "recorded data set not here: " << tray;
  const ProcessResult result =
      vantage({"fuse", tray, "-o", *folder_ / "tray.vti", "--frames", "0:4", "--voxel-size", "0.01",
               "--truncation", "0.03", "--mesh", *folder_ / "tray.ply"});
  ASSERT_EQ(result.code, 0) << result.err;
  const ProcessResult info = vantage({"info", *folder_ / "tray.vti", "--json", "-"});
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_GT(nlohmann::json::parse(info.out)["occupied"].get<int>(), 1000);
  EXPECT_EQ(vantage({"info", *folder_ / "tray.ply"}).code, 0);
}

}  // namespace
}  // namespace vantage::test
