#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/cloud_file.h"
#include "io/dataset.h"
#include "io/mesh_file.h"
#include "io/run_file.h"
#include "io/scene_file.h"
#include "io/table_file.h"
#include "io/text_file.h"
#include "snapshots/recipe.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/inputs.h"
#include "viewer/app/json_output.h"
#include "viewer/file_kind.h"

namespace vantage::app {
namespace {

using Json = nlohmann::ordered_json;

/// One fact a line for people, one member for programs.
Json describeRun(const std::string& path) {
  const RunReader run(path);
  const RunHeader& h = run.header();
  std::uint64_t raw = 0, stored = 0;
  for (const ProductInfo& product : run.products()) {
    raw += product.raw_bytes;
    stored += product.stored_bytes;
  }
  return {{"kind", "run"},
          {"input", h.input},
          {"planner", h.planner},
          {"robot", h.robot},
          {"version", h.version},
          {"seed", h.seed},
          {"steps", run.steps().size()},
          {"closing_scan", run.hasClosing()},
          {"stop_reason", run.stopReason() ? Json(*run.stopReason()) : Json()},
          {"voxels", {h.volume.size.x(), h.volume.size.y(), h.volume.size.z()}},
          {"voxel_size_m", h.volume.voxel_size_m},
          {"product_bytes", raw},
          {"stored_bytes", stored},
          {"command", h.command_line}};
}

/// Voxels of the grid by state; space that is not stored is unknown.
Json describeOctree(const OccupancyOctree& map) {
  const GridGeometry& g = map.geometry();
  const OccupancyBand band(map.config());
  std::array<std::uint64_t, 3> states{};
  std::vector<float> values;
  for (std::uint32_t b = 0; b < map.bricks().total(); ++b) {
    const BrickRange r = map.bricks().range(b);
    values.resize((r.end - r.begin).prod());
    map.readBrick(b, values);
    for (const float value : values) ++states[static_cast<std::size_t>(band.label(value))];
  }
  const double voxel_m3 = std::pow(g.voxel_size_m, 3);
  const auto rounded = [](double x) { return std::round(x * 1e9) / 1e9; };
  const auto corner = [&](const Eigen::Vector3d& p) {
    return Json{rounded(p.x()), rounded(p.y()), rounded(p.z())};
  };
  return {{"kind", "octree"},
          {"voxels", {g.size.x(), g.size.y(), g.size.z()}},
          {"voxel_size_m", g.voxel_size_m},
          {"min_m", corner(g.bounds().min())},
          {"max_m", corner(g.bounds().max())},
          {"object_min_m", corner(map.objectBox().min())},
          {"object_max_m", corner(map.objectBox().max())},
          {"unknown", states[0]},
          {"free", states[1]},
          {"occupied", states[2]},
          {"free_m3", rounded(static_cast<double>(states[1]) * voxel_m3)},
          {"occupied_m3", rounded(static_cast<double>(states[2]) * voxel_m3)},
          {"nodes", map.nodeCount()}};
}

Json describeMap(const GlobalOptions& global, const std::string& path) {
  const LoadedMap map = loadMap(global, path, MapNeed::Either);
  if (!map.hasVolume()) return describeOctree(*map.octree);
  const GridGeometry& g = map.volume.geometry();
  std::array<std::uint64_t, 3> states{};
  std::uint16_t heaviest = 0;
  for (const TsdfVoxel& voxel : map.volume.voxels()) {
    ++states[static_cast<std::size_t>(voxel.state())];
    heaviest = std::max(heaviest, voxel.weight);
  }
  return {{"kind", "tsdf"},
          {"voxels", {g.size.x(), g.size.y(), g.size.z()}},
          {"voxel_size_m", g.voxel_size_m},
          {"origin_m", {g.origin_m.x(), g.origin_m.y(), g.origin_m.z()}},
          {"unknown", states[0]},
          {"free", states[1]},
          {"occupied", states[2]},
          {"largest_weight", heaviest}};
}

Json describeDataset(const std::string& path) {
  const Dataset dataset = openDataset(path);
  const PinholeCamera& c = dataset.camera;
  return {{"kind", "data set"},
          {"frames", dataset.frames.size()},
          {"image", {c.width, c.height}},
          {"intrinsics", {c.fx, c.fy, c.cx, c.cy}}};
}

Json describeCloud(const std::string& path) {
  const SurfaceCloud cloud = readCloud(path);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : cloud.points)
    if (p.allFinite()) box.extend(p);
  Json json = {{"kind", "cloud"}, {"points", cloud.points.size()}, {"triangles", cloud.triangles.size()}};
  if (!box.isEmpty()) {
    json["min_m"] = {box.min().x(), box.min().y(), box.min().z()};
    json["max_m"] = {box.max().x(), box.max().y(), box.max().z()};
  }
  return json;
}

Json describeScene(const std::string& name) {
  const SceneFile scene = loadScene(name);
  std::vector<std::string> objects;
  for (const Solid& solid : scene.solids)
    if (!solid.object().empty() && std::find(objects.begin(), objects.end(), solid.object()) == objects.end())
      objects.push_back(solid.object());
  return {{"kind", "scene"},
          {"name", scene.name},
          {"description", scene.description},
          {"solids", scene.solids.size()},
          {"objects", objects}};
}

/// Any table: its columns and rows; a view table is also checked.
Json describeTable(const std::string& path) {
  const std::string text = readTextFile(path, std::uintmax_t{1} << 30);
  const std::string header = text.substr(0, text.find_first_of("\r\n"));
  if (kindOf(path) == FileKind::Views)
    return {{"kind", "views"}, {"columns", header}, {"views", readViews(path).size()}};
  const auto lines = std::count(text.begin(), text.end(), '\n') + (!text.empty() && text.back() != '\n');
  if (lines == 0) throw InputError(path, "is empty; a table with a header row is wanted");
  return {{"kind", "table"}, {"columns", header}, {"rows", lines - 1}};
}

Json describeMesh(const std::string& path) {
  const TriangleMesh mesh = loadMesh(path);
  return {{"kind", "mesh"}, {"vertices", mesh.vertices.size()}, {"triangles", mesh.triangles.size()}};
}

Json describeRecipe(const std::string& path) {
  const Recipe recipe = readRecipe(path);
  Json layers = Json::array();
  for (const std::string_view name : layerNames())
    if (recipe.view.layers.has(*layerNamed(name))) layers.push_back(name);
  return {{"kind", "recipe"}, {"title", recipe.title}, {"layers", layers}};
}

/// The keys that a configuration sets.
Json describeConfig(const std::string& path) {
  Settings settings;
  applyTomlFile(settings, path);
  Json keys = Json::array();
  for (const auto& [key, origin] : settings.origins) keys.push_back(key);
  return {{"kind", "configuration"}, {"keys", keys}};
}

Json describe(const GlobalOptions& global, const std::string& path) {
  if (path.find('#') != std::string::npos) return describeMap(global, path);
  switch (requireKind(path)) {
    case FileKind::Run:
      return describeRun(path);
    case FileKind::Tsdf:
    case FileKind::Octree:
      return describeMap(global, path);
    case FileKind::Cloud:
      return describeCloud(path);
    case FileKind::Mesh:
      return path.ends_with(".ply") ? describeCloud(path) : describeMesh(path);
    case FileKind::Views:
    case FileKind::Table:
      return describeTable(path);
    case FileKind::Recipe:
      return describeRecipe(path);
    case FileKind::Config:
      return describeConfig(path);
    case FileKind::Dataset:
      return describeDataset(path);
    default:
      return describeScene(path);
  }
}

int info(const GlobalOptions& global, const std::string& path) {
  const Json facts = describe(global, path);
  if (global.json != "-")
    for (const auto& [key, value] : facts.items())
      fmt::print("{:<15} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
  writeJson(global.json, facts);
  return 0;
}

}  // namespace

void addInfo(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto path = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "info", "What a file holds: run, map, cloud, mesh, scene, table, recipe, configuration, data set");
  command
      ->add_option(
          "file", *path,
          "Run, RUN#STEP, .vti, .bt, .ot, .pcd, .ply, .obj, .stl, CSV, TOML, scene, data set folder, or .bag")
      ->required()
      ->type_name("FILE");
  command->footer("Example: vantage info tabletop.vantage");
  command->callback([&global, &action, path] { action = [&global, path] { return info(global, *path); }; });
}

}  // namespace vantage::app
