#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/embedded_assets.h"
#include "scene_support.h"

namespace vantage {
namespace {

using test::inputError;
using test::sceneOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(SceneFile, PlacesSolidsByPositionAndAngles) {
  const SceneFile scene = sceneOf(R"(
    name = "two"
    [[solid]]
    kind = "box"
    object = "bar"
    color = "#0a14ff"
    position_m = [1.0, 2.0, 0.5]
    yaw_deg = 90.0
    size_m = [0.4, 0.2, 0.1]
    [[solid]]
    kind = "cylinder"
    role = "other"
    rpy_deg = [90.0, 0.0, 0.0]
    radius_m = 0.1
    height_m = 1.0
    [camera]
    width = 5
  )");
  ASSERT_EQ(scene.solids.size(), 2u);
  EXPECT_EQ(scene.name, "two");
  EXPECT_EQ(scene.solids[0].object(), "bar");
  EXPECT_EQ(scene.solids[0].color(), (Solid::Color{10, 20, 255}));
  EXPECT_TRUE(scene.solids[0].bounds().isApprox(
      Box(Eigen::Vector3d(0.9, 1.8, 0.5), Eigen::Vector3d(1.1, 2.2, 0.6)), 1e-6));
  EXPECT_EQ(scene.solids[1].role(), SolidRole::Other);
  EXPECT_NEAR(scene.solids[1].signedDistance({0, -0.5, 0}), -0.1, 1e-9);  // its axis fell over to -y
  EXPECT_THAT(scene.text, HasSubstr("width = 5"));
}

TEST(SceneFile, RoomEnclosesItsInnerSpace) {
  const SceneFile scene = sceneOf("[room]\nx_m=[-1,2]\ny_m=[-3,3]\nz_m=[0,2.5]\nthickness_m=0.2\n");
  ASSERT_EQ(scene.solids.size(), 6u);
  const auto distance = [&](const Eigen::Vector3d& p) {
    double best = 1e9;
    for (const Solid& solid : scene.solids) best = std::min(best, solid.signedDistance(p));
    return best;
  };
  EXPECT_NEAR(distance({0, 0, 1}), 1.0, 1e-9);
  EXPECT_NEAR(distance({-0.9, 2.8, 2.45}), 0.05, 1e-9);
  EXPECT_NEAR(distance({0, 0, -0.1}), -0.1, 1e-9);
  EXPECT_NEAR(distance({2.1, 0, 1}), -0.1, 1e-9);
  EXPECT_EQ(sceneMesh(scene, false).triangles.size(), 0u);
  EXPECT_EQ(sceneMesh(scene, true).triangles.size(), 72u);
}

TEST(SceneFile, LoadsAMeshBesideIt) {
  const test::TestFolder folder;
  folder.write("tri.obj", "v 0 0 0\nv 100 0 0\nv 0 100 0\nv 0 0 100\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const std::string path =
      folder.write("scene.toml", "[[solid]]\nkind='mesh'\nfile='tri.obj'\nscale=0.001\nposition_m=[0,0,1]\n");
  const SceneFile scene = loadScene(path);
  ASSERT_EQ(scene.solids.size(), 1u);
  EXPECT_EQ(scene.name, "scene");
  EXPECT_NEAR(scene.solids[0].bounds().max().z(), 1.1, 1e-6);
  EXPECT_LT(scene.solids[0].signedDistance({0.02, 0.02, 1.02}), 0);
  folder.write("tri.obj", "v 0 0 0\nf 1 2 3\n");
  EXPECT_THAT(inputError([&] { loadScene(path); }), HasSubstr("tri.obj:2: "));
}

struct Broken {
  std::string toml;
  std::string begins;
  std::string says;
};
class BrokenScene : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenScene, IsRefusedWithLineAndCause) {
  const std::string message = inputError([] { sceneOf(GetParam().toml); });
  EXPECT_THAT(message, StartsWith(GetParam().begins));
  EXPECT_THAT(message, HasSubstr(GetParam().says));
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    Every, BrokenScene,
    ::testing::Values(
        Broken{"name = \"x\n", "test.toml:1: ", "broken TOML"}, Broken{"", "test.toml: ", "empty"},
        Broken{"[[solid]]\nsize_m = [1,1,1]\n", "test.toml:1: ", "'kind' is missing"},
        Broken{"[[solid]]\nkind = 'bx'\nsize_m = [1,1,1]\n", "test.toml:2: ", "did you mean 'box'?"},
        Broken{"[[solid]]\nkind = 'box'\n", "test.toml:1: ", "'size_m' is missing"},
        Broken{"[[solid]]\nkind = 'box'\nsize_m = [1,-1,1]\n",
               "test.toml:2: ", "size_m = -1 is out of range"},
        Broken{"[[solid]]\nkind = 'box'\nsize_m = [1,1]\n", "test.toml:3: ", "an array of 3 numbers"},
        Broken{"[[solid]]\nkind = 'box'\nsize_m = [1,1,'a']\n", "test.toml:3: ", "give a number"},
        Broken{"[[solid]]\nkind = 'box'\nsize_m = [1,1,nan]\n", "test.toml:3: ", "not finite"},
        Broken{"[[solid]]\nkind='box'\nsize_m=[1,1,1]\nyaw_dg=3\n",
               "test.toml:4: ", "did you mean 'yaw_deg'?"},
        Broken{"[[solid]]\nkind='sphere'\nradius_m=1\nsize_m=[1,1,1]\n",
               "test.toml:4: ", "unknown key 'size_m'"},
        Broken{"[[solid]]\nkind='sphere'\nradius_m=true\n", "test.toml:3: ", "is a boolean"},
        Broken{"[[solid]]\nkind='sphere'\nradius_m=1\nrole='thing'\n",
               "test.toml:4: ", "unknown role 'thing'"},
        Broken{"[[solid]]\nkind='sphere'\nradius_m=1\ncolor='red'\n", "test.toml:4: ", "#rrggbb"},
        Broken{"[[solid]]\nkind='sphere'\nradius_m=1\nyaw_deg=1\nrpy_deg=[1,1,1]\n",
               "test.toml:4: ", "exclude"},
        Broken{"[[solid]]\nkind='mesh'\nfile='missing.ply'\n", "missing.ply: ", "no such mesh file"},
        Broken{"[[solid]]\nkind='lathe'\nprofile_m=[[0.1,0],[0.2]]\n", "test.toml:3: ", "array of 2 numbers"},
        Broken{"solid = 3\n", "test.toml:1: ", "[[solid]]"},
        Broken{"room = 3\n", "test.toml:1: ", "must be a table"},
        Broken{"[room]\nx_m=[1,-1]\ny_m=[0,1]\nz_m=[0,1]\n", "test.toml:2: ", "[low, high]"},
        Broken{"name = 5\n[room]\nx_m=[0,1]\ny_m=[0,1]\nz_m=[0,1]\n", "test.toml:1: ", "must be a string"}));

TEST(LoadScene, NamesTheNearestSceneOrTheMissingFile) {
  EXPECT_THAT(inputError([] { loadScene("tabeltop"); }), HasSubstr("did you mean 'tabletop'?"));
  EXPECT_THAT(inputError([] { loadScene("/nowhere/at/all.toml"); }), HasSubstr("no such file"));
  EXPECT_THAT(inputError([] { loadScene("/"); }), HasSubstr("is a folder"));
}

TEST(EmbeddedAssets, EqualTheirSourceFiles) {
  const std::vector<std::string> names = embeddedAssetNames("scenes/");
  ASSERT_GE(names.size(), 3u);
  for (const std::string& name : names) {
    std::ifstream file(std::string(VANTAGE_SOURCE_DIR) + "/assets/" + name, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    EXPECT_FALSE(text.empty());
    EXPECT_EQ(embeddedAsset(name), text) << name;
  }
  EXPECT_THAT(inputError([] { embeddedAsset("scenes/tabletop.tml"); }), HasSubstr("scenes/tabletop.toml"));
}

}  // namespace
}  // namespace vantage
