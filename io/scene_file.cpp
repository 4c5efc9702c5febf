#include "io/scene_file.h"

#include <filesystem>
#include <sstream>

#include "io/config_file.h"
#include "io/scene_compose.h"
#include "io/scene_solids.h"
#include "io/scene_table.h"

namespace vantage {
namespace {

constexpr std::size_t kMostSolids = 10000;

/// Top-level keys that belong to the geometry; all others belong to the configuration.
const std::vector<std::string> kGeometryKeys = {"name", "description", "solid", "room",
                                                "base", "without",     "move"};

std::string topLevelText(const toml::table& table, const std::string& key, const std::string& fallback,
                         const std::string& source) {
  const toml::node* node = table.get(key);
  if (!node) return fallback;
  if (!node->is_string())
    throw InputError(tomlPlace(source, node->source()), "'" + key + "' must be a string");
  return node->as_string()->get();
}

void readSolids(const toml::array& entries, const std::string& source, std::vector<Solid>& solids) {
  if (entries.size() > kMostSolids)
    throw InputError(source, std::to_string(entries.size()) +
                                 " solids are too many; allowed: " + std::to_string(kMostSolids));
  for (const toml::node& entry : entries) {
    const std::string file = sourceOf(entry);
    SceneTable table(*entry.as_table(), file, "solid");
    solids.push_back(readSolid(table, std::filesystem::path(file).parent_path().string()));
  }
}

std::string textOf(toml::table table, const std::string& name) {
  table.insert_or_assign("name", name);
  std::ostringstream text;
  text << table << "\n";
  return text.str();
}

}  // namespace

SceneFile parseScene(std::string_view text, const std::string& source) {
  ComposedScene composed = composeScene({source, std::string(text)});
  const toml::table& table = composed.table;
  SceneFile scene;
  scene.source_path = source;
  scene.name = topLevelText(table, "name", std::filesystem::path(source).stem().string(), source);
  scene.description = topLevelText(table, "description", "", source);
  if (const toml::node* solids = table.get("solid")) readSolids(*solids->as_array(), source, scene.solids);
  if (const toml::node* room = table.get("room")) {
    const std::string file = sourceOf(*room);
    if (!room->is_table()) throw InputError(tomlPlace(file, room->source()), "'room' must be a table");
    SceneTable room_table(*room->as_table(), file, "room");
    for (Solid& slab : readRoom(room_table)) scene.solids.push_back(std::move(slab));
  }
  if (scene.solids.empty()) throw InputError(source, "the scene is empty; add [[solid]] or [room]");
  scene.text = composed.layers.size() == 1 ? std::string(text) : textOf(table, scene.name);
  scene.layers = std::move(composed.layers);
  return scene;
}

SceneFile loadScene(const std::string& name_or_path) {
  const SceneLayer file = readSceneLayer(name_or_path);
  return parseScene(file.text, file.source);
}

void applyScene(Settings& settings, const SceneFile& scene) {
  for (const SceneLayer& layer : scene.layers) applyToml(settings, layer.text, layer.source, kGeometryKeys);
}

std::vector<EmbeddedScene> embeddedScenes() {
  std::vector<EmbeddedScene> scenes;
  for (const std::string& name : embeddedSceneNames()) {
    const toml::table table = parseSceneToml(readSceneLayer(name).text, name);
    scenes.push_back({name, topLevelText(table, "description", "", name)});
  }
  return scenes;
}

TriangleMesh sceneMesh(const SceneFile& scene, bool include_room) {
  TriangleMesh mesh;
  for (const Solid& solid : scene.solids)
    if (include_room || solid.role() != SolidRole::Room) appendMesh(solid.mesh(), mesh);
  return mesh;
}

}  // namespace vantage
