#include "viewer/file_kind.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>

#include "io/config_file.h"
#include "io/dataset.h"
#include "io/run_database.h"
#include "io/scene_file.h"
#include "io/scene_table.h"
#include "io/suggest.h"
#include "io/text_file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHead = 4096;  // bytes in which every format says what it is
constexpr std::uintmax_t kLargestToml = 16u << 20;

constexpr std::pair<const char*, FileKind> kEndings[] = {
    {".vantage", FileKind::Run}, {".vti", FileKind::Tsdf},   {".bt", FileKind::Octree},
    {".ot", FileKind::Octree},   {".pcd", FileKind::Cloud},  {".ply", FileKind::Mesh},
    {".obj", FileKind::Mesh},    {".stl", FileKind::Mesh},   {".csv", FileKind::Table},
    {".toml", FileKind::Config}, {".bag", FileKind::Dataset}};

std::string endingOf(const fs::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

std::optional<std::string> headOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  std::string head(kHead, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

bool isSceneName(const fs::path& path) {
  return std::ranges::any_of(embeddedScenes(),
                             [&](const EmbeddedScene& s) { return s.name == path.string(); });
}

bool isRun(const std::string& head) {
  constexpr std::size_t kIdAt = 68;  // SQLite's application id, most significant byte first
  if (!head.starts_with("SQLite format 3") || head.size() < kIdAt + 4) return false;
  std::uint32_t id = 0;
  for (std::size_t i = 0; i < 4; ++i) id = id << 8 | static_cast<unsigned char>(head[kIdAt + i]);
  return id == kRunApplicationId;
}

/// By the number of faces that its header states.
FileKind kindOfPly(const std::string& head) {
  const std::size_t end = head.find("end_header"), face = head.find("element face ");
  if (face == std::string::npos || face > end) return FileKind::Cloud;
  return std::strtol(head.c_str() + face + std::strlen("element face "), nullptr, 10) > 0 ? FileKind::Mesh
                                                                                          : FileKind::Cloud;
}

/// A table of poses has an id, a position and a quaternion.
bool isViewTable(const std::string& head) {
  const std::string header = "," + head.substr(0, head.find_first_of("\r\n")) + ",";
  return std::ranges::all_of(std::array{",id,", ",x_m,", ",qw,"},
                             [&](const char* column) { return header.find(column) != std::string::npos; });
}

/// What the beginning of a file says beyond doubt.
std::optional<FileKind> kindOfContent(const std::string& head) {
  if (isRun(head)) return FileKind::Run;
  if (head.starts_with("#ROSBAG V")) return FileKind::Dataset;
  if (head.starts_with("# Octomap OcTree")) return FileKind::Octree;
  if (head.find("<VTKFile") < 256) return FileKind::Tsdf;
  if (head.starts_with("# .PCD") || head.starts_with("VERSION .7")) return FileKind::Cloud;
  if (head.starts_with("ply\n") || head.starts_with("ply\r")) return kindOfPly(head);
  if (isViewTable(head)) return FileKind::Views;
  return std::nullopt;
}

std::set<std::string> settingSections() {
  std::set<std::string> sections;
  for (const SettingInfo& setting : listSettings())
    sections.insert(setting.key.substr(0, setting.key.find('.')));
  return sections;
}

/// By its keys; Unknown if none of them is of a scene, a recipe or a configuration.
FileKind kindOfToml(const toml::table& table) {
  for (const char* key : {"solid", "room", "base"})
    if (table.contains(key)) return FileKind::Scene;
  if (table.contains("layers")) return FileKind::Recipe;
  if (table.empty()) return FileKind::Config;
  const std::set<std::string> sections = settingSections();
  const bool some = std::ranges::any_of(
      table, [&](const auto& entry) { return sections.contains(std::string(entry.first.str())); });
  return some ? FileKind::Config : FileKind::Unknown;
}

toml::table parseToml(const fs::path& path) {
  const std::string text = readTextFile(path, kLargestToml);
  try {
    return toml::parse(text, path.string());
  } catch (const toml::parse_error& broken) {
    throw InputError(tomlPlace(path.string(), broken.source()),
                     "broken TOML: " + std::string(broken.description()));
  }
}

FileKind kindOfEnding(const fs::path& path) {
  const std::string ending = endingOf(path);
  for (const auto& [known, kind] : kEndings)
    if (ending == known) return kind;
  return FileKind::Unknown;
}

std::string listOfKinds() {
  std::string text;
  for (const std::string& ending : knownEndings()) text += (text.empty() ? "" : ", ") + ending;
  return text + ", data set folders, names of built-in scenes (vantage scenes)";
}

/// Why a text of TOML is none of those that are known.
InputError whyUnknownToml(const fs::path& path) {
  const std::string name = path.string();
  for (const char* map : {".bt.toml", ".ot.toml"})
    if (name.ends_with(map))
      return {name, "is the text that says which space the octree beside it maps; look at '" +
                        name.substr(0, name.size() - 5) + "'"};
  if (name.ends_with(".bag.toml"))
    return {name, "describes the recording beside it; look at '" + name.substr(0, name.size() - 5) + "'"};
  if (path.filename() == "dataset.toml")
    return {name, "describes the recording in its folder; look at '" +
                      (path.has_parent_path() ? path.parent_path() : fs::path(".")).string() + "'"};
  try {
    parseToml(path);
  } catch (const InputError& error) {
    return error;
  }
  return {
      name,
      "is TOML, but no scene ([[solid]]), no recipe (layers) and no configuration (vantage config lists its "
      "keys)"};
}

}  // namespace

std::string_view nameOf(FileKind kind) {
  static constexpr std::array<std::string_view, 12> kNames = {
      "run",        "TSDF volume", "octree", "scene",         "point cloud", "mesh",
      "view table", "table",       "recipe", "configuration", "data set",    "unknown"};
  return kNames[static_cast<std::size_t>(kind)];
}

const std::vector<std::string>& knownEndings() {
  static const std::vector<std::string> endings = [] {
    std::vector<std::string> all;
    for (const auto& [ending, kind] : kEndings) all.emplace_back(ending);
    return all;
  }();
  return endings;
}

FileKind kindOf(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) return looksLikeDataset(path) ? FileKind::Dataset : FileKind::Unknown;
  if (!fs::exists(status)) return isSceneName(path) ? FileKind::Scene : FileKind::Unknown;
  if (!fs::is_regular_file(status)) return FileKind::Unknown;
  const std::optional<std::string> head = headOf(path);
  if (!head) return FileKind::Unknown;
  if (const auto kind = kindOfContent(*head)) return *kind;
  const FileKind kind = kindOfEnding(path);
  if (kind != FileKind::Config) return kind;
  if (path.filename() == "dataset.toml" || path.string().ends_with(".bag.toml")) return FileKind::Unknown;
  try {
    return kindOfToml(parseToml(path));
  } catch (const InputError&) {
    return FileKind::Unknown;
  }
}

InputError whyUnknown(const fs::path& path) {
  const std::string name = path.string();
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    std::vector<std::string> scenes;
    for (const EmbeddedScene& scene : embeddedScenes()) scenes.push_back(scene.name);
    if (path.has_parent_path() || path.has_extension()) return {name, "does not exist; check the path"};
    return {name, "no file and no built-in scene of this name" + suggestion(name, scenes)};
  }
  if (fs::is_directory(status))
    return {name, "is a folder, but no data set: it holds neither dataset.toml nor depth images with poses"};
  if (!fs::is_regular_file(status)) return {name, "is not a regular file"};
  if (!headOf(path)) return {name, "cannot be read; check its permissions"};
  if (endingOf(path) == ".toml") return whyUnknownToml(path);
  const std::string ending = endingOf(path);
  std::string near = nearest(ending, knownEndings());
  if (near.size() > 1 && near[1] != ending[1]) near.clear();  // in three letters any two are near each other
  return {name, "not a kind of file that is known" + (near.empty() ? "" : "; did you mean " + near + "?") +
                    "; known: " + listOfKinds()};
}

FileKind requireKind(const fs::path& path) {
  const FileKind kind = kindOf(path);
  if (kind == FileKind::Unknown) throw whyUnknown(path);
  return kind;
}

}  // namespace vantage
