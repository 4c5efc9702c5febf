#include "viewer/view_toml.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/geometry/check.h"
#include "io/error.h"
#include "io/scene_table.h"
#include "io/suggest.h"

namespace vantage {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr const char* kAxes = "xyz";

// Every field once, for both directions.
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

constexpr std::pair<const char*, std::optional<double> LayerStyle::*> kStyleLengths[] = {
    {"isolation_distance_m", &LayerStyle::isolation_distance_m}};

constexpr std::pair<const char*, double LayerLook::*> kLookNumbers[] = {{"opacity", &LayerLook::opacity},
                                                                        {"size", &LayerLook::size}};

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

constexpr std::pair<const char*, Eigen::Vector3d Eye::*> kEyeVectors[] = {
    {"position_m", &Eye::position}, {"focus_m", &Eye::focus}, {"up", &Eye::up}};

constexpr std::pair<const char*, ColorMap> kColorMaps[] = {{"viridis", ColorMap::Viridis},
                                                           {"cividis", ColorMap::Cividis}};

void finish(const SceneTable& table, UnknownKeys unknown) {
  if (unknown == UnknownKeys::Refused) table.finish();
}

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

[[noreturn]] void refuseName(SceneTable& table, const char* key, const std::string& what,
                             const std::string& wanted, const std::vector<std::string_view>& names) {
  const std::vector<std::string> known(names.begin(), names.end());
  table.fail(key, "there is no " + what + " '" + wanted + "'" + suggestion(wanted, known));
}

UtilityFactor readFactor(SceneTable& table, UtilityFactor fallback) {
  const std::string wanted = table.text("utility_factor", std::string(factorName(fallback)));
  if (const auto factor = factorNamed(wanted)) return *factor;
  refuseName(table, "utility_factor", "factor", wanted, factorNames());
}

SaliencyPart readPart(SceneTable& table, SaliencyPart fallback) {
  const std::string wanted = table.text("saliency_part", std::string(partName(fallback)));
  if (const auto part = partNamed(wanted)) return *part;
  refuseName(table, "saliency_part", "part of saliency", wanted, partNames());
}

/// `slices` names those that are shown; the other keys show the one that they place.
void readSlices(SceneTable& table, LayerStyle& style) {
  std::string shown;
  for (int n = 0; n < 3; ++n)
    if (style.slices[n].shown) shown += kAxes[n];
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
    const std::string key = std::string("slice_") + kAxes[n] + "_m";
    table.accept({key});
    if (table.has(key)) style.slices[n] = {true, table.number(key)};
  }
  table.accept({"slices"});
  if (table.has("slices")) {
    const std::string all = table.text("slices");
    if (all.find_first_not_of(kAxes) != std::string::npos)
      table.fail("slices", "'" + all + "' holds more than axes; allowed: any of x, y, z, e.g. \"xz\"");
    for (int n = 0; n < 3; ++n) style.slices[n].shown = all.find(kAxes[n]) != std::string::npos;
  }
  check(style, table, "slice_at_m");
}

/// Leaves the map as it was if the table has none.
void readColorMap(SceneTable& table, std::optional<ColorMap>& map) {
  table.accept({"color_map"});
  if (!table.has("color_map")) return;
  const std::string wanted = table.text("color_map");
  std::vector<std::string> known;
  for (const auto& [name, value] : kColorMaps) {
    if (wanted == name) {
      map = value;
      return;
    }
    known.emplace_back(name);
  }
  table.fail("color_map", "there is no colour map '" + wanted + "'" + suggestion(wanted, known));
}

void putColorMap(toml::table& table, const std::optional<ColorMap>& map) {
  for (const auto& [name, value] : kColorMaps)
    if (map == value) table.insert("color_map", name);
}

toml::array arrayOf(const Eigen::Vector3d& v) {
  return toml::array{v.x(), v.y(), v.z()};
}

Eigen::Vector3d vectorOf(SceneTable& table, const char* key) {
  const std::vector<double> v = table.numbers(key, 3);
  return {v[0], v[1], v[2]};
}

/// A number without the last digits that its unit brings.
double inUnit(double value, double unit) {
  const double rounded = std::round(value / unit * 1e9) / 1e9;
  return rounded * unit == value ? rounded : value / unit;
}

[[noreturn]] void refuseLayer(const toml::source_region& place, const std::string& source,
                              const std::string& name) {
  std::vector<std::string> known;
  for (const std::string_view each : layerNames()) known.emplace_back(each);
  throw InputError(tomlPlace(source, place), "there is no layer '" + name + "'" + suggestion(name, known));
}

}  // namespace

LayerSet readLayers(const toml::node& node, const std::string& source) {
  const toml::array* names = node.as_array();
  if (!names)
    throw InputError(tomlPlace(source, node.source()),
                     "'layers' is no list of names; write layers = [\"surface\"]");
  LayerSet layers;
  for (const toml::node& entry : *names) {
    const auto name = entry.value<std::string>();
    if (!entry.is_string() || !name)
      throw InputError(tomlPlace(source, entry.source()), "'layers' must hold names in quotes");
    const auto layer = layerNamed(*name);
    if (!layer) refuseLayer(entry.source(), source, *name);
    layers.set(*layer, true);
  }
  return layers;
}

toml::array layersToToml(const LayerSet& layers) {
  toml::array names;
  for (const std::string_view name : layerNames())
    if (layers.has(*layerNamed(name))) names.push_back(name);
  return names;
}

void readStyle(const toml::table& part, const std::string& source, UnknownKeys unknown, LayerStyle& style) {
  SceneTable table(part, source, "style");
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
  for (const auto& [key, member] : kStyleLengths) {
    table.accept({key});
    if (table.has(key)) style.*member = table.number(key);
    check(style, table, key);
  }
  style.utility_factor = readFactor(table, style.utility_factor);
  style.saliency_part = readPart(table, style.saliency_part);
  readColorMap(table, style.color_map);
  readSlices(table, style);
  finish(table, unknown);
}

toml::table styleToToml(const LayerStyle& style) {
  toml::table table;
  for (const auto& [key, member] : kStyleNumbers) table.insert(key, style.*member);
  for (const auto& [key, member] : kStyleCounts) table.insert(key, style.*member);
  for (const auto& [key, member] : kStyleChoices)
    if (style.*member) table.insert(key, *(style.*member));
  for (const auto& [key, member] : kStyleLengths)
    if (style.*member) table.insert(key, *(style.*member));
  table.insert("utility_factor", factorName(style.utility_factor));
  table.insert("saliency_part", partName(style.saliency_part));
  putColorMap(table, style.color_map);
  std::string shown;
  for (int n = 0; n < 3; ++n) {
    const SlicePlane& plane = style.slices[n];
    if (plane.shown) shown += kAxes[n];
    if (plane.at_m) table.insert(std::string("slice_") + kAxes[n] + "_m", *plane.at_m);
  }
  table.insert("slices", shown);
  return table;
}

void readCamera(const toml::table& part, const std::string& source, UnknownKeys unknown, CameraView& camera) {
  SceneTable table(part, source, "camera");
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
  const std::string wanted = table.text("focus", std::string(focusName(camera.focus)));
  const auto focus = focusNamed(wanted);
  if (!focus) refuseName(table, "focus", "focus", wanted, focusNames());
  camera.focus = *focus;
  table.accept({"eye"});
  if (const toml::table* eye = tomlPart(part, "eye", source)) camera.eye = readEye(*eye, source, unknown);
  finish(table, unknown);
}

toml::table cameraToToml(const CameraView& camera) {
  toml::table table;
  for (const auto& [key, member, unit] : kCameraNumbers) table.insert(key, inUnit(camera.*member, unit));
  for (const auto& [key, member] : kCameraFrame)
    if (camera.*member) table.insert(key, *(camera.*member));
  table.insert("focus", focusName(camera.focus));
  if (camera.eye) table.insert("eye", eyeToToml(*camera.eye));
  return table;
}

void readLooks(const toml::table& looks, const std::string& source, UnknownKeys unknown, ViewSettings& view) {
  for (const auto& [name, node] : looks) {
    const auto layer = layerNamed(name.str());
    if (!layer && unknown == UnknownKeys::Ignored) continue;
    if (!layer) refuseLayer(name.source(), source, std::string(name.str()));
    if (!node.is_table())
      throw InputError(tomlPlace(source, node.source()),
                       "a look is a table; write [looks." + std::string(name.str()) + "] and its keys below");
    SceneTable table(*node.as_table(), source, "look of " + std::string(name.str()));
    LayerLook& look = view.look(*layer);
    for (const auto& [key, member] : kLookNumbers) {
      look.*member = table.number(key, look.*member);
      check(look, table, key);
    }
    readColorMap(table, look.color_map);
    finish(table, unknown);
  }
}

toml::table looksToToml(const ViewSettings& view) {
  toml::table looks;
  for (const std::string_view name : layerNames()) {
    const LayerLook& look = view.look(*layerNamed(name));
    if (look == LayerLook()) continue;
    toml::table table;
    for (const auto& [key, member] : kLookNumbers) table.insert(key, look.*member);
    putColorMap(table, look.color_map);
    looks.insert(name, std::move(table));
  }
  return looks;
}

Box readBox(const toml::table& part, const std::string& source, UnknownKeys unknown) {
  SceneTable table(part, source, "box");
  const Box box(vectorOf(table, "min_m"), vectorOf(table, "max_m"));
  if (box.isEmpty()) table.fail("max_m", "'max_m' lies below 'min_m'");
  finish(table, unknown);
  return box;
}

toml::table boxToToml(const Box& box) {
  return toml::table{{"min_m", arrayOf(box.min())}, {"max_m", arrayOf(box.max())}};
}

Eye readEye(const toml::table& part, const std::string& source, UnknownKeys unknown) {
  SceneTable table(part, source, "eye");
  Eye eye;
  for (const auto& [key, member] : kEyeVectors) eye.*member = vectorOf(table, key);
  eye.fov_rad = table.number("fov_deg") * kRadians;
  try {
    requireInRange("fov_deg", eye.fov_rad / kRadians, 0.5, 150.0);
    requireInRange("distance to focus_m", eye.distance(), 1e-6, 1e6);
    requireInRange("length of up", eye.up.norm(), 1e-6, 1e6);
  } catch (const std::invalid_argument& error) {
    table.fail("position_m", error.what());
  }
  finish(table, unknown);
  return eye;
}

toml::table eyeToToml(const Eye& eye) {
  toml::table table;
  for (const auto& [key, member] : kEyeVectors) table.insert(key, arrayOf(eye.*member));
  table.insert("fov_deg", inUnit(eye.fov_rad, kRadians));
  return table;
}

const toml::table* tomlPart(const toml::table& document, const char* name, const std::string& source) {
  const toml::node* node = document.get(name);
  if (node && !node->is_table())
    throw InputError(tomlPlace(source, node->source()),
                     std::string("'") + name + "' is no table; write [" + name + "] and its keys below");
  return node ? node->as_table() : nullptr;
}

}  // namespace vantage
