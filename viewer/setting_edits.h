#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/exploration/planner_kind.h"
#include "io/config_fields.h"
#include "io/config_file.h"

namespace vantage {

/// Settings of a run and what was changed of them, with undo. Values that are refused change nothing: what is
/// wanted is valid at all times.
class SettingEdits {
 public:
  /// Another run: its settings, nothing changed, nothing to undo.
  void setRecorded(Settings settings);

  const Settings& recorded() const { return recorded_; }
  const Settings& wanted() const { return wanted_; }
  config::Value value(const std::string& key) const;
  config::Value recordedValue(const std::string& key) const;
  bool changed(const std::string& key) const { return value(key) != recordedValue(key); }
  bool anyChanged() const;

  /// Takes over a value; true if it changed something. Changes of one key that follow each other are one for
  /// undo() until finishEdit(). A refused value sets error().
  bool set(const std::string& key, const config::Value& value);
  /// The same from what a person typed: see typedValue(), or a TOML value.
  bool setText(const std::string& key, const std::string& text);
  void finishEdit() { open_ = false; }
  bool reset(const std::string& key);
  /// All keys that are changed, as one change.
  bool resetAll();
  bool canUndo() const { return done_ > 0; }
  bool canRedo() const { return done_ < edits_.size(); }
  bool undo();
  bool redo();
  /// Why the last value of a key was refused; empty if it was not.
  std::string error(const std::string& key) const;

  /// The changed keys as a configuration file that applyToml() reads; a comment alone if there are none.
  std::string toml() const;
  /// The changed keys and their values in one line, "group.key = value, ..."; empty if there are none.
  std::string summary() const;
  /// Takes over what a configuration file sets of the planner's parameters (see parametersOf()), as one
  /// change. Returns the other keys that it sets differently from the run: planning again knows nothing of
  /// them. \throws InputError, std::invalid_argument for values that do not fit together; nothing changes
  /// then
  std::vector<std::string> load(const std::string& toml, const std::string& origin, PlannerKind planner);

 private:
  struct Change {
    std::string key;
    config::Value before, after;
  };
  using Edit = std::vector<Change>;  ///< what one undo takes back; never empty
  bool apply(const std::string& key, const config::Value& value);
  /// An edit of one key goes on until it is finished.
  void remember(Change change);
  /// Goes to valid settings in one finished edit; false if they are those that are wanted already.
  bool changeTo(const Settings& settings);

  Settings recorded_, wanted_;
  std::vector<Edit> edits_;
  std::size_t done_ = 0;
  bool open_ = false;  ///< the last edit goes on
  std::map<std::string, std::string> errors_;
};

}  // namespace vantage
