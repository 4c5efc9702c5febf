#include "viewer/inspector_commands.h"

#include <algorithm>
#include <array>
#include <utility>

#include "viewer/inspector_model.h"
#include "viewer/preferences.h"

namespace vantage {
namespace {

constexpr double kTurn_rad = 0.15, kNearer = 1.15, kFontStep = 1.1;

}  // namespace

InspectorCommands::InspectorCommands(InspectorModel& model, Preferences& preferences, WindowActions actions)
    : model_(model), preferences_(preferences), actions_(std::move(actions)) {
  addFile();
  addTimeline();
  addStages();
  addView();
  addLayers();
  addWhatIf();
  addWindow();
  for (const char* held :
       {"timeline.next", "timeline.previous", "stage.next", "stage.previous", "view.left", "view.right turn",
        "view.up", "view.down", "view.nearer", "view.farther", "selection.next", "selection.previous"})
    commands_.letRepeat(held);
}

Command& InspectorCommands::add(std::string id, std::string group, std::string title, Shortcut keys,
                                std::function<void()> run) {
  return commands_.add({.id = std::move(id),
                        .group = std::move(group),
                        .title = std::move(title),
                        .keys = keys,
                        .run = std::move(run)});
}

void InspectorCommands::flag(std::string id, std::string group, std::string title, Shortcut keys,
                             bool& value) {
  add(std::move(id), std::move(group), std::move(title), keys, [&value] { value = !value; }).checked =
      [&value] { return value; };
}

void InspectorCommands::addFile() {
  add("file.open", "File", "Open a file…", {keyOf('O'), true}, actions_.open_dialog);
  add("file.open beside", "File", "Open a file beside this one…", {keyOf('O'), true, true},
      actions_.open_beside);
  add("file.close beside", "File", "Close the file that is not active", {keyOf('W'), true},
      actions_.close_beside)
      .enabled = actions_.has_beside;
  add("file.switch", "File", "Go to the other file", {keyOf('X')}, actions_.switch_run).enabled =
      actions_.has_beside;
  add("file.screenshot", "File", "Save a picture of the view", {keyOf('S'), true}, actions_.screenshot)
      .enabled = [this] { return !model_.shown().empty(); };
  add("file.write config", "File", "Write the changed parameters to a file…", {keyOf('S'), true, true},
      actions_.write_config);
  add("file.quit", "File", "Quit", {keyOf('Q'), true}, actions_.quit);
}

void InspectorCommands::addTimeline() {
  const auto has_steps = [this] { return !model_.steps().empty(); };
  const auto last = [this] { return static_cast<int>(model_.steps().size()) - 1; };
  add("timeline.play", "Timeline", "Play or pause", {Key::Space}, [this] {
    if (model_.player.playing())
      model_.player.pause();
    else
      model_.player.play();
  }).enabled = has_steps;
  add("timeline.next", "Timeline", "Next step (or stage)", {Key::Right}, [this] { model_.next(); }).enabled =
      has_steps;
  add("timeline.previous", "Timeline", "Previous step (or stage)", {Key::Left}, [this] {
    model_.previous();
  }).enabled = has_steps;
  add("timeline.first", "Timeline", "First step", {Key::Home}, [this] { model_.goToStep(0); }).enabled =
      has_steps;
  add("timeline.last", "Timeline", "Last step", {Key::End}, [this, last] {
    model_.goToStep(last());
  }).enabled = has_steps;
}

void InspectorCommands::addStages() {
  Command& loop = add("timeline.loop", "Timeline", "Loop", {keyOf('L')},
                      [this] { model_.player.loop = !model_.player.loop; });
  loop.checked = [this] { return model_.player.loop; };
  Command& by_stage = add("timeline.by stage", "Timeline", "Stop at every stage", {keyOf('B')},
                          [this] { model_.player.by_stage = !model_.player.by_stage; });
  by_stage.checked = [this] { return model_.player.by_stage; };
  add("timeline.faster", "Timeline", "Faster", {Key::Period},
      [this] { model_.player.setSpeed(model_.player.speed() * 2.0); });
  add("timeline.slower", "Timeline", "Slower", {Key::Comma},
      [this] { model_.player.setSpeed(model_.player.speed() / 2.0); });
  add("stage.next", "Timeline", "Next stage of the step", {Key::PageDown}, [this] { goToStage(+1); });
  add("stage.previous", "Timeline", "Previous stage of the step", {Key::PageUp}, [this] { goToStage(-1); });
}

void InspectorCommands::goToStage(int by) {
  const int count = static_cast<int>(model_.stages().size());
  const int stage = std::clamp(model_.place().stage + by, 0, count - 1);
  model_.goTo({model_.place().step, stage});
  preferences_.view.layers = model_.stages()[stage].layers;
}

void InspectorCommands::addView() {
  add("view.reset", "View", "See everything", {keyOf('R')}, actions_.reset_eye);
  static constexpr std::array<const char*, 3> kSides = {"front", "right", "top"};
  for (int side = 0; side < 3; ++side)
    add(std::string("view.") + kSides[side], "View", std::string("Look from the ") + kSides[side],
        {keyOf(static_cast<char>('1' + side))}, [this, side] { actions_.look_along(side); });
  add("view.through", "View", "Look through the selected view", {keyOf('V')}, actions_.look_through_view);
  add("view.measure", "View", "Measure a distance", {keyOf('M')}, actions_.measure).checked =
      actions_.measuring;
  add("view.left", "View", "Turn left", {keyOf('A')}, [this] { actions_.orbit(kTurn_rad, 0.0); });
  add("view.right turn", "View", "Turn right", {keyOf('D')}, [this] { actions_.orbit(-kTurn_rad, 0.0); });
  add("view.up", "View", "Turn up", {keyOf('W')}, [this] { actions_.orbit(0.0, kTurn_rad); });
  add("view.down", "View", "Turn down", {keyOf('S')}, [this] { actions_.orbit(0.0, -kTurn_rad); });
  add("view.nearer", "View", "Nearer", {keyOf('E')}, [this] { actions_.zoom(kNearer); });
  add("view.farther", "View", "Farther", {keyOf('Q')}, [this] { actions_.zoom(1.0 / kNearer); });
  add("view.bookmark", "View", "Keep this camera as a bookmark", {keyOf('K'), true}, actions_.add_bookmark);
  for (int n = 0; n < 4; ++n)
    add("view.bookmark " + std::to_string(n + 1), "View", "Bookmark " + std::to_string(n + 1),
        {keyOf(static_cast<char>('1' + n)), true}, [this, n] { actions_.bookmark(n); })
        .enabled = [this, n] { return n < static_cast<int>(preferences_.bookmarks.size()); };
  flag("view.inset", "View", "Show what the view is predicted to see", {keyOf('I')}, preferences_.show_inset);
  flag("view.legend", "View", "Show the legend", {keyOf('G')}, preferences_.show_legend);
}

void InspectorCommands::addLayers() {
  static constexpr std::array<std::pair<Layer, const char*>, 8> kKeys = {{{Layer::Occupied, "4"},
                                                                          {Layer::Unknown, "5"},
                                                                          {Layer::Surface, "6"},
                                                                          {Layer::Segments, "7"},
                                                                          {Layer::ContourPoints, "8"},
                                                                          {Layer::RankedViews, "9"},
                                                                          {Layer::HitVoxels, "H"},
                                                                          {Layer::Occluders, "O"}}};
  for (const auto name : layerNames()) {
    const Layer layer = *layerNamed(name);
    Shortcut keys;
    for (const auto& [keyed, key] : kKeys)
      if (keyed == layer) keys.key = keyOf(key[0]);
    Command& command = add("layer." + std::string(name), "Layers", "Show " + std::string(layerTitle(layer)),
                           keys, [this, layer] {
                             LayerSet& layers = preferences_.view.layers;
                             layers.set(layer, !layers.has(layer));
                           });
    command.checked = [this, layer] { return preferences_.view.layers.has(layer); };
  }
  add("layers.overview", "Layers", "A bit of every stage", {keyOf('0')},
      [this] { goToStage(-model_.place().stage); });
}

void InspectorCommands::addWhatIf() {
  add("what-if.undo", "What-if", "Undo", {keyOf('Z'), true}, [this] { model_.whatIf().undo(); }).enabled =
      [this] { return model_.whatIf().edits().canUndo(); };
  add("what-if.redo", "What-if", "Redo", {keyOf('Y'), true}, [this] { model_.whatIf().redo(); }).enabled =
      [this] { return model_.whatIf().edits().canRedo(); };
  add("what-if.reset", "What-if", "Reset all parameters", {keyOf('R'), true}, [this] {
    model_.whatIf().resetAll();
  }).enabled = [this] { return model_.whatIf().edits().anyChanged(); };
  add("what-if.cancel", "What-if", "Cancel what runs in the background", {Key::Period, true}, [this] {
    model_.whatIf().cancel();
  }).enabled = [this] { return model_.whatIf().busy(); };
  add("what-if.run again", "What-if", "Run again what was cancelled", {Key::Period, true, true}, [this] {
    model_.whatIf().runAgain();
  }).enabled = [this] { return model_.whatIf().cancelled(); };
  add("selection.next", "What-if", "Select the next view of the table", {Key::Down},
      [this] { actions_.select_view(+1); });
  add("selection.previous", "What-if", "Select the view before it", {Key::Up},
      [this] { actions_.select_view(-1); });
  add("selection.clear", "What-if", "Select the chosen view", {keyOf('C')},
      [this] { model_.selected_view.reset(); });
}

void InspectorCommands::addWindow() {
  add("window.help", "Window", "Keys and mouse", {Key::F1}, actions_.cheat_sheet);
  add("window.palette", "Window", "All commands", {keyOf('P'), true}, actions_.palette);
  for (const ThemeName theme : themes()) {
    Command& command =
        add("window." + std::string(nameOf(theme)), "Window", "Theme: " + std::string(nameOf(theme)), {},
            [this, theme] { preferences_.theme = theme; });
    command.checked = [this, theme] { return preferences_.theme == theme; };
  }
  add("window.next theme", "Window", "Next theme", {keyOf('T')}, [this] {
    const int next = (static_cast<int>(preferences_.theme) + 1) % static_cast<int>(themes().size());
    preferences_.theme = themes()[next];
  });
  add("window.larger text", "Window", "Larger text", {Key::Equal, true},
      [this] { setFontScale(preferences_.font_scale * kFontStep); });
  add("window.smaller text", "Window", "Smaller text", {Key::Minus, true},
      [this] { setFontScale(preferences_.font_scale / kFontStep); });
  add("window.normal text", "Window", "Normal text", {keyOf('0'), true}, [this] { setFontScale(1.0); });
  flag("window.left", "Window", "Show layers and parameters", {functionKey(2)}, preferences_.show_left);
  flag("window.right", "Window", "Show views", {functionKey(3)}, preferences_.show_right);
  flag("window.timeline", "Window", "Show the timeline", {functionKey(4)}, preferences_.show_timeline);
  flag("window.keyboard", "Window", "Keys move inside the panels", {functionKey(6)},
       preferences_.keyboard_navigation);
}

void InspectorCommands::setFontScale(double scale) {
  preferences_.font_scale =
      std::clamp(scale, Preferences::kSmallestFontScale, Preferences::kLargestFontScale);
}

}  // namespace vantage
