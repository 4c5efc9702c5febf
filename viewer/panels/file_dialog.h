#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "viewer/panels/widgets.h"

namespace vantage {

/// Asks for a file: to open an existing one, or to save under a name, which asks before it replaces one.
/// Keyboard: arrows choose, Enter takes what is chosen or typed (a folder is entered), Tab completes a typed
/// path, Backspace outside the field goes up, Esc closes. Typed paths may be absolute, relative to the
/// folder, or begin with ~.
class FileDialog {
 public:
  enum class Mode { Open, Save };

  /// Something in the folder.
  struct Entry {
    std::string name;
    bool folder = false;
    std::uintmax_t bytes = 0;
    bool operator==(const Entry&) const = default;
  };

  /// Opens at the next draw(). Only files with endings that the program knows are listed, to save only those
  /// with the ending of `name`, unless all are asked for. \param name what stands in the field at first, and
  /// again in every folder that is entered to save; a name without an ending gets its ending. A folder that
  /// is not there gives way to the nearest one above it.
  void open(Mode mode, const std::filesystem::path& folder, const std::string& name = "");
  bool isOpen() const { return open_; }
  void close();

  /// Draws the dialog if it is open. Returns the chosen path once, absolute, and closes. Widgets: "file/up",
  /// "file/entry NAME", "file/name", "file/hidden", "file/all", "file/accept", "file/cancel", and for the
  /// question "file/replace" (key Y), "file/keep" (key N).
  std::optional<std::filesystem::path> draw(Widgets& widgets);

  const std::filesystem::path& folder() const { return folder_; }
  /// What is listed: folders first, then files, by name.
  const std::vector<Entry>& entries() const { return entries_; }
  /// What went wrong, as a line for people; empty if nothing did.
  const std::string& problem() const { return problem_; }

 private:
  void goTo(const std::filesystem::path& folder);
  void list();
  bool isWanted(const std::string& name) const;
  bool folderIsChosen() const;
  std::string question() const;
  float footerHeight() const;
  int listedIndex(int index) const;  ///< the nearest one that is listed
  void choose(int index);
  void accept();
  void drawPlace(Widgets& widgets);
  void drawEntries(Widgets& widgets);
  void drawField(Widgets& widgets);
  void drawButtons(Widgets& widgets);
  void drawQuestion(Widgets& widgets);
  void keys();

  Mode mode_ = Mode::Open;
  bool open_ = false, appearing_ = false, focus_field_ = false, scroll_ = false;
  bool show_hidden_ = false, show_all_ = false;
  bool typing_ = false;  ///< something stands in the field, which has the keyboard
  std::filesystem::path folder_;
  std::vector<Entry> entries_;
  int chosen_ = -1;
  std::string name_, problem_;
  std::string file_;                               ///< name to save under, whatever folder is chosen
  std::string ending_;                             ///< of files to save, ".toml"; empty = any that is known
  std::optional<std::filesystem::path> existing_;  ///< the file that would be replaced
  std::optional<std::filesystem::path> result_;
};

/// The path that a person typed: absolute, relative to `folder`, or with ~ for the home folder.
std::filesystem::path typedPath(const std::filesystem::path& folder, const std::string& typed);

/// The typed path as far as the names that begin like it agree; folders end in /. What was typed if there are
/// none.
std::string completedPath(const std::filesystem::path& folder, const std::string& typed);

}  // namespace vantage
