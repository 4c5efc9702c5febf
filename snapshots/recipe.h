#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/exploration/planner_kind.h"
#include "viewer/captions.h"
#include "viewer/scene.h"

namespace vantage {

/// A named kind of picture of a step: built in, or a TOML file (readRecipe).
struct Recipe {
  std::string name;     ///< on the command line and in file names; of a file: its name without the ending
  std::string title;    ///< above the picture
  std::string purpose;  ///< one line for help texts
  ViewSettings view;
  Figures* figures = nullptr;  ///< the sentence under the title
  /// Shows products of planning, which the map after the last scan does not have.
  bool planning() const;
  /// It shows the rays of a view, or where it comes from, so that LayerStyle::view_id means something.
  bool showsRays() const;
  /// It is about products of the other kind of planner alone, e.g. rays for a step planned on contours.
  bool foreign(PlannerKind planner) const;
  /// The products that it shows can exist for a step of that planner.
  bool fits(PlannerKind planner) const;
};

/// All recipes, in the order of a contact sheet's columns.
const std::vector<Recipe>& recipes();

/// Names of all recipes.
std::vector<std::string> recipeNames();

/// The one that shows a run's arm.
inline constexpr const char* kArmRecipe = "arm";

/// Names of those that are made of a step unless others are asked for.
std::vector<std::string> defaultRecipes(PlannerKind planner = PlannerKind::Contour);

/// The same for a whole run, for all its planners (RunHeader::planner) and its arm, each recipe once.
std::vector<std::string> defaultRecipesOf(const RunHeader& header);

/// \throws InputError that suggests the nearest known name.
const Recipe& recipeNamed(const std::string& name);

/// A recipe of one's own. All keys but `layers` may be left out; then the value is that of the built-in
/// recipes.
///
///     title = "Below the jugs"               # above the picture; default: the file's name
///     caption = "states"                     # sentence under the title: scan, filters, states, contours,
///                                            # normals, poses, segments, views, octree, rays, utility
///     layers = ["surface", "unknown"]        # see layerNames(); workspace, axes are layers too
///
///     [style]
///     unknown_opacity = 0.1                  # (0, 0.15]
///     free_opacity = 0.06                    # (0, 0.15]
///     truth_opacity = 0.5                    # (0, 1]
///     surface_opacity = 1.0                  # (0, 1]
///     saliency_max = 0.8                     # upper end of the colour scale
///     saliency_part = "saliency"             # what colours segments: saliency, roundness or isolation alone
///     isolation_distance_m = 0.05            # B_th of their saliency; default: the run's
///     ranked_views = 12                      # 0..500
///     unreachable_views = 0                  # 0..500
///     frustum_length_m = 0.1
///     slice_axis = "y"                       # normal of the one slice: x, y or z
///     slice_at_m = 0.05                      # its place on that axis; default: middle of the workspace
///     slice_x_m = 0.1                        # another slice; also slice_y_m, slice_z_m
///     slices = "xy"                          # which of them are shown
///     octree_level = 2                       # 0..8: nodes of 2^level voxels; default: where tracing starts
///     view_id = 17                           # whose rays or poses are drawn; default: the chosen view
///     coarse_rays = 300                      # how many of them at most
///     utility_factor = "utility"             # what colours candidates: utility, unknown, occupied, distance
///     label_px = 15
///     line_scale = 1.0
///     color_map = "cividis"                  # viridis or cividis; default: each layer's own
///
///     [camera]
///     azimuth_deg = -59                      # of the eye from +x about z
///     elevation_deg = 39                     # above the horizon
///     fov_deg = 25                           # vertical aperture
///     zoom = 1.0                             # 1: all that must be seen fills the picture
///     focus = "workspace"                    # what must be seen: workspace, object (its box) or segment
///     (the tried one's
///                                            # sphere)
///     front_m = 0.2                          # space before the workspace (-y) that must be seen
///     height_share = 0.8                     # share of the workspace's height that must be seen
///
///     [camera.eye]                           # exactly from here; then the rest of the camera does not count
///     position_m = [1.0, -1.0, 1.0]
///     focus_m = [0.0, 0.0, 0.1]              # what is looked at
///     up = [0.0, 0.0, 1.0]
///     fov_deg = 25
///
///     [looks.ranked-views]                   # of a layer, multiplied on top of its style
///     opacity = 0.5                          # [0, 1]
///     size = 2.0                             # widths of lines, points and letters, [0.2, 5]
///     color_map = "viridis"
///
///     [clip]                                 # maps, surfaces and contours are drawn in this box only
///     min_m = [-0.5, -0.5, 0.0]
///     max_m = [0.5, 0.5, 0.4]
///
/// \throws InputError naming FILE:LINE: not readable, not TOML, unknown keys or layers (with the nearest
/// known one), values out of range.
Recipe readRecipe(const std::filesystem::path& file);

/// The recipe of a command line: a file if it ends in .toml or has a folder, else a built-in one.
/// \throws InputError
Recipe recipeFrom(const std::string& name_or_file);

/// Sets one key of a style as a recipe file would, from "KEY=VALUE"; text needs no quotes. \throws InputError
void setStyle(LayerStyle& style, const std::string& assignment);

/// The recipe's view for a frame: without ground truth the fused surface stands in for the true scene, and
/// where there is no fused surface the occupied voxels do.
ViewSettings viewFor(const Recipe& recipe, const SceneFrame& frame);

}  // namespace vantage
