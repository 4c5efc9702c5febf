#include "io/octree_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/io/data_support.h"

namespace vantage {
namespace {

using testing::HasSubstr;
using Vector = Eigen::Vector3d;

const Box kObject(Vector(-0.1, -0.2, 0.0), Vector(0.2, 0.1, 0.2));

OccupancyOctree randomMap() {
  const GridGeometry g =
      OccupancyOctree::gridAround(Box(Vector(-0.4, -0.5, -0.1), Vector(0.5, 0.3, 0.4)), 0.05);
  OccupancyOctree map(g, kObject, VoxelState::Unknown, {});
  std::mt19937 random(3);
  std::uniform_int_distribution<int> value(-4, 7);
  for (int n = 0; n < 300; ++n) {  // away from the border
    const Eigen::Vector3i v = g.voxel(random() % g.count());
    if ((v.array() > 0).all() && (v.array() < g.size.array() - 1).all()) map.set(v, 0.5f * value(random));
  }
  return map;
}

class OctreeFile : public FolderTest {
 protected:
  std::string readError(const std::filesystem::path& path) {
    return errorOf([&] { readOctree(path, {}); });
  }
};

TEST_F(OctreeFile, ProbabilitiesAndBoxesComeBack) {
  const OccupancyOctree map = randomMap();
  writeOctree(folder_ / "m.ot", map);
  const OccupancyOctree back = readOctree(folder_ / "m.ot", {});
  ASSERT_EQ(back.geometry().size, map.geometry().size);
  EXPECT_TRUE(back.objectBox().isApprox(kObject));
  std::size_t stored = 0;
  for (std::size_t n = 0; n < map.geometry().count(); ++n) {
    const auto value = map.logOdds(map.geometry().voxel(n));
    ASSERT_EQ(back.logOdds(back.geometry().voxel(n)), value);
    stored += value.has_value();
  }
  EXPECT_GT(stored, 200u);
}

TEST_F(OctreeFile, LabelsComeBackInTheSameGrid) {
  const OccupancyOctree map = randomMap();
  writeOctree(folder_ / "m.bt", map);
  const OccupancyOctree back = readOctree(folder_ / "m.bt", {});
  ASSERT_EQ(back.geometry().size, map.geometry().size);
  for (std::size_t n = 0; n < map.geometry().count(); ++n)
    ASSERT_EQ(back.label(back.geometry().voxel(n), 0), map.label(map.geometry().voxel(n), 0));
  // And again: the grid does not grow with every turn.
  writeOctree(folder_ / "n.bt", back);
  EXPECT_EQ(readOctree(folder_ / "n.bt", {}).geometry(), back.geometry());
  EXPECT_EQ(read("n.bt"), read("m.bt"));
}

TEST_F(OctreeFile, WithoutItsTextEverythingStoredAndARimIsTheMap) {
  OccupancyOctree map = randomMap();
  map.set({0, 5, 5}, 2.0f);
  writeOctree(folder_ / "m.ot", map);
  // What is stored at the border of the written grid gets an unknown neighbour.
  EXPECT_EQ(readOctree(folder_ / "m.ot", {}).geometry().size.x(), map.geometry().size.x() + 1);
  std::filesystem::remove(octreeBoxPath(folder_ / "m.ot"));
  const OccupancyOctree back = readOctree(folder_ / "m.ot", {});
  EXPECT_TRUE(back.objectBox().isApprox(back.geometry().bounds()));
  EXPECT_EQ(back.logOdds(back.geometry().voxelAt(map.geometry().center({0, 5, 5}))), 2.0f);
}

TEST_F(OctreeFile, MapsThatHoldNothingComeBackToo) {
  const OccupancyOctree map(randomMap().geometry(), kObject, VoxelState::Unknown, {});
  writeOctree(folder_ / "m.bt", map);  // all of it is unknown
  const OccupancyOctree back = readOctree(folder_ / "m.bt", {});
  EXPECT_EQ(back.geometry().size, map.geometry().size);
  EXPECT_TRUE(back.objectBox().isApprox(kObject));
  std::filesystem::remove(octreeBoxPath(folder_ / "m.bt"));
  EXPECT_THAT(readError(folder_ / "m.bt"), HasSubstr("m.bt: holds no voxel, and there is no m.bt.toml"));
  // What is wrong with the file itself is said first.
  std::string other = read("m.bt");
  other.replace(other.find("id OcTree"), 9, "id ColorOcTree");
  write("other.bt", other);
  EXPECT_THAT(readError(folder_ / "other.bt"), HasSubstr("'ColorOcTree'"));
}

TEST_F(OctreeFile, RefusesBadFilesAndNamesThem) {
  EXPECT_THAT(readError(folder_ / "absent.bt"), HasSubstr("absent.bt: cannot be read"));
  EXPECT_THAT(readError(folder_), HasSubstr("is a folder"));
  EXPECT_THAT(readError(write("text.bt", "hello\n")), HasSubstr("text.bt: is no OctoMap file"));
  writeOctree(folder_ / "m.ot", randomMap());
  const std::string whole = read("m.ot");
  EXPECT_THAT(readError(write("cut.ot", whole.substr(0, whole.size() / 2))), HasSubstr("cut.ot: truncated"));
  EXPECT_THAT(errorOf([&] { writeOctree(folder_ / "m.vti", randomMap()); }), HasSubstr(".bt (labels)"));
  EXPECT_THAT(errorOf([&] { writeOctree(folder_ / "no" / "m.bt", randomMap()); }),
              HasSubstr("cannot be created"));
}

TEST_F(OctreeFile, RefusesABadTextAndNamesItsKey) {
  writeOctree(folder_ / "m.bt", randomMap());
  const auto error = [&](const std::string& text) {
    write("m.bt.toml", text);
    return readError(folder_ / "m.bt");
  };
  const std::string map = "map_min_m = [0, 0, 0]\nmap_max_m = [1, 1, 1]\n";
  EXPECT_EQ(error(map), "no InputError");
  EXPECT_THAT(error("map_min_m = [0, 0, 0]\n"), HasSubstr("m.bt.toml: 'map_max_m' is missing"));
  EXPECT_THAT(error("map_min_m = [0, 0]\nmap_max_m = [1, 1, 1]\n"),
              HasSubstr("m.bt.toml:1: 'map_min_m' wants"));
  EXPECT_THAT(error("map_min_m = [0, nan, 0]\nmap_max_m = [1, 1, 1]\n"), HasSubstr("finite"));
  EXPECT_THAT(error("map_min_m = [2, 0, 0]\nmap_max_m = [1, 1, 1]\n"), HasSubstr("is above"));
  EXPECT_THAT(error(map + "objekt_min_m = [0, 0, 0]\n"), HasSubstr("did you mean 'object_min_m'"));
  EXPECT_THAT(error(map + "object_min_m = [0, 0, 0]\n"), HasSubstr("'object_max_m' is missing"));
  EXPECT_THAT(error("map_min_m = [0,\n"), HasSubstr("m.bt.toml:"));
  EXPECT_THAT(error("map_min_m = [0, 0, 0]\nmap_max_m = [1e9, 1, 1]\n"), HasSubstr("m.bt: "));
}

TEST_F(OctreeFile, ReadsRealMaps) {
  VANTAGE_RECORDED(folder, "octomap");
  const OccupancyOctree corridor = readOctree(folder / "geb079.bt", {});
  EXPECT_EQ(corridor.geometry().voxel_size_m, 0.08);
  // One voxel more on each side than what is stored.
  EXPECT_TRUE(corridor.geometry().bounds().min().isApprox(Vector(-8.08, -7.6, -0.4), 1e-6));
  EXPECT_TRUE(corridor.geometry().bounds().max().isApprox(Vector(31.04, 7.52, 2.88), 1e-6));
  EXPECT_EQ(corridor.nodeCount(), 532566u);
}

}  // namespace
}  // namespace vantage
