#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "viewer/eye.h"
#include "viewer/panels/theme.h"
#include "viewer/view_settings.h"

namespace vantage {

/// A file that was opened earlier.
struct RecentFile {
  std::filesystem::path path;  ///< absolute, or the name of a built-in scene
  bool missing = false;        ///< it was not there when the preferences were read
};

/// A camera with a name.
struct Bookmark {
  std::string name;
  Eye eye;
};

/// What the inspector's window remembers until the next start. Sizes of panels are in heights of a letter.
struct Preferences {
  static constexpr double kSmallestFontScale = 0.5, kLargestFontScale = 3.0;
  static constexpr std::size_t kMostRecent = 12, kMostBookmarks = 100;

  ThemeName theme = ThemeName::Dark;
  double font_scale = 1.0;
  int window_width = 1280, window_height = 800;  ///< pixels
  double left_em = 20.0, right_em = 25.5, timeline_em = 11.0;
  bool show_left = true, show_right = true, show_timeline = true;
  bool show_inset = true, show_legend = true;
  bool keyboard_navigation = false;  ///< arrows and Tab move between widgets

  ViewSettings view;
  std::optional<Eye> eye;                ///< where the 3-D view was left
  std::vector<RecentFile> recent_files;  ///< at most kMostRecent, the most recent first
  std::vector<Bookmark> bookmarks;       ///< at most kMostBookmarks are kept

  /// Puts a file first among the recent ones.
  void addRecent(const std::filesystem::path& file);
  /// Where a file dialog begins: the folder of the most recent file that is there, else the current one.
  std::filesystem::path folder() const;
};

/// $XDG_STATE_HOME/vantage/inspector.toml, else ~/.local/state/vantage/inspector.toml; empty if neither
/// variable is set.
std::filesystem::path preferencesPath();

/// Preferences from a file; what it does not hold, and what cannot be understood, has its default. Never
/// throws for what is in it: a file with broken parts is kept beside it as `FILE.broken`. \param problem says
/// then what was wrong, one line; may be null. An empty path and a missing file give the defaults.
Preferences loadPreferences(const std::filesystem::path& file, std::string* problem = nullptr);

/// Creates or replaces the file, its folders included, in one move: whoever reads it meanwhile sees the old
/// or the new one. Nothing happens for an empty path. \throws std::runtime_error naming the file, which keeps
/// its content
void savePreferences(const std::filesystem::path& file, const Preferences& preferences);

}  // namespace vantage
