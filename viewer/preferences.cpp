#include "viewer/preferences.h"

#include <toml++/toml.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "io/error.h"
#include "io/scene_table.h"
#include "io/text_file.h"
#include "viewer/file_kind.h"
#include "viewer/view_toml.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestFile = 1u << 20;
constexpr const char* kTitle = "# What the inspector of Vantage remembers; written when its window closes.\n";

// Every field once, for both directions.
struct Number {
  const char* key;
  double Preferences::*value;
  double low, high;
};
constexpr Number kNumbers[] = {
    {"font_scale", &Preferences::font_scale, Preferences::kSmallestFontScale, Preferences::kLargestFontScale},
    {"left_em", &Preferences::left_em, 1.0, 500.0},
    {"right_em", &Preferences::right_em, 1.0, 500.0},
    {"timeline_em", &Preferences::timeline_em, 1.0, 500.0}};

constexpr std::pair<const char*, int Preferences::*> kSizes[] = {{"width", &Preferences::window_width},
                                                                 {"height", &Preferences::window_height}};
constexpr int kSmallestWindow = 200, kLargestWindow = 32768;  // pixels

constexpr std::pair<const char*, bool Preferences::*> kFlags[] = {
    {"show_left", &Preferences::show_left},
    {"show_right", &Preferences::show_right},
    {"show_timeline", &Preferences::show_timeline},
    {"show_inset", &Preferences::show_inset},
    {"show_legend", &Preferences::show_legend},
    {"keyboard_navigation", &Preferences::keyboard_navigation}};

void requireBetween(SceneTable& table, const char* key, double value, double low, double high) {
  if (value >= low && value <= high) return;
  table.fail(key, std::string("'") + key + "' is out of range; allowed: " + shortestNumber(low) + " .. " +
                      shortestNumber(high));
}

void readWindow(SceneTable table, Preferences& preferences) {
  const std::string wanted = table.text("theme", std::string(nameOf(preferences.theme)));
  const auto theme = std::ranges::find(themes(), wanted, [](ThemeName name) { return nameOf(name); });
  if (theme == themes().end()) table.fail("theme", "there is no theme '" + wanted + "'");
  preferences.theme = *theme;
  for (const auto& [key, member, low, high] : kNumbers) {
    preferences.*member = table.number(key, preferences.*member);
    requireBetween(table, key, preferences.*member, low, high);
  }
  for (const auto& [key, member] : kSizes) {
    const double size = table.number(key, preferences.*member);
    requireBetween(table, key, size, kSmallestWindow, kLargestWindow);
    preferences.*member = static_cast<int>(size);
  }
  for (const auto& [key, member] : kFlags) preferences.*member = table.flag(key, preferences.*member);
}

toml::table windowToToml(const Preferences& preferences) {
  toml::table table{{"theme", nameOf(preferences.theme)}};
  for (const auto& [key, member, low, high] : kNumbers)
    table.insert(key, std::clamp(preferences.*member, low, high));
  for (const auto& [key, member] : kSizes)
    table.insert(key, std::clamp(preferences.*member, kSmallestWindow, kLargestWindow));
  for (const auto& [key, member] : kFlags) table.insert(key, preferences.*member);
  return table;
}

/// Reads the parts of a document one by one; a part that is broken keeps its default and leaves a message.
class PartsReader {
 public:
  PartsReader(const toml::table& document, std::string source)
      : document_(document), source_(std::move(source)) {}

  /// Hands a copy of `target` and the part to `read`; takes the copy over if that went well.
  template <class Target, class Read>
  void table(const char* name, Target& target, const Read& read) {
    attempt([&] {
      const toml::table* part = tomlPart(document_, name, source_);
      if (!part) return;
      Target changed = target;
      read(*part, changed);
      target = std::move(changed);
    });
  }

  template <class Target, class Read>
  void node(const char* name, Target& target, const Read& read) {
    attempt([&] {
      if (const toml::node* part = document_.get(name)) target = read(*part);
    });
  }

  template <class Read>
  void attempt(const Read& read) {
    try {
      read();
    } catch (const InputError& error) {
      if (problem_.empty()) problem_ = error.what();
    }
  }

  const std::string& source() const { return source_; }
  /// The first thing that was wrong.
  const std::string& problem() const { return problem_; }

 private:
  const toml::table& document_;
  std::string source_, problem_;
};

void readView(PartsReader& parts, ViewSettings& view) {
  parts.node("layers", view.layers, [&](const toml::node& node) { return readLayers(node, parts.source()); });
  const std::string& source = parts.source();
  parts.table("style", view.style, [&](const toml::table& part, LayerStyle& style) {
    readStyle(part, source, UnknownKeys::Ignored, style);
  });
  parts.table("camera", view.camera, [&](const toml::table& part, CameraView& camera) {
    readCamera(part, source, UnknownKeys::Ignored, camera);
  });
  parts.table("looks", view, [&](const toml::table& part, ViewSettings& settings) {
    readLooks(part, source, UnknownKeys::Ignored, settings);
  });
  parts.table("clip", view.clip, [&](const toml::table& part, std::optional<Box>& clip) {
    clip = readBox(part, source, UnknownKeys::Ignored);
  });
}

/// Entries of a list that can be understood; the others are left out.
void readRecent(PartsReader& parts, const toml::node& node, std::vector<RecentFile>& files) {
  const toml::array* list = node.as_array();
  if (!list) throw InputError(tomlPlace(parts.source(), node.source()), "'recent_files' is no list of paths");
  for (const toml::node& entry : *list) {
    const auto text = entry.value<std::string>();
    if (!text || text->empty() || files.size() >= Preferences::kMostRecent) continue;
    std::error_code error;
    files.push_back({*text, !fs::exists(*text, error) && kindOf(*text) == FileKind::Unknown});
  }
}

void readBookmarks(PartsReader& parts, const toml::node& node, std::vector<Bookmark>& bookmarks) {
  const toml::array* list = node.as_array();
  if (!list)
    throw InputError(tomlPlace(parts.source(), node.source()), "'bookmark' is no list; write [[bookmark]]");
  for (const toml::node& entry : *list) {
    const toml::table* part = entry.as_table();
    if (!part || bookmarks.size() >= Preferences::kMostBookmarks) continue;
    parts.attempt([&] {
      const Eye eye = readEye(*part, parts.source(), UnknownKeys::Ignored);
      bookmarks.push_back({SceneTable(*part, parts.source(), "bookmark").text("name"), eye});
    });
  }
}

Preferences fromToml(PartsReader& parts, const toml::table& document) {
  Preferences preferences;
  parts.table("window", preferences, [&](const toml::table& part, Preferences& changed) {
    readWindow({part, parts.source(), "window"}, changed);
  });
  readView(parts, preferences.view);
  parts.table("eye", preferences.eye, [&](const toml::table& part, std::optional<Eye>& eye) {
    eye = readEye(part, parts.source(), UnknownKeys::Ignored);
  });
  if (const toml::node* list = document.get("recent_files"))
    parts.attempt([&] { readRecent(parts, *list, preferences.recent_files); });
  if (const toml::node* list = document.get("bookmark"))
    parts.attempt([&] { readBookmarks(parts, *list, preferences.bookmarks); });
  return preferences;
}

toml::table toToml(const Preferences& preferences) {
  toml::array recent, bookmarks;
  for (const RecentFile& file : preferences.recent_files)
    if (recent.size() < Preferences::kMostRecent) recent.push_back(file.path.string());
  for (const Bookmark& bookmark : preferences.bookmarks) {
    if (bookmarks.size() >= Preferences::kMostBookmarks) break;
    toml::table entry = eyeToToml(bookmark.eye);
    entry.insert("name", bookmark.name);
    bookmarks.push_back(std::move(entry));
  }
  const ViewSettings& view = preferences.view;
  toml::table document{{"recent_files", std::move(recent)},   {"layers", layersToToml(view.layers)},
                       {"window", windowToToml(preferences)}, {"style", styleToToml(view.style)},
                       {"camera", cameraToToml(view.camera)}, {"looks", looksToToml(view)},
                       {"bookmark", std::move(bookmarks)}};
  if (view.clip) document.insert("clip", boxToToml(*view.clip));
  if (preferences.eye) document.insert("eye", eyeToToml(*preferences.eye));
  return document;
}

/// Keeps a file that cannot be understood in full, since the next save replaces it.
void keepAside(const fs::path& file) {
  std::error_code ignored;
  fs::copy_file(file, file.string() + ".broken", fs::copy_options::overwrite_existing, ignored);
}

}  // namespace

void Preferences::addRecent(const fs::path& file) {
  std::error_code error;
  const bool there = fs::exists(file, error);
  const fs::path path = there ? fs::absolute(file, error).lexically_normal() : file;
  std::erase_if(recent_files, [&](const RecentFile& recent) { return recent.path == path; });
  recent_files.insert(recent_files.begin(), {path, !there && kindOf(path) == FileKind::Unknown});
  if (recent_files.size() > kMostRecent) recent_files.resize(kMostRecent);
}

fs::path Preferences::folder() const {
  std::error_code error;
  for (const RecentFile& recent : recent_files)
    if (recent.path.has_parent_path() && fs::is_directory(recent.path.parent_path(), error))
      return recent.path.parent_path();
  const fs::path current = fs::current_path(error);
  return error ? fs::path("/") : current;
}

fs::path preferencesPath() {
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state && *state) return fs::path(state) / "vantage" / "inspector.toml";
  const char* home = std::getenv("HOME");
  if (home && *home) return fs::path(home) / ".local" / "state" / "vantage" / "inspector.toml";
  return {};
}

Preferences loadPreferences(const fs::path& file, std::string* problem) {
  std::error_code error;
  if (file.empty() || !fs::exists(file, error)) return {};
  std::string message;
  Preferences preferences;
  try {
    const toml::table document = toml::parse(readTextFile(file, kLargestFile), file.string());
    PartsReader parts(document, file.string());
    preferences = fromToml(parts, document);
    message = parts.problem();
  } catch (const toml::parse_error& broken) {
    message =
        tomlPlace(file.string(), broken.source()) + ": broken TOML: " + std::string(broken.description());
  } catch (const std::exception& other) {
    message = other.what();
  }
  if (message.empty()) return preferences;
  keepAside(file);
  if (problem)
    *problem = message + "; the default is used, and the file is kept as " + file.string() + ".broken";
  return preferences;
}

void savePreferences(const fs::path& file, const Preferences& preferences) {
  if (file.empty()) return;
  std::ostringstream text;
  text << kTitle << toToml(preferences) << "\n";
  const fs::path fresh = file.string() + "." + std::to_string(::getpid()) + ".new";
  try {
    if (file.has_parent_path()) fs::create_directories(file.parent_path());
    saveFile(fresh, text.str());
    fs::rename(fresh, file);
  } catch (const std::exception& error) {
    std::error_code ignored;
    fs::remove(fresh, ignored);
    throw std::runtime_error(file.string() + ": cannot be written (" + error.what() + ")");
  }
}

}  // namespace vantage
