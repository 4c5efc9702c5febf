#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "io/error.h"
#include "snapshots/recipe.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class RecipeFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("vantage-recipes-" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& text) const {
    std::ofstream(folder_ / "own.toml") << text;
    return folder_ / "own.toml";
  }
  std::string messageOf(const std::string& text) const {
    try {
      readRecipe(write(text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path folder_;
};

TEST_F(RecipeFile, EveryKeyReachesTheView) {
  const Recipe recipe = readRecipe(write(R"(
title = "Below the jugs"
caption = "views"
layers = ["surface", "ranked-views"]
[style]
unknown_opacity = 0.11
free_opacity = 0.12
truth_opacity = 0.13
surface_opacity = 0.14
saliency_max = 0.5
saliency_part = "roundness"
isolation_distance_m = 0.05
ranked_views = 7
unreachable_views = 3
frustum_length_m = 0.2
slice_axis = "z"
slice_at_m = 0.05
octree_level = 3
view_id = 17
coarse_rays = 99
utility_factor = "distance"
label_px = 20
line_scale = 2
[camera]
azimuth_deg = 90
focus = "object"
elevation_deg = 10
fov_deg = 30
zoom = 2.5
front_m = 0.4
height_share = 0.6
)"));
  EXPECT_EQ(recipe.name, "own");
  EXPECT_EQ(recipe.title, "Below the jugs");
  EXPECT_TRUE(recipe.figures == recipeNamed("views").figures);
  EXPECT_EQ(recipe.view.layers, (LayerSet{Layer::Surface, Layer::RankedViews}));
  LayerStyle style;
  style.unknown_opacity = 0.11;
  style.free_opacity = 0.12;
  style.truth_opacity = 0.13;
  style.surface_opacity = 0.14;
  style.saliency_max = 0.5;
  style.saliency_part = SaliencyPart::Roundness;
  style.isolation_distance_m = 0.05;
  style.ranked_views = 7;
  style.unreachable_views = 3;
  style.frustum_length_m = 0.2;
  style.slices = {SlicePlane{}, SlicePlane{}, SlicePlane{true, 0.05}};
  style.octree_level = 3;
  style.view_id = 17;
  style.coarse_rays = 99;
  style.utility_factor = UtilityFactor::Distance;
  style.label_px = 20;
  style.line_scale = 2;
  EXPECT_EQ(recipe.view.style, style);
  EXPECT_NEAR(recipe.view.camera.azimuth_rad, 1.5707963267948966, 1e-12);
  EXPECT_NEAR(recipe.view.camera.elevation_rad, 0.17453292519943295, 1e-12);
  EXPECT_NEAR(recipe.view.camera.fov_rad, 0.5235987755982988, 1e-12);
  EXPECT_EQ(recipe.view.camera.zoom, 2.5);
  EXPECT_EQ(recipe.view.camera.front_m, 0.4);
  EXPECT_EQ(recipe.view.camera.height_share, 0.6);
  EXPECT_EQ(recipe.view.style.octree_level, 3);
  EXPECT_EQ(recipe.view.style.view_id, 17);
  EXPECT_EQ(recipe.view.style.coarse_rays, 99);
  EXPECT_EQ(recipe.view.style.utility_factor, UtilityFactor::Distance);
  EXPECT_EQ(recipe.view.camera.focus, CameraFocus::Object);
}

TEST_F(RecipeFile, WhatIsLeftOutIsAsInTheBuiltInOnes) {
  const Recipe recipe = readRecipe(write("layers = [\"occupied\"]\n"));
  EXPECT_EQ(recipe.title, "own");
  EXPECT_EQ(recipe.view.style, LayerStyle());
  EXPECT_EQ(recipe.view.camera, CameraView());
  EXPECT_TRUE(recipe.figures == recipeNamed("states").figures);
}

TEST_F(RecipeFile, EveryLayerCanBeNamedAndPlanningIsKnownByLayers) {
  for (const std::string_view name : layerNames()) {
    const Recipe recipe = readRecipe(write("layers = [\"" + std::string(name) + "\"]\n"));
    EXPECT_TRUE(recipe.view.layers.has(*layerNamed(name))) << name;
  }
  EXPECT_TRUE(recipeNamed("views").planning());
  EXPECT_TRUE(recipeNamed("segments").planning());
  EXPECT_FALSE(recipeNamed("states").planning());
  EXPECT_FALSE(recipeNamed("scene").planning());
}

TEST_F(RecipeFile, MistakesAreNamedWithFileAndLine) {
  const std::string good = "layers = [\"surface\"]\n";
  EXPECT_THAT(messageOf("title = \"x\"\n"), HasSubstr("own.toml: 'layers' is missing"));
  EXPECT_THAT(messageOf("title = \"x\"\nlayers = [\"surfase\"]\n"),
              HasSubstr("own.toml:2: there is no layer 'surfase'; did you mean 'surface'?"));
  EXPECT_THAT(messageOf("layers = []\n"), HasSubstr("own.toml:1: 'layers' is no list of names"));
  EXPECT_THAT(messageOf("layers = [3]\n"), HasSubstr("own.toml:1: 'layers' must hold names"));
  EXPECT_THAT(messageOf(good + "tittle = \"x\"\n"),
              HasSubstr("own.toml:2: recipe: unknown key 'tittle'; did you mean 'title'?"));
  EXPECT_THAT(messageOf(good + "caption = \"stats\"\n"),
              HasSubstr("own.toml:2: recipe: there is no caption 'stats'"));
  EXPECT_THAT(messageOf(good + "[style]\nunknown_opacity = 0.9\n"),
              HasSubstr("own.toml:3: style: unknown_opacity"));
  EXPECT_THAT(messageOf(good + "[style]\nranked_views = 1.5\n"),
              HasSubstr("own.toml:3: style: 'ranked_views' is no"));
  EXPECT_THAT(messageOf(good + "[style]\nslice_axis = \"w\"\n"),
              HasSubstr("own.toml:3: style: 'w' is no axis"));
  EXPECT_THAT(messageOf(good + "[style]\nslice_at = 1\n"), HasSubstr("did you mean 'slice_at_m'?"));
  EXPECT_THAT(messageOf(good + "[camera]\nelevation_deg = 90\n"),
              HasSubstr("own.toml:3: camera: elevation_rad"));
  EXPECT_THAT(messageOf(good + "[camera]\nzom = 2\n"), HasSubstr("own.toml:3: camera: unknown key 'zom'"));
  EXPECT_THAT(messageOf(good + "[camera]\nfocus = \"all\"\n"),
              HasSubstr("own.toml:3: camera: there is no focus"));
  EXPECT_THAT(messageOf(good + "[style]\nutility_factor = \"gain\"\n"),
              HasSubstr("own.toml:3: style: there is no factor 'gain'"));
  EXPECT_THAT(
      messageOf(good + "[style]\nsaliency_part = \"round\"\n"),
      HasSubstr("own.toml:3: style: there is no part of saliency 'round'; did you mean 'roundness'?"));
  EXPECT_THAT(messageOf(good + "[style]\nisolation_distance_m = 0\n"),
              HasSubstr("own.toml:3: style: isolation_distance_m"));
  EXPECT_THAT(messageOf(good + "[style]\noctree_level = 9\n"), HasSubstr("own.toml:3: style: octree_level"));
  EXPECT_THAT(messageOf(good + "[style]\nview_id = -2\n"), HasSubstr("own.toml:3: style: view_id"));
  EXPECT_THAT(messageOf(good + "camera = 3\n"), HasSubstr("own.toml:2: 'camera' is no table"));
  EXPECT_THAT(messageOf("layers = [\n"), HasSubstr("broken TOML"));
}

TEST_F(RecipeFile, FilesAreKnownByEndingOrFolder) {
  EXPECT_EQ(recipeFrom("states").title, recipeNamed("states").title);
  EXPECT_EQ(recipeFrom(write("layers = [\"free\"]\n").string()).name, "own");
  try {
    recipeFrom("nowhere.toml");
    FAIL() << "a missing file went unnoticed";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("nowhere.toml: is no file"));
  }
}

}  // namespace
}  // namespace vantage
