#pragma once

#include <functional>
#include <string>

#include "viewer/commands.h"

namespace vantage {

/// What commands act on beside model and preferences: parts of the window.
struct WindowActions {
  std::function<void()> open_dialog, open_beside, close_beside, switch_run, screenshot, write_config, palette,
      cheat_sheet, quit, reset_eye, look_through_view, add_bookmark, measure;
  std::function<bool()> measuring, has_beside;
  std::function<void(int)> look_along, bookmark;
  std::function<void(int)> select_view;  ///< by so many rows of the table
  std::function<void(double, double)> orbit;
  std::function<void(double)> zoom;
};

class InspectorModel;
struct Preferences;

/// Every command of the inspector. Model, preferences and what the actions refer to must outlive it.
class InspectorCommands {
 public:
  InspectorCommands(InspectorModel& model, Preferences& preferences, WindowActions actions);
  InspectorCommands(const InspectorCommands&) = delete;  // its commands refer to it

  const Commands& list() const { return commands_; }

 private:
  Command& add(std::string id, std::string group, std::string title, Shortcut keys,
               std::function<void()> run);
  void flag(std::string id, std::string group, std::string title, Shortcut keys, bool& value);
  void addFile();
  void addTimeline();
  void addStages();
  void addView();
  void addLayers();
  void addWhatIf();
  void addWindow();
  void goToStage(int by);
  void setFontScale(double scale);

  InspectorModel& model_;
  Preferences& preferences_;
  WindowActions actions_;
  Commands commands_;
};

}  // namespace vantage
