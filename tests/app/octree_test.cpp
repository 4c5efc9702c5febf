// Octree maps as the commands meet them: what they hold, what views see in them, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/volume/occupancy_octree.h"
#include "tests/app/program.h"

namespace vantage::test {
namespace {

using Vector = Eigen::Vector3d;

/// The sensor and the map of the specification's toy table (section 10.4).
const std::vector<std::string> kToySensor = {"--fov-deg", "60,45", "--range", "0,1"};
const std::string kToyView = "id,x_m,y_m,z_m,qx,qy,qz,qw\n0,0.001,0.0007,0.0003,0,0,0,1\n";

/// Map of 32^3 voxels of 5 cm, labelled by their centres.
void writeToyMap(const std::string& path, OccupancyOctree::Format format,
                 const std::function<VoxelState(const Vector&)>& label) {
  const GridGeometry g = OccupancyOctree::gridAround(Box(Vector(-0.8, -0.8, 0), Vector(0.8, 0.8, 1.6)), 0.05);
  OccupancyOctree map(g, Box(), VoxelState::Free, {});
  for (std::size_t n = 0; n < g.count(); ++n) {
    const VoxelState state = label(g.center(g.voxel(n)));
    if (state == VoxelState::Occupied) map.set(g.voxel(n), 1.0f);
    if (state == VoxelState::Unknown) map.set(g.voxel(n), std::nanf(""));
  }
  std::ofstream out(path, std::ios::binary);
  map.write(out, format);
}

VoxelState unknownBehind(const Vector& p) {
  return p.z() > 0.5 ? VoxelState::Unknown : VoxelState::Free;
}
VoxelState wallBehind(const Vector& p) {
  return p.z() > 0.5 ? VoxelState::Occupied : VoxelState::Free;
}
VoxelState halfAWall(const Vector& p) {
  return p.z() <= 0.5 ? VoxelState::Free : p.x() < 0 ? VoxelState::Occupied : VoxelState::Unknown;
}

class Octree : public testing::Test {
 protected:
  void SetUp() override {
    writeFile(folder_ / "view.csv", kToyView);
    writeToyMap(folder_ / "unknown.bt", OccupancyOctree::Format::Bt, unknownBehind);
    writeToyMap(folder_ / "wall.ot", OccupancyOctree::Format::Ot, wallBehind);
    writeToyMap(folder_ / "half.bt", OccupancyOctree::Format::Bt, halfAWall);
  }
  /// `id,unknown,occupied,rays,visited,reject` of each view.
  std::vector<std::string> gains(const std::string& map, std::vector<std::string> more = {},
                                 const std::string& views = "view.csv") {
    std::vector<std::string> words = {"gain", folder_ / map, folder_ / views, "-o", "-"};
    words.insert(words.end(), kToySensor.begin(), kToySensor.end());
    words.insert(words.end(), more.begin(), more.end());
    const ProcessResult result = vantage(words);
    EXPECT_EQ(result.code, 0) << result.err;
    std::vector<std::string> rows = lines(result.out);
    if (rows.empty() || rows[0] != "id,unknown,occupied,rays,visited,reject") {
      ADD_FAILURE() << "no table of gains";
      return std::vector<std::string>(9);
    }
    rows.erase(rows.begin());
    return rows;
  }
  std::string gain(const std::string& map, std::vector<std::string> more = {}) {
    return gains(map, std::move(more)).at(0);
  }
  static std::vector<std::string> restart(int levels) {
    return {"--tracer", "hierarchical", "--restart", "--coarse-levels", std::to_string(levels)};
  }
  void expectGainRefused(const std::string& map, const std::vector<std::string>& more,
                         const std::vector<std::string>& parts) {
    std::vector<std::string> words = {"gain", folder_ / map, folder_ / "view.csv", "-o", folder_ / "g.csv"};
    words.insert(words.end(), more.begin(), more.end());
    expectRefused(vantage(words), parts);
  }

  TemporaryFolder folder_;
};

TEST_F(Octree, GainFollowsTheToyTableOfTheSpecification) {
  EXPECT_EQ(gain("unknown.bt"), "0,336,0,336,5358,");
  EXPECT_EQ(gain("unknown.bt", restart(0)), "0,336,0,336,5358,");
  EXPECT_EQ(gain("unknown.bt", restart(1)), "0,336,0,336,756,");
  EXPECT_EQ(gain("unknown.bt", restart(2)), "0,336,0,336,104,");
  EXPECT_EQ(gain("unknown.bt", restart(3)), "0,336,0,336,17,");
  EXPECT_EQ(gain("wall.ot"), "0,0,336,336,5358,");
  EXPECT_EQ(gain("wall.ot", restart(1)), "0,0,336,336,6114,");
  EXPECT_EQ(gain("wall.ot", restart(3)), "0,0,336,336,6235,");
  EXPECT_EQ(gain("half.bt"), "0,176,160,336,5358,");
  EXPECT_EQ(gain("half.bt", restart(1)), "0,192,144,336,3179,");
  EXPECT_EQ(gain("half.bt", restart(2)), "0,192,144,336,2953,");
  EXPECT_EQ(gain("half.bt", restart(3)), "0,256,80,336,1734,");
}

TEST_F(Octree, BoundsAndSphereRestrictBothCounts) {
  const std::vector<std::string> left = {"--bounds", "-1,-1,0,0,1,2"}, right = {"--bounds", "0,-1,0,1,1,2"};
  EXPECT_EQ(gain("half.bt", left), "0,0,160,336,5358,");
  EXPECT_EQ(gain("half.bt", right), "0,176,0,336,5358,");
  EXPECT_EQ(gain("half.bt", {"--sphere", "0,0,0,9"}), "0,176,160,336,5358,");
  EXPECT_EQ(gain("half.bt", {"--sphere", "5,0,0,1"}), "0,0,0,336,5358,");
}

TEST_F(Octree, VoxelsAreCountedOnceByBothTracers) {
  const std::string uniform = gain("half.bt", {"--count", "voxels"});
  EXPECT_EQ(gain("half.bt", {"--count", "voxels", "--tracer", "hierarchical", "--coarse-levels", "0"}),
            uniform);
  std::istringstream cells(uniform);
  std::string id, unknown, occupied;
  std::getline(cells, id, ',');
  std::getline(cells, unknown, ',');
  std::getline(cells, occupied, ',');
  EXPECT_GT(std::stoi(unknown), 30);
  EXPECT_LT(std::stoi(unknown), 176);
  EXPECT_GT(std::stoi(occupied), 30);
  EXPECT_LT(std::stoi(occupied), 160);
}

TEST_F(Octree, ViewsThatDoNotStandInFreeSpaceAreRejected) {
  writeFile(folder_ / "views.csv", kToyView + "7,0,0,0.7,0,0,0,1\n8,0,0,-5,0,0,0,1\n");
  for (const std::vector<std::string>& tracer : {std::vector<std::string>{}, restart(2)}) {
    const auto rows = gains("half.bt", tracer, "views.csv");
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].back(), ',');
    EXPECT_EQ(rows[1], "7,0,0,0,0,position");  // in unknown space or in the wall
    EXPECT_EQ(rows[2], "8,0,0,0,0,position");  // outside everything that is stored
  }
}

TEST_F(Octree, DefaultsAreThePapersSensor) {
  // 57 x 43 deg to 2.8 m with voxels of 5 cm.
  const ProcessResult result =
      vantage({"gain", folder_ / "wall.ot", folder_ / "view.csv", "-o", folder_ / "g.csv", "--json", "-"});
  ASSERT_EQ(result.code, 0) << result.err;
  const double step = std::asin(0.05 / 2.8);
  const auto along = [&](double degrees) { return std::floor(degrees * M_PI / 180 / step) + 1; };
  EXPECT_EQ(nlohmann::json::parse(result.out)["rays_per_view"].get<int>(), along(57) * along(43));
}

TEST_F(Octree, InfoTellsWhatIsStored) {
  const ProcessResult result = vantage({"info", folder_ / "half.bt", "--json", "-"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto facts = nlohmann::json::parse(result.out);
  EXPECT_EQ(facts["kind"], "octree");
  EXPECT_EQ(facts["voxel_size_m"], 0.05);
  EXPECT_EQ(facts["free"], 32 * 32 * 10);
  EXPECT_EQ(facts["occupied"], 16 * 32 * 22);
  EXPECT_EQ(facts["voxels"], nlohmann::json({34, 34, 34}));
}

TEST_F(Octree, RealMapsAreDescribed) {
  const std::string map = std::string(VANTAGE_TEST_DATA) + "/octomap/geb079.bt";
  if (!std::filesystem::exists(map)) GTEST_SKIP() << "recorded data not here: " << map;
  const ProcessResult result = vantage({"info", map, "--json", "-"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto facts = nlohmann::json::parse(result.out);
  EXPECT_NEAR(facts["occupied_m3"].get<double>(), 95.0646, 1e-3);
  EXPECT_NEAR(facts["free_m3"].get<double>(), 486.7886, 1e-3);
}

TEST_F(Octree, GainOfAStepEqualsWhatItsPlannerSaw) {
  const std::string run = folder_ / "box.vantage";
  const ProcessResult explored = vantage({"explore", "box", "--planner", "hierarchical", "--steps", "1", "-o",
                                          run, "--json", folder_ / "box.json"});
  ASSERT_EQ(explored.code, 0) << explored.err;
  const auto step = nlohmann::json::parse(readFile(folder_ / "box.json"))["steps"][0];
  ASSERT_EQ(step["status"], "view");
  std::ostringstream view, bounds;
  view.precision(17);
  view << "id,x_m,y_m,z_m,qx,qy,qz,qw\n0";
  for (const double x : step["position_m"]) view << ',' << x;
  for (const double q : step["quaternion_xyzw"]) view << ',' << q;
  writeFile(folder_ / "view.csv", view.str() + "\n");
  const auto facts = nlohmann::json::parse(vantage({"info", run + "#1", "--json", "-"}).out);
  ASSERT_EQ(facts["kind"], "octree");
  for (const char* corner : {"object_min_m", "object_max_m"})
    for (const double x : facts[corner]) bounds << (bounds.tellp() > 0 ? "," : "") << x;
  const ProcessResult result = vantage({"gain", run + "#1", folder_ / "view.csv", "-o", "-", "--tracer",
                                        "hierarchical", "--bounds=" + bounds.str()});
  ASSERT_EQ(result.code, 0) << result.err;
  std::ostringstream expected;
  expected << "0," << step["gain"].get<double>() << ',' << step["occupied"].get<double>() << ",";
  EXPECT_EQ(lines(result.out).at(1).rfind(expected.str(), 0), 0u) << result.out << expected.str();
  expectRefused(vantage({"contours", run + "#1", "-o", folder_ / "c.csv"}), {"octree"});
}

TEST_F(Octree, OptionsThatDoNotFitAreRefused) {
  expectGainRefused("half.bt", {"--coarse-levels", "1"}, {"--coarse-levels", "--tracer hierarchical"});
  expectGainRefused("half.bt", {"--restart"}, {"--restart", "--tracer hierarchical"});
  expectGainRefused("half.bt", {"--camera", "cam.yaml"}, {"--camera", "--fov-deg"});
  expectGainRefused("half.bt", {"--outside", "transparent"}, {"--outside"});
  expectGainRefused("half.bt", {"--tracer", "hierarchical", "--coarse-levels", "7"},
                    {"--coarse-levels", "allowed: 0 .. 5"});
  expectGainRefused("half.bt", {"--tracer", "hierarchical", "--coarse-levels", "-1"}, {"allowed: 0 .. 5"});
  expectGainRefused("half.bt", {"--fov-deg", "0,40"}, {"--fov-deg 0,40", "degrees"});
  expectGainRefused("half.bt", {"--fov-deg", "40,180"}, {"--fov-deg 40,180", "degrees"});
  expectGainRefused("half.bt", {"--range", "3,1"}, {"--range 3,1", "MIN,MAX in metres"});
  expectGainRefused("half.bt", {"--range", "-1,1"}, {"--range -1,1", "metres"});
  expectGainRefused("half.bt", {"--range", "0,nan"}, {"--range"});
  // Nobody typed --coarse-levels.
  expectGainRefused("half.bt", {"--tracer", "hierarchical", "--range", "0,0.2"},
                    {"rays.coarse_levels = 2", "allowed: 0 .. 1"});
  expectGainRefused("half.bt", {"--range", "0.01,0.04"}, {"too large"});
}

TEST_F(Octree, RegionsOutsideTheMapAreWarnedOf) {
  const auto errorsOf = [&](const std::vector<std::string>& region) {
    std::vector<std::string> words = {"gain", folder_ / "half.bt", folder_ / "view.csv", "-o",
                                      folder_ / "g.csv"};
    words.insert(words.end(), region.begin(), region.end());
    const ProcessResult result = vantage(words);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.err;
  };
  EXPECT_EQ(errorsOf({"--bounds", "9,9,9,10,10,10"}).rfind("vantage: warning: --bounds: ", 0), 0u);
  EXPECT_EQ(errorsOf({"--sphere", "5,0,0,1"}).rfind("vantage: warning: --sphere: ", 0), 0u);
  EXPECT_EQ(errorsOf({"--bounds", "-1,-1,0,0,1,2", "--sphere", "1.5,0,0,1"}), "");
}

TEST_F(Octree, GainTellsWhatItCost) {
  const ProcessResult result =
      vantage({"gain", folder_ / "half.bt", folder_ / "view.csv", "-o", folder_ / "g.csv", "--json", "-",
               "-v", "--fov-deg", "60,45", "--range", "0,1"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["rays"], 336);
  EXPECT_EQ(json["visited"], 5358);
  EXPECT_EQ(json["most_unknown"], 176);
  EXPECT_EQ(json["rejected"], 0);
  EXPECT_GE(json["seconds"], 0.0);
  EXPECT_NE(result.err.find("gain: 1 view, 0 rejected, 336 rays"), std::string::npos) << result.err;
}

TEST_F(Octree, MapsAreNoScenes) {
  expectRefused(vantage({"explore", folder_ / "half.bt"}), {"half.bt", "is a .bt file", "vantage scenes"});
  expectRefused(vantage({"config", folder_ / "wall.ot"}), {"wall.ot", "is a .ot file"});
  writeFile(folder_ / "half.bt.toml", "map_min_m = [0, 0, 0]\nmap_max_m = [1, 1, 1]\n");
  expectRefused(vantage({"info", folder_ / "half.bt.toml"}), {"half.bt.toml", "which space", "half.bt'"});
}

TEST_F(Octree, CommandsThatWorkOnATsdfRefuseAnOctree) {
  const std::string map = folder_ / "half.bt";
  expectRefused(vantage({"contours", map, "-o", folder_ / "v.csv"}), {"half.bt", "octree", ".vti"});
  expectRefused(vantage({"segment", map, "-o", folder_ / "s.csv"}), {"half.bt", ".vti"});
}

TEST_F(Octree, DamagedMapsAreRefused) {
  const std::string whole = readFile(folder_ / "half.bt");
  writeFile(folder_ / "cut.bt", whole.substr(0, whole.size() - 5));
  expectRefused(vantage({"info", folder_ / "cut.bt"}), {"cut.bt", "truncated"});
  expectRefused(vantage({"info", folder_ / "absent.bt"}), {"absent.bt", "does not exist"});
  std::string color = whole;
  color.replace(color.find("id OcTree"), 9, "id ColorOcTree");
  writeFile(folder_ / "color.bt", color);
  expectRefused(vantage({"info", folder_ / "color.bt"}), {"color.bt", "'ColorOcTree'"});
}

TEST_F(Octree, RecordingsAreFusedIntoBothFormats) {
  const std::string tray = std::string(VANTAGE_TEST_DATA) + "/rgbd_ur5_tray";
  if (!std::filesystem::exists(tray)) GTEST_SKIP() << "recorded data set not here: " << tray;
  nlohmann::json facts[2];
  for (const int n : {0, 1}) {
    const std::string map = folder_ / (n == 0 ? "tray.bt" : "tray.ot");
    const ProcessResult result =
        vantage({"fuse", tray, "-o", map, "--frames", "0:3", "--voxel-size", "0.02"});
    ASSERT_EQ(result.code, 0) << result.err;
    const ProcessResult info = vantage({"info", map, "--json", "-"});
    ASSERT_EQ(info.code, 0) << info.err;
    facts[n] = nlohmann::json::parse(info.out);
    EXPECT_EQ(facts[n]["voxel_size_m"], 0.02);
    EXPECT_GT(facts[n]["occupied"].get<int>(), 500);
    EXPECT_GT(facts[n]["free"].get<int>(), 5000);
    EXPECT_GT(facts[n]["unknown"].get<int>(), 5000);
  }
  for (const char* key : {"free", "occupied", "unknown", "voxels", "object_min_m"})
    EXPECT_EQ(facts[0][key], facts[1][key]) << key;
}

TEST_F(Octree, BoundsOfAFusedMapAreTheObjectsBox) {
  const std::string tray = std::string(VANTAGE_TEST_DATA) + "/rgbd_ur5_tray";
  if (!std::filesystem::exists(tray)) GTEST_SKIP() << "recorded data set not here: " << tray;
  const std::string map = folder_ / "tray.bt";
  ASSERT_EQ(vantage({"fuse", tray, "-o", map, "--frames", "0:2", "--voxel-size", "0.02", "--bounds",
                     "-0.41,-0.6,0,0.3,-0.1,0.3"})
                .code,
            0);
  const auto facts = nlohmann::json::parse(vantage({"info", map, "--json", "-"}).out);
  EXPECT_NEAR(facts["object_min_m"][0].get<double>(), -0.42, 1e-9);  // rounded outward
  EXPECT_NEAR(facts["object_max_m"][2].get<double>(), 0.3, 1e-9);
  EXPECT_LE(facts["voxels"][0].get<int>(), 36 + 2);
  for (const std::vector<std::string>& bad : {std::vector<std::string>{"--truncation", "0.1"},
                                              {"--mesh", folder_ / "m.ply"},
                                              {"--cloud", folder_ / "c.pcd"}}) {
    std::vector<std::string> words = {"fuse", tray, "-o", map};
    words.insert(words.end(), bad.begin(), bad.end());
    expectRefused(vantage(words), {bad[0], ".vti"});
  }
}

TEST_F(Octree, BoundsThatNothingWasMeasuredInAreWarnedOf) {
  const std::string tray = std::string(VANTAGE_TEST_DATA) + "/rgbd_ur5_tray";
  if (!std::filesystem::exists(tray)) GTEST_SKIP() << "recorded data set not here: " << tray;
  for (const char* name : {"far.bt", "far.vti"}) {
    const ProcessResult result = vantage({"fuse", tray, "-o", folder_ / name, "--frames", "0:1",
                                          "--voxel-size", "0.1", "--bounds", "90,90,90,91,91,91"});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err.rfind("vantage: warning: no measurement reaches the mapped box", 0), 0u)
        << result.err;
    EXPECT_NE(result.out.find("1 frame into"), std::string::npos) << result.out;
  }
}

TEST_F(Octree, TheHierarchicalTracerReadsATsdfToo) {
  const std::string tray = std::string(VANTAGE_TEST_DATA) + "/rgbd_ur5_tray";
  if (!std::filesystem::exists(tray)) GTEST_SKIP() << "recorded data set not here: " << tray;
  ASSERT_EQ(
      vantage({"fuse", tray, "-o", folder_ / "tray.vti", "--frames", "0:3", "--voxel-size", "0.02"}).code, 0);
  const auto facts = nlohmann::json::parse(vantage({"info", folder_ / "tray.vti", "--json", "-"}).out);
  const Vector middle(facts["origin_m"][0].get<double>() + 0.02 * facts["voxels"][0].get<int>() / 2,
                      facts["origin_m"][1].get<double>() + 0.02 * facts["voxels"][1].get<int>() / 2, 5.0);
  std::ostringstream views;  // from above, outside the map: empty there
  views << "id,x_m,y_m,z_m,qx,qy,qz,qw\n0," << middle.x() << ',' << middle.y() << ",2,1,0,0,0\n";
  writeFile(folder_ / "view.csv", views.str());
  const std::vector<std::string> range = {"--range", "0.4,4"};
  std::string rows[2];
  for (const int levels : {0, 2}) {
    const ProcessResult result =
        vantage({"gain", folder_ / "tray.vti", folder_ / "view.csv", "-o", "-", "--tracer", "hierarchical",
                 "--coarse-levels", std::to_string(levels), "--range", "0.4,4"});
    ASSERT_EQ(result.code, 0) << result.err;
    rows[levels / 2] = lines(result.out).at(1);
  }
  EXPECT_NE(rows[0], rows[1]);
  // A sensor in the first voxel, which nothing was measured in, is rejected by both tracers.
  std::ostringstream corner;
  corner << "id,x_m,y_m,z_m,qx,qy,qz,qw\n5," << facts["origin_m"][0] << ',' << facts["origin_m"][1] << ','
         << facts["origin_m"][2] << ",1,0,0,0\n";
  writeFile(folder_ / "view.csv", views.str() + corner.str().substr(corner.str().find('\n') + 1));
  for (const char* tracer : {"uniform", "hierarchical"}) {
    const ProcessResult result = vantage({"gain", folder_ / "tray.vti", folder_ / "view.csv", "-o", "-",
                                          "--tracer", tracer, "--range", "0.4,4"});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(lines(result.out).at(1).ends_with(",")) << result.out;
    EXPECT_TRUE(lines(result.out).at(2).ends_with(",position")) << result.out;
  }
  const auto unknown = [](const std::string& row) { return std::stod(row.substr(2)); };
  EXPECT_GT(unknown(rows[0]), 1000);
  EXPECT_NEAR(unknown(rows[1]) / unknown(rows[0]), 1.1, 0.3);
}

}  // namespace
}  // namespace vantage::test
