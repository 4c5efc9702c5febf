// Recipes as TOML files.
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "io/error.h"
#include "io/scene_table.h"
#include "io/suggest.h"
#include "snapshots/recipe.h"
#include "viewer/captions.h"

namespace vantage {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

constexpr std::pair<const char*, Figures*> kCaptions[] = {
    {"scan", scanFigures},        {"states", stateFigures},   {"contours", contourFigures},
    {"segments", segmentFigures}, {"views", viewFigures},     {"octree", octreeFigures},
    {"rays", rayFigures},         {"utility", utilityFigures}};

constexpr std::pair<const char*, double LayerStyle::*> kStyleNumbers[] = {
    {"unknown_opacity", &LayerStyle::unknown_opacity},   {"free_opacity", &LayerStyle::free_opacity},
    {"truth_opacity", &LayerStyle::truth_opacity},       {"surface_opacity", &LayerStyle::surface_opacity},
    {"saliency_max", &LayerStyle::saliency_max},         {"label_px", &LayerStyle::label_px},
    {"frustum_length_m", &LayerStyle::frustum_length_m}, {"line_scale", &LayerStyle::line_scale}};

constexpr std::pair<const char*, int LayerStyle::*> kStyleCounts[] = {
    {"ranked_views", &LayerStyle::ranked_views},
    {"unreachable_views", &LayerStyle::unreachable_views},
    {"coarse_rays", &LayerStyle::coarse_rays}};

constexpr std::pair<const char*, std::optional<int> LayerStyle::*> kStyleChoices[] = {
    {"octree_level", &LayerStyle::octree_level}, {"view_id", &LayerStyle::view_id}};

/// A number of the camera and what one unit of it in the file is.
struct CameraNumber {
  const char* key;
  double CameraView::*value;
  double unit;
};
constexpr CameraNumber kCameraNumbers[] = {{"azimuth_deg", &CameraView::azimuth_rad, kRadians},
                                           {"elevation_deg", &CameraView::elevation_rad, kRadians},
                                           {"fov_deg", &CameraView::fov_rad, kRadians},
                                           {"zoom", &CameraView::zoom, 1.0}};

constexpr std::pair<const char*, std::optional<double> CameraView::*> kCameraFrame[] = {
    {"front_m", &CameraView::front_m}, {"height_share", &CameraView::height_share}};

/// Settings are validated after each key, so that the message can name its line.
template <class Settings>
void check(const Settings& settings, const SceneTable& table, const std::string& key) {
  try {
    settings.validate();
  } catch (const std::invalid_argument& error) {
    table.fail(key, error.what());
  }
}

int readCount(SceneTable& table, const char* key, int fallback) {
  const double count = table.number(key, fallback);
  if (count != std::floor(count) || std::abs(count) > 1e9)
    table.fail(key, std::string("'") + key + "' is no count; give a whole number");
  return static_cast<int>(count);
}

UtilityFactor readFactor(SceneTable& table, UtilityFactor fallback) {
  const std::string wanted = table.text("utility_factor", std::string(factorName(fallback)));
  if (const auto factor = factorNamed(wanted)) return *factor;
  std::vector<std::string> known;
  for (const std::string_view name : factorNames()) known.emplace_back(name);
  table.fail("utility_factor", "there is no factor '" + wanted + "'" + suggestion(wanted, known));
}

/// `slice_axis` shows one slice alone and `slice_at_m` places it; `slice_x_m` and its like add one each.
void readSlices(SceneTable& table, LayerStyle& style) {
  std::string shown;
  for (int axis = 0; axis < 3; ++axis)
    if (style.slices[axis].shown) shown += static_cast<char>('x' + axis);
  const std::string axis = table.text("slice_axis", shown);
  if (table.has("slice_axis")) {
    if (axis != "x" && axis != "y" && axis != "z")
      table.fail("slice_axis", "'" + axis + "' is no axis; allowed: x, y, z");
    const SlicePlane plane{true, shown.empty() ? std::nullopt : style.slices[shown[0] - 'x'].at_m};
    style.slices = {};
    style.slices[axis[0] - 'x'] = plane;
  }
  table.accept({"slice_at_m"});
  if (table.has("slice_at_m")) {
    for (SlicePlane& plane : style.slices)
      if (plane.shown) plane.at_m = table.number("slice_at_m");
  }
  for (int n = 0; n < 3; ++n) {
    const std::string key = std::string("slice_") + static_cast<char>('x' + n) + "_m";
    table.accept({key});
    if (table.has(key)) style.slices[n] = {true, table.number(key)};
  }
  check(style, table, "slice_at_m");
}

ColorMap readColorMap(SceneTable& table) {
  const std::string wanted = table.text("color_map");
  if (wanted == "viridis") return ColorMap::Viridis;
  if (wanted == "cividis") return ColorMap::Cividis;
  table.fail("color_map", "there is no colour map '" + wanted + "'; allowed: viridis, cividis");
}

void readStyle(SceneTable table, LayerStyle& style) {
  for (const auto& [key, member] : kStyleNumbers) {
    style.*member = table.number(key, style.*member);
    check(style, table, key);
  }
  for (const auto& [key, member] : kStyleCounts) {
    style.*member = readCount(table, key, style.*member);
    check(style, table, key);
  }
  for (const auto& [key, member] : kStyleChoices) {
    table.accept({key});
    if (table.has(key)) style.*member = readCount(table, key, 0);
    check(style, table, key);
  }
  style.utility_factor = readFactor(table, style.utility_factor);
  readSlices(table, style);
  table.accept({"color_map"});
  if (table.has("color_map")) style.color_map = readColorMap(table);
  table.finish();
}

void readCamera(SceneTable table, CameraView& camera) {
  for (const auto& [key, member, unit] : kCameraNumbers) {
    table.accept({key});
    if (table.has(key)) camera.*member = table.number(key) * unit;
    check(camera, table, key);
  }
  for (const auto& [key, member] : kCameraFrame) {
    table.accept({key});
    if (table.has(key)) camera.*member = table.number(key);
    check(camera, table, key);
  }
  const std::string focus = table.text("focus", camera.object ? "object" : "workspace");
  if (focus != "object" && focus != "workspace")
    table.fail("focus", "there is no focus '" + focus + "'; allowed: workspace, object");
  camera.object = focus == "object";
  table.finish();
}

LayerSet readLayers(const toml::table& document, const std::string& source) {
  const toml::node* node = document.get("layers");
  if (!node)
    throw InputError(source, "'layers' is missing; name what is to be shown, e.g. layers = [\"surface\"]");
  const toml::array* names = node->as_array();
  if (!names || names->empty())
    throw InputError(tomlPlace(source, node->source()),
                     "'layers' is no list of names; write layers = [\"surface\"]");
  LayerSet layers;
  for (const toml::node& entry : *names) {
    const auto name = entry.value<std::string>();
    if (!entry.is_string() || !name)
      throw InputError(tomlPlace(source, entry.source()), "'layers' must hold names in quotes");
    const auto layer = layerNamed(*name);
    if (!layer) {
      std::vector<std::string> known;
      for (const std::string_view each : layerNames()) known.emplace_back(each);
      throw InputError(tomlPlace(source, entry.source()),
                       "there is no layer '" + *name + "'" + suggestion(*name, known));
    }
    layers.set(*layer, true);
  }
  return layers;
}

Figures* readCaption(SceneTable& table) {
  const std::string wanted = table.text("caption", "states");
  std::vector<std::string> known;
  for (const auto& [name, figures] : kCaptions) {
    if (wanted == name) return figures;
    known.emplace_back(name);
  }
  table.fail("caption", "there is no caption '" + wanted + "'" + suggestion(wanted, known));
}

toml::table parse(const std::filesystem::path& file) {
  constexpr std::uintmax_t kLargestFile = 1u << 20;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw InputError(file.string(), "is no file; give a recipe file or one of the built-in recipes");
  if (std::filesystem::file_size(file, error) > kLargestFile)
    throw InputError(file.string(), "is too large for a recipe; allowed: 1 MiB");
  try {
    return toml::parse_file(file.string());
  } catch (const toml::parse_error& broken) {
    throw InputError(tomlPlace(file.string(), broken.source()),
                     "broken TOML: " + std::string(broken.description()));
  }
}

/// A table of the document, or nothing if it is not there.
const toml::table* part(const toml::table& document, const char* name, const std::string& source) {
  const toml::node* node = document.get(name);
  if (node && !node->is_table())
    throw InputError(tomlPlace(source, node->source()),
                     std::string("'") + name + "' is no table; write [" + name + "] and its keys below");
  return node ? node->as_table() : nullptr;
}

}  // namespace

Recipe readRecipe(const std::filesystem::path& file) {
  const std::string source = file.string();
  const toml::table document = parse(file);
  Recipe recipe;
  recipe.name = file.stem().string();
  recipe.purpose = "recipe of " + source;
  recipe.view.layers = readLayers(document, source);
  if (const auto* style = part(document, "style", source))
    readStyle({*style, source, "style"}, recipe.view.style);
  if (const auto* camera = part(document, "camera", source))
    readCamera({*camera, source, "camera"}, recipe.view.camera);

  SceneTable top(document, source, "recipe");
  recipe.title = top.text("title", recipe.name);
  recipe.figures = readCaption(top);
  top.accept({"layers", "style", "camera"});
  top.finish();
  return recipe;
}

void setStyle(LayerStyle& style, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string source = "style '" + assignment + "'";
  if (equals == 0 || equals == std::string::npos || equals + 1 == assignment.size())
    throw InputError(source, "is no assignment; write KEY=VALUE, e.g. octree_level=2");
  const std::string key = assignment.substr(0, equals), value = assignment.substr(equals + 1);
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  toml::table table;
  if (*end == '\0')
    table.insert(key, number);
  else
    table.insert(key, value);
  readStyle({table, source, "style"}, style);
}

Recipe recipeFrom(const std::string& name_or_file) {
  const std::filesystem::path path(name_or_file);
  if (path.extension() == ".toml" || path.has_parent_path()) return readRecipe(path);
  return recipeNamed(name_or_file);
}

}  // namespace vantage
