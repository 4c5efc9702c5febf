#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/gpu/gl_context.h"
#include "core/run_control.h"
#include "snapshots/recipe.h"
#include "viewer/offscreen_renderer.h"

namespace vantage {

/// Which pictures of a run are wanted.
struct SnapshotRequest {
  static constexpr int kSmallestSide = 160;
  static constexpr int kEnd = 0;
  /// One step; empty = all recorded ones and, where a recipe shows the map only, the map after the last scan.
  /// kEnd and the number after the last step name that map.
  std::optional<int> step;
  /// Names or files (recipeFrom()); empty = those of each step's planner, see defaultRecipes().
  std::vector<std::string> recipes;
  std::vector<std::string> style;  ///< settings for all recipes, each KEY=VALUE, see setStyle()
  int width = 1280, height = 800;  ///< pixels, kSmallestSide..kLargestPicture
  /// A file name ending in .png, or a folder. `{run}`, `{step}` and `{view}` are replaced by the run's name,
  /// the step's number and the recipe's name; in a folder the files are `{run}-step{step}-{view}.png`.
  std::string output;
  bool contact_sheet = true;  ///< all steps into a folder: also `{run}-sheet.png` there
};

/// Makes pictures of a recorded run with no display. Returns the files in the order in which they were
/// written. Steps are read one at a time. \throws InputError for a request that can't be met, GlUnavailable,
/// std::runtime_error naming a file that can't be written,
///         Cancelled.
std::vector<std::filesystem::path> takeSnapshots(const std::filesystem::path& run,
                                                 const SnapshotRequest& request,
                                                 const RunControl& control = {});

/// The picture of one recipe. `scene` must hold the frame already (Scene::setFrame).
RgbImage drawRecipe(Scene& scene, OffscreenRenderer& renderer, const Recipe& recipe, const SceneFrame& frame,
                    int width, int height);

/// File name of one picture from a request's output. \throws InputError for an unknown `{placeholder}`.
std::filesystem::path snapshotPath(const std::string& output, const std::string& run, int step,
                                   const std::string& recipe);

}  // namespace vantage
