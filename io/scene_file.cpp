#include "io/scene_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "io/embedded_assets.h"
#include "io/scene_solids.h"
#include "io/scene_table.h"
#include "io/suggest.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
constexpr std::uintmax_t kLargestFile = 16u << 20;
constexpr std::size_t kMostSolids = 10000;
const std::string kFolder = "scenes/";
const std::string kEnding = ".toml";

std::string embeddedFile(const std::string& name) {
  return kFolder + name + kEnding;
}

std::vector<std::string> embeddedSceneNames() {
  std::vector<std::string> names;
  for (const std::string& asset : embeddedAssetNames(kFolder))
    if (asset.ends_with(kEnding))
      names.push_back(asset.substr(kFolder.size(), asset.size() - kFolder.size() - kEnding.size()));
  return names;
}

std::string readText(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) throw InputError(path, "is no file; give a scene file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw InputError(path, "cannot be read: " + error.message());
  if (size > kLargestFile)
    throw InputError(path, std::to_string(size) + " bytes are too many for a scene file; allowed: " +
                               std::to_string(kLargestFile));
  std::ifstream file(path, std::ios::binary);
  std::string text(size, '\0');
  if (!file.read(text.data(), static_cast<std::streamsize>(size)))
    throw InputError(path, "cannot be read; check its permissions");
  return text;
}

toml::table parseToml(std::string_view text, const std::string& source) {
  try {
    return toml::parse(text, source);
  } catch (const toml::parse_error& error) {
    throw InputError(tomlPlace(source, error.source()), "broken TOML: " + std::string(error.description()));
  }
}

std::string topLevelText(const toml::table& table, const std::string& key, const std::string& fallback,
                         const std::string& source) {
  const toml::node* node = table.get(key);
  if (!node) return fallback;
  if (!node->is_string())
    throw InputError(tomlPlace(source, node->source()), "'" + key + "' must be a string");
  return node->as_string()->get();
}

void readSolids(const toml::node& node, const std::string& source, const std::string& folder,
                std::vector<Solid>& solids) {
  const toml::array* array = node.as_array();
  if (!array) throw InputError(tomlPlace(source, node.source()), "'solid' is no list; write [[solid]]");
  if (array->size() > kMostSolids)
    throw InputError(tomlPlace(source, node.source()),
                     "too many solids; allowed: " + std::to_string(kMostSolids));
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::table* entry = array->get(i)->as_table();
    if (!entry)
      throw InputError(tomlPlace(source, array->get(i)->source()),
                       "'solid' must hold tables; write [[solid]]");
    SceneTable table(*entry, source, "solid " + std::to_string(i + 1));
    solids.push_back(readSolid(table, folder, i + 1));
  }
}

}  // namespace

const std::vector<std::string>& sceneGeometryKeys() {
  static const std::vector<std::string> keys = {"name", "description", "solid", "room"};
  return keys;
}

SceneFile parseScene(std::string_view text, const std::string& source, const std::string& folder) {
  const toml::table table = parseToml(text, source);
  SceneFile scene;
  scene.source_path = source;
  scene.text = std::string(text);
  scene.name = topLevelText(table, "name", fs::path(source).stem().string(), source);
  scene.description = topLevelText(table, "description", "", source);
  if (const toml::node* solids = table.get("solid")) readSolids(*solids, source, folder, scene.solids);
  if (const toml::node* room = table.get("room")) {
    if (!room->is_table()) throw InputError(tomlPlace(source, room->source()), "'room' must be a table");
    SceneTable room_table(*room->as_table(), source, "room");
    for (Solid& slab : readRoom(room_table)) scene.solids.push_back(std::move(slab));
  }
  if (scene.solids.empty()) throw InputError(source, "the scene is empty; add [[solid]] or [room]");
  return scene;
}

SceneFile loadScene(const std::string& name_or_path) {
  const std::vector<std::string> names = embeddedSceneNames();
  if (std::find(names.begin(), names.end(), name_or_path) != names.end())
    return parseScene(embeddedAsset(embeddedFile(name_or_path)), name_or_path, ".");
  std::error_code error;
  const bool looks_like_path = name_or_path.find('/') != std::string::npos || name_or_path.ends_with(kEnding);
  if (!fs::exists(name_or_path, error)) {
    if (looks_like_path)
      throw InputError(name_or_path, "no such file; give a scene file or the name of a built-in scene");
    throw InputError(name_or_path,
                     "no built-in scene and no file of this name" + suggestion(name_or_path, names));
  }
  const std::string folder = fs::path(name_or_path).parent_path().string();
  return parseScene(readText(name_or_path), name_or_path, folder.empty() ? "." : folder);
}

std::vector<EmbeddedScene> embeddedScenes() {
  std::vector<EmbeddedScene> scenes;
  for (const std::string& name : embeddedSceneNames()) {
    const toml::table table = parseToml(embeddedAsset(embeddedFile(name)), name);
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
