#include "io/scene_compose.h"

#include <algorithm>
#include <filesystem>

#include "io/embedded_assets.h"
#include "io/scene_solids.h"
#include "io/scene_table.h"
#include "io/suggest.h"
#include "io/text_file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
constexpr std::uintmax_t kLargestFile = 16u << 20;
const std::string kFolder = "scenes/";
const std::string kEnding = ".toml";

bool isEmbedded(const std::string& name) {
  const std::vector<std::string> names = embeddedSceneNames();
  return std::ranges::find(names, name) != names.end();
}

/// Equal for equal scenes, however they are written.
std::string identity(const std::string& source) {
  std::error_code error;
  const fs::path path = isEmbedded(source) ? fs::path() : fs::weakly_canonical(fs::absolute(source), error);
  return path.empty() || error ? source : path.string();
}

/// \param above the files that are based on this one
SceneLayer readBase(const toml::node& node, const std::string& source,
                    const std::vector<std::string>& above) {
  const std::string where = tomlPlace(source, node.source());
  if (!node.is_string()) throw InputError(where, "'base' must be a string, the name of a scene");
  const std::string name = node.as_string()->get();
  const fs::path beside = fs::path(source).parent_path() / name;
  const std::string place = isEmbedded(name) ? name : beside.string();
  std::error_code error;
  if (!isEmbedded(name) && !fs::is_regular_file(beside, error))
    throw InputError(where, "'base' is '" + name + "': no built-in scene and no file beside this one" +
                                suggestion(name, embeddedSceneNames()));
  if (std::ranges::find(above, identity(place)) != above.end())
    throw InputError(where, "'base' is '" + name + "', which leads back to itself; name another scene");
  return readSceneLayer(place);
}

/// The list of a key in a scene file. \throws InputError unless it is one.
const toml::array& listOf(const toml::node& node, const std::string& source, const std::string& message) {
  if (!node.is_array()) throw InputError(tomlPlace(source, node.source()), message);
  return *node.as_array();
}

toml::array& solidsOf(toml::table& table, const std::string& source) {
  if (!table.contains("solid")) table.insert("solid", toml::array());
  toml::node& node = *table.get("solid");
  listOf(node, source, "'solid' is no list; write [[solid]]");
  for (const toml::node& entry : *node.as_array())
    if (!entry.is_table())
      throw InputError(tomlPlace(source, entry.source()), "'solid' must hold tables; write [[solid]]");
  return *node.as_array();
}

std::string textOf(const toml::node& solid, const std::string& key, const std::string& fallback) {
  return (*solid.as_table())[key].value_or(fallback);
}

/// Names that occur among the solids, those of roles too if they are wanted.
std::vector<std::string> namesIn(const toml::array& solids, bool roles) {
  std::vector<std::string> names;
  for (const toml::node& solid : solids) {
    names.push_back(textOf(solid, "object", ""));
    if (roles) names.push_back(textOf(solid, "role", "object"));
  }
  std::ranges::sort(names);
  names.erase(std::ranges::unique(names).begin(), names.end());
  return names;
}

/// Takes the solids of an object or a role out of the base, `room` also its [room].
bool leaveOut(const std::string& name, toml::table& base, toml::array& solids) {
  const std::size_t before = solids.size();
  for (auto solid = solids.begin(); solid != solids.end();) {
    const bool named = textOf(*solid, "object", "") == name || textOf(*solid, "role", "object") == name;
    solid = named ? solids.erase(solid) : solid + 1;
  }
  const bool room = name == "room" && base.erase("room") > 0;
  return room || solids.size() < before;
}

void applyWithout(const toml::node& node, const std::string& source, toml::table& base) {
  toml::array& solids = solidsOf(base, source);
  const std::string wanted = "'without' must be a list of names of objects or roles";
  for (const toml::node& entry : listOf(node, source, wanted)) {
    const std::string where = tomlPlace(source, entry.source());
    if (!entry.is_string()) throw InputError(where, wanted);
    const std::string name = entry.as_string()->get();
    if (!leaveOut(name, base, solids))
      throw InputError(where, "'without' names '" + name +
                                  "', and no object or role of the base is called so" +
                                  suggestion(name, namesIn(solids, true)));
  }
}

Eigen::Vector3d positionOf(SceneTable table) {
  if (!table.has("position_m")) return Eigen::Vector3d::Zero();
  return Eigen::Vector3d::Map(table.numbers("position_m", 3).data());
}

/// Shifts all solids of an object so that the first of them comes to lie at a place.
void moveObject(SceneTable& move, toml::array& solids) {
  const std::string object = move.text("object");
  const Eigen::Vector3d to = positionOf(move);
  if (!move.has("position_m")) move.fail("position_m", "'position_m' is missing");
  move.accept({"position_m"});
  move.finish();
  std::optional<Eigen::Vector3d> shift;
  for (toml::node& node : solids) {
    toml::table& solid = *node.as_table();
    if (textOf(solid, "object", "") != object) continue;
    const Eigen::Vector3d from = positionOf(SceneTable(solid, sourceOf(solid), "solid (" + object + ")"));
    if (!shift) shift = to - from;
    const Eigen::Vector3d p = from + *shift;
    solid.insert_or_assign("position_m", toml::array{p.x(), p.y(), p.z()});
  }
  if (!shift)
    move.fail("object", "no object of the base is called '" + object + "'" +
                            suggestion(object, namesIn(solids, false)));
}

void applyMoves(const toml::node& node, const std::string& source, toml::table& base) {
  const std::string wanted = "'move' is no list of tables; write [[move]]";
  for (const toml::node& entry : listOf(node, source, wanted)) {
    if (!entry.is_table()) throw InputError(tomlPlace(source, entry.source()), wanted);
    SceneTable move(*entry.as_table(), source, "move");
    moveObject(move, solidsOf(base, source));
  }
}

/// Values of `over` win over those of `under`. Moves, so that nodes keep their source.
void merge(toml::table& over, toml::table& under) {
  for (auto&& [key, node] : over) {
    toml::node* below = under.get(key.str());
    if (below && node.is_table() && below->is_table())
      merge(*node.as_table(), *below->as_table());
    else
      under.insert_or_assign(key.str(), std::move(node));
  }
}

/// Adds a file's own solids to those of its base.
void addSolids(toml::array& own, ComposedScene& scene, const std::string& source) {
  toml::array& solids = solidsOf(scene.table, source);
  for (toml::node& solid : own) {
    completeSolid(*solid.as_table(), ++scene.numbered);
    solids.push_back(std::move(*solid.as_table()));
  }
}

/// What a file changes in its base.
void changeBase(const toml::table& table, const std::string& source, toml::table& base) {
  for (const char* key : {"name", "description"}) base.erase(key);
  if (const toml::node* without = table.get("without")) applyWithout(*without, source, base);
  if (const toml::node* moves = table.get("move")) applyMoves(*moves, source, base);
}

void refuseChangesWithoutBase(const toml::table& table, const std::string& source) {
  for (const char* key : {"without", "move"})
    if (const toml::node* node = table.get(key))
      throw InputError(tomlPlace(source, node->source()),
                       "'" + std::string(key) + "' changes a base, and there is none; add base = \"SCENE\"");
}

/// \param above the files that are based on this one
ComposedScene compose(const SceneLayer& file, std::vector<std::string> above) {
  toml::table table = parseSceneToml(file.text, file.source);
  ComposedScene scene;
  above.push_back(identity(file.source));
  if (const toml::node* base = table.get("base")) {
    scene = compose(readBase(*base, file.source, above), above);
    changeBase(table, file.source, scene.table);
  } else {
    refuseChangesWithoutBase(table, file.source);
  }
  if (table.contains("solid")) addSolids(solidsOf(table, file.source), scene, file.source);
  for (const char* key : {"base", "without", "move", "solid"}) table.erase(key);
  merge(table, scene.table);
  scene.layers.push_back(file);
  return scene;
}

}  // namespace

std::vector<std::string> embeddedSceneNames() {
  std::vector<std::string> names;
  for (const std::string& asset : embeddedAssetNames(kFolder))
    if (asset.ends_with(kEnding))
      names.push_back(asset.substr(kFolder.size(), asset.size() - kFolder.size() - kEnding.size()));
  return names;
}

toml::table parseSceneToml(std::string_view text, const std::string& source) {
  try {
    return toml::parse(text, source);
  } catch (const toml::parse_error& error) {
    throw InputError(tomlPlace(source, error.source()), "broken TOML: " + std::string(error.description()));
  }
}

SceneLayer readSceneLayer(const std::string& name_or_path) {
  if (isEmbedded(name_or_path))
    return {name_or_path, std::string(embeddedAsset(kFolder + name_or_path + kEnding))};
  std::error_code error;
  if (fs::exists(name_or_path, error)) return {name_or_path, readTextFile(name_or_path, kLargestFile)};
  if (name_or_path.find('/') != std::string::npos || name_or_path.ends_with(kEnding))
    throw InputError(name_or_path, "no such file; give a scene file or the name of a built-in scene");
  throw InputError(name_or_path, "no built-in scene and no file of this name" +
                                     suggestion(name_or_path, embeddedSceneNames()));
}

ComposedScene composeScene(const SceneLayer& file) {
  return compose(file, {});
}

}  // namespace vantage
