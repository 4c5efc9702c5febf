#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/config_file.h"
#include "scene_support.h"

namespace vantage {
namespace {

using test::inputError;
using test::sceneOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kBase = R"(
description = "below"
[room]
x_m = [-2.0, 2.0]
y_m = [-2.0, 2.0]
z_m = [0.0, 2.0]
[scan]
frames = 7
tilt_deg = 4.0
[[solid]]
kind = "box"
role = "table"
size_m = [1.0, 1.0, 0.5]
[[solid]]
kind = "sphere"
object = "mug"
position_m = [0.1, 0.2, 0.6]
radius_m = 0.1
[[solid]]
kind = "cylinder"
object = "mug"
position_m = [0.3, 0.2, 0.5]
radius_m = 0.02
height_m = 0.1
[[solid]]
kind = "sphere"
position_m = [0.0, -0.3, 0.55]
radius_m = 0.05
)";

std::vector<std::string> names(const SceneFile& scene) {
  std::vector<std::string> names;
  for (const Solid& solid : scene.solids)
    if (solid.role() != SolidRole::Room) names.push_back(solid.object());
  return names;
}

class SceneBase : public ::testing::Test {
 protected:
  void SetUp() override { folder_.write("below.toml", kBase); }
  SceneFile load(const std::string& toml) const { return loadScene(folder_.write("above.toml", toml)); }
  std::string error(const std::string& toml) const {
    return inputError([&] { load(toml); });
  }
  std::string path(const std::string& name) const { return folder_.path() + "/" + name; }

  test::TestFolder folder_;
};

TEST_F(SceneBase, ComesFirstAndTheOwnSolidsFollow) {
  const SceneFile scene = load("base = 'below.toml'\n[[solid]]\nkind='sphere'\nradius_m=0.1\n");
  EXPECT_THAT(names(scene), ElementsAre("box 1", "mug", "mug", "sphere 4", "sphere 5"));
  EXPECT_EQ(scene.solids.size(), 5u + 6u);
  EXPECT_EQ(scene.name, "above");
  EXPECT_EQ(scene.description, "");
}

TEST_F(SceneBase, LeavesOutRolesAndObjectsWithoutRenamingTheOthers) {
  const SceneFile whole = load("base = 'below.toml'\n");
  const SceneFile some = load("base = 'below.toml'\nwithout = ['mug', 'table']\n");
  EXPECT_THAT(names(some), ElementsAre("sphere 4"));
  EXPECT_EQ(some.solids[0].color(), whole.solids[3].color());
  EXPECT_THAT(names(load("base = 'below.toml'\nwithout = ['object']\n")), ElementsAre("box 1"));
  EXPECT_EQ(load("base = 'below.toml'\nwithout = ['room']\n").solids.size(), 4u);
}

TEST_F(SceneBase, MovesAllSolidsOfAnObjectAlike) {
  const SceneFile whole = load("base = 'below.toml'\n");
  const SceneFile scene =
      load("base = 'below.toml'\n[[move]]\nobject = 'mug'\nposition_m = [-0.4, 0.0, 1.0]\n");
  EXPECT_TRUE(scene.solids[1].pose().translation().isApprox(Eigen::Vector3d(-0.4, 0.0, 1.0), 1e-12));
  EXPECT_TRUE(scene.solids[2].pose().translation().isApprox(Eigen::Vector3d(-0.2, 0.0, 0.9), 1e-12));
  EXPECT_TRUE(scene.solids[3].pose().isApprox(whole.solids[3].pose(), 1e-12));
}

TEST_F(SceneBase, ConfigurationIsBelowTheOwn) {
  const SceneFile scene = load("base = 'below.toml'\n[scan]\nframes = 9\n[room]\nz_m = [0.0, 3.0]\n");
  Settings settings;
  applyScene(settings, scene);
  EXPECT_EQ(settings.exploration.scan.frames, 9);
  EXPECT_NEAR(settings.exploration.scan.tilt_rad, 0.0698, 1e-4);
  EXPECT_EQ(settings.origin("scan.frames"), path("above.toml"));
  EXPECT_EQ(settings.origin("scan.tilt_deg"), path("below.toml"));
  EXPECT_NEAR(sceneMesh(scene, true).vertices.empty() ? 0.0 : scene.solids[5].bounds().max().z(), 3.1, 1e-6);
}

TEST_F(SceneBase, TextDescribesTheSceneByItself) {
  folder_.write(
      "middle.toml",
      "base = 'below.toml'\nwithout = ['table']\n[[move]]\nobject = 'mug'\nposition_m = [1, 0.1, 0.3]\n");
  const SceneFile scene = load(
      "base = 'middle.toml'\n[scan]\ntilt_deg = 1.1\n[[solid]]\nkind='cone'\nradius_bottom_m=0.1\n"
      "radius_top_m=0\nheight_m=0.1\n");
  EXPECT_EQ(scene.layers.size(), 3u);
  EXPECT_THAT(names(scene), ElementsAre("mug", "mug", "sphere 4", "cone 5"));
  const SceneFile again = parseScene(scene.text, "recorded");
  EXPECT_EQ(again.layers.size(), 1u);
  EXPECT_EQ(again.name, scene.name);
  test::expectEqualSolids(again, scene);
  EXPECT_EQ(test::configurationOf(again), test::configurationOf(scene));
  const SceneFile below = loadScene(path("below.toml"));
  EXPECT_EQ(below.text, kBase);
}

TEST_F(SceneBase, MayBeAnEmbeddedSceneEvenOfTheOwnName) {
  const SceneFile scene =
      loadScene(folder_.write("tabletop.toml", "base = 'tabletop'\nwithout = ['panel']\n"));
  EXPECT_EQ(scene.name, "tabletop");
  EXPECT_EQ(scene.solids.size() + 1, loadScene("tabletop").solids.size());
}

TEST_F(SceneBase, ErrorsNameTheFileThatHoldsThem) {
  const std::string above = path("above.toml"), below = path("below.toml");
  EXPECT_THAT(error("base = 'beneath.toml'\n"),
              AllOf(StartsWith(above + ":1: "), HasSubstr("'beneath.toml'"), HasSubstr("no file beside")));
  EXPECT_THAT(error("\nbase = 'tabeltop'\n"),
              AllOf(StartsWith(above + ":2: "), HasSubstr("did you mean 'tabletop'?")));
  EXPECT_THAT(error("base = 3\n"), AllOf(StartsWith(above + ":1: "), HasSubstr("must be a string")));
  EXPECT_THAT(error("base = 'below.toml'\n[[solid]]\nkind = 'bx'\n"), StartsWith(above + ":3: "));
  const SceneFile scene = load("base = 'below.toml'\n\n[scan]\nfrmes = 3\n");
  Settings settings;
  EXPECT_THAT(inputError([&] { applyScene(settings, scene); }), StartsWith(above + ":4: "));
  folder_.write("below.toml", "\n[[solid]]\nkind = 'sphere'\nradius_m = -1\n");
  EXPECT_THAT(error("base = 'below.toml'\n"), StartsWith(below + ":3: "));
  folder_.write("below.toml", "room = 3\n");
  EXPECT_THAT(error("base = 'below.toml'\n"), StartsWith(below + ":1: "));
  folder_.write("below.toml", "solid = [3]\n");
  EXPECT_THAT(error("base = 'below.toml'\n"), StartsWith(below + ":1: "));
}

TEST_F(SceneBase, LoopsAreRefused) {
  EXPECT_THAT(error("base = 'above.toml'\n"),
              AllOf(StartsWith(path("above.toml") + ":1: "), HasSubstr("leads back to itself")));
  folder_.write("below.toml", "base = './above.toml'\n");
  EXPECT_THAT(error("base = 'below.toml'\n"),
              AllOf(StartsWith(path("below.toml") + ":1: "), HasSubstr("leads back to itself")));
  EXPECT_THAT(inputError([] { parseScene("base = 'box'\n", "box"); }), HasSubstr("leads back to itself"));
}

TEST_F(SceneBase, WithoutAndMoveMustFitTheBase) {
  const std::string base = "base = 'below.toml'\n", line = path("above.toml") + ":2: ";
  EXPECT_THAT(error(base + "without = ['mugg']\n"),
              AllOf(StartsWith(line), HasSubstr("'mugg'"), HasSubstr("did you mean 'mug'?")));
  EXPECT_THAT(error(base + "without = ['panel']\n"), StartsWith(line));
  EXPECT_THAT(error(base + "without = 'mug'\n"), AllOf(StartsWith(line), HasSubstr("list of names")));
  EXPECT_THAT(error(base + "without = ['mug', 3]\n"), AllOf(StartsWith(line), HasSubstr("list of names")));
  EXPECT_THAT(error(base + "without = ['mug', 'mug']\n"), StartsWith(line));
  EXPECT_THAT(error(base + "move = 3\n"), AllOf(StartsWith(line), HasSubstr("[[move]]")));
  EXPECT_THAT(error(base + "[[move]]\nobject = 'mugg'\nposition_m = [1, 1, 1]\n"),
              HasSubstr("did you mean 'mug'?"));
  EXPECT_THAT(error(base + "[[move]]\nobject = 'mug'\n"), HasSubstr("'position_m' is missing"));
  EXPECT_THAT(error(base + "[[move]]\nobject = 'mug'\nposition_m = [1, 1]\n"), HasSubstr("array of 3"));
  EXPECT_THAT(error(base + "[[move]]\nobject = 'mug'\nposition_m = [1, 1, 1]\nyaw = 3\n"),
              HasSubstr("unknown key 'yaw'"));
  EXPECT_THAT(inputError([] { sceneOf("without = ['panel']\n"); }), HasSubstr("there is none"));
  EXPECT_THAT(inputError([] { sceneOf("[[move]]\nobject = 'a'\n"); }), HasSubstr("there is none"));
  EXPECT_THAT(error(base + "without = ['object', 'table', 'room']\n"), HasSubstr("the scene is empty"));
}

}  // namespace
}  // namespace vantage
