#include "viewer/file_kind.h"

#include <gmock/gmock.h>

#include <set>

#include "io/cloud_file.h"
#include "io/octree_file.h"
#include "io/run_file.h"
#include "io/table_file.h"
#include "io/volume_file.h"
#include "tests/support/process.h"

namespace vantage::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kScene = "[[solid]]\nkind = \"box\"\nsize_m = [1.0, 1.0, 1.0]\n";

std::string why(const fs::path& path) {
  EXPECT_EQ(kindOf(path), FileKind::Unknown) << path;
  return whyUnknown(path).what();
}

/// One file of each kind as the program itself writes it, under the given endings.
class FileKindTest : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    writeFile(folder_ / name, text);
    return folder_ / name;
  }
  TemporaryFolder folder_;
};

TEST_F(FileKindTest, KnowsWhatTheProgramWritesWhateverItIsCalled) {
  const auto rename = [&](const std::string& from, const std::string& to) {
    fs::rename(folder_ / from, folder_ / to);
    return folder_ / to;
  };
  TsdfVolume volume(GridGeometry{{0.0, 0.0, 0.0}, 0.1, {4, 4, 4}});
  { RunWriter writer(folder_ / "a.vantage", RunHeader{}); }
  EXPECT_EQ(kindOf(rename("a.vantage", "run.csv")), FileKind::Run);
  writeVolume(folder_ / "a.vti", volume);
  EXPECT_EQ(kindOf(rename("a.vti", "map.toml")), FileKind::Tsdf);
  OccupancyOctree octree(GridGeometry{{0.05, 0.05, 0.05}, 0.1, {4, 4, 4}},
                         Box(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()), VoxelState::Unknown, {});
  octree.set({1, 1, 1}, 0.8f);
  for (const std::string ending : {"bt", "ot"}) {
    writeOctree(folder_ / ("a." + ending), octree);
    EXPECT_EQ(kindOf(rename("a." + ending, "tree" + ending)), FileKind::Octree);
  }
  SurfaceCloud cloud{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<Eigen::Vector3f>(3, Eigen::Vector3f::UnitZ()), {}};
  writeCloud(folder_ / "a.pcd", cloud);
  EXPECT_EQ(kindOf(rename("a.pcd", "cloud")), FileKind::Cloud);
  writeCloud(folder_ / "a.ply", cloud);
  EXPECT_EQ(kindOf(folder_ / "a.ply"), FileKind::Cloud);
  cloud.triangles = {{0, 1, 2}};
  writeMesh(folder_ / "mesh.ply", cloud);
  EXPECT_EQ(kindOf(rename("mesh.ply", "mesh")), FileKind::Mesh);
  writeViews(folder_ / "views.csv", {{7, Pose::Identity(), {}}});
  EXPECT_EQ(kindOf(rename("views.csv", "views.txt")), FileKind::Views);
}

TEST_F(FileKindTest, TellsTomlFilesApartByTheirKeys) {
  EXPECT_EQ(kindOf(write("a.toml", kScene)), FileKind::Scene);
  EXPECT_EQ(kindOf(write("b.toml", std::string("[gain]\nthreshold = 500\n") + kScene)), FileKind::Scene);
  EXPECT_EQ(kindOf(write("based.toml", "base = \"tabletop\"\nwithout = [\"panel\"]\n")), FileKind::Scene);
  EXPECT_EQ(kindOf(write("c.toml", "layers = [\"surface\"]\n")), FileKind::Recipe);
  EXPECT_EQ(kindOf(write("d.toml", "[gain]\nthreshold = 500\n")), FileKind::Config);
  EXPECT_EQ(kindOf(write("e.toml", "[gain]\nthresold = 500\n")), FileKind::Config)
      << "its reader names the key";
  EXPECT_THAT(why(write("f.toml", "color = 1\n")), HasSubstr("no scene"));
  EXPECT_THAT(why(write("g.toml", "color = \n\n")), AllOf(HasSubstr("g.toml:1"), HasSubstr("broken TOML")));
  EXPECT_THAT(why(write("h.bt.toml", "map_min_m = [0, 0, 0]\n")),
              AllOf(HasSubstr("which space"), HasSubstr("h.bt'")));
}

TEST_F(FileKindTest, FallsBackOnTheEndingSoThatReadersCanSayWhatIsWrong) {
  for (const auto& [ending, kind] : {std::pair{"vantage", FileKind::Run},
                                     {"vti", FileKind::Tsdf},
                                     {"bt", FileKind::Octree},
                                     {"pcd", FileKind::Cloud},
                                     {"obj", FileKind::Mesh},
                                     {"STL", FileKind::Mesh},
                                     {"csv", FileKind::Table}})
    EXPECT_EQ(kindOf(write(std::string("x.") + ending, "nonsense\n")), kind) << ending;
}

TEST_F(FileKindTest, KnowsFoldersAndNamesOfScenes) {
  EXPECT_EQ(kindOf("tabletop"), FileKind::Scene);
  EXPECT_THAT(why("tabletopp"), HasSubstr("'tabletop'"));
  fs::create_directories(folder_ / "data");
  EXPECT_THAT(why(folder_ / "data"), HasSubstr("no data set"));
  write("data/dataset.toml", "");
  EXPECT_EQ(kindOf(folder_ / "data"), FileKind::Dataset);
  EXPECT_THAT(why(folder_ / "data/dataset.toml"), HasSubstr("recording in its folder"));
  EXPECT_EQ(kindOf(write("a.bag", "nonsense\n")), FileKind::Dataset) << "its reader says what is wrong";
  EXPECT_EQ(kindOf(write("recording", "#ROSBAG V2.0\n")), FileKind::Dataset);
  EXPECT_THAT(why(write("a.bag.toml", "[camera]\nfx = 1\n")),
              AllOf(HasSubstr("recording beside it"), HasSubstr("a.bag'")));
}

TEST_F(FileKindTest, SaysWhyAFileIsUnknown) {
  EXPECT_THAT(why(folder_ / "none.vti"), HasSubstr("does not exist"));
  EXPECT_THAT(why(write("a.vantge", "x")),
              AllOf(HasSubstr("not a kind of file that is known"), HasSubstr("did you mean .vantage?"),
                    HasSubstr("known: .vantage, .vti")));
  EXPECT_THAT(why(write("note.txt", "x")), Not(HasSubstr("did you mean"))) << "nor .bt";
  EXPECT_THAT(why(write("picture.jpeg", "x")), HasSubstr("known: "));
  EXPECT_THROW(requireKind(folder_ / "a.vantge"), InputError);
  EXPECT_THAT(why("/dev/null"), HasSubstr("not a regular file"));
}

TEST(FileKind, EveryKindHasANameOfItsOwn) {
  std::set<std::string_view> names;
  for (int k = 0; k <= static_cast<int>(FileKind::Unknown); ++k)
    names.insert(nameOf(static_cast<FileKind>(k)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(FileKind::Unknown) + 1);
}

}  // namespace
}  // namespace vantage::test
