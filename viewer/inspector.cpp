#include "viewer/inspector.h"

#include <imgui.h>

#include <algorithm>
#include <utility>

#include "io/text_file.h"
#include "viewer/inspector_commands.h"
#include "viewer/inspector_model.h"
#include "viewer/panels/dialogs.h"
#include "viewer/panels/file_dialog.h"
#include "viewer/panels/panel.h"
#include "viewer/panels/plot.h"
#include "viewer/panels/view_panel.h"
#include "viewer/panels/window_frame.h"

namespace vantage {

struct Inspector::State {
  State(GlContext& gl_, InspectorPorts ports_, Preferences preferences_)
      : gl(gl_),
        ports(std::move(ports_)),
        preferences(std::move(preferences_)),
        model(ports.wake),
        view(gl, scene),
        commands(model, preferences, actions()) {}

  GlContext& gl;
  InspectorPorts ports;
  Preferences preferences;
  Widgets widgets;
  CandidateState candidates;
  Scene scene;
  InspectorModel model;
  ViewPanel view;
  CommandPalette palette;
  CheatSheet cheat_sheet;
  FileDialog dialog;
  std::string after_dialog;  ///< what the chosen file is for: "open", "write config"
  bool close = false;
  int stage_before = 0;
  LayerSet stage_layers_before;
  bool eye_wanted = false;  ///< a recipe places the eye at the next frame
  std::filesystem::path file_before;
  InspectorCommands commands;  ///< last: refers to the others

  WindowActions actions();
  PanelContext panelContext();
  void keys();
  void viewWindow(PanelContext& context, const WindowLayout& l, double pixel_scale);
  void dialogs(PanelContext& context, const WindowLayout& l);
  void followModel();
  void screenshot();
  void writeConfig(const std::filesystem::path& file);
};

WindowActions Inspector::State::actions() {
  WindowActions a;
  a.open_dialog = [this] {
    after_dialog = "open";
    dialog.open(FileDialog::Mode::Open, preferences.folder());
  };
  a.write_config = [this] {
    after_dialog = "write config";
    dialog.open(FileDialog::Mode::Save, preferences.folder(), "config.toml");
  };
  a.screenshot = [this] { screenshot(); };
  a.palette = [this] { palette.open(); };
  a.cheat_sheet = [this] { cheat_sheet.toggle(); };
  a.quit = [this] { close = true; };
  const auto with_context = [this](auto run) {
    return [this, run] {
      PanelContext context = panelContext();
      run(context);
    };
  };
  a.reset_eye = with_context([this](PanelContext& c) { view.resetEye(c); });
  a.look_through_view = with_context([this](PanelContext& c) { view.lookThroughView(c); });
  a.look_along = [this](int side) {
    PanelContext context = panelContext();
    view.lookAlong(context, side);
  };
  a.add_bookmark = [this] {
    auto& bookmarks = preferences.bookmarks;
    bookmarks.push_back({"camera " + std::to_string(bookmarks.size() + 1), scene.eye()});
  };
  a.bookmark = [this](int n) {
    if (n < static_cast<int>(preferences.bookmarks.size())) view.setEye(preferences.bookmarks[n].eye);
  };
  a.measure = [this] { view.toggleMeasuring(); };
  a.measuring = [this] { return view.measuring(); };
  a.select_view = [this](int by) {
    candidates.table.show(model.recorded(), model.shown());
    const auto next = candidates.table.neighbour(model.explainedView(), by);
    if (next) model.selected_view = next;
  };
  a.orbit = [this](double left_rad, double up_rad) { view.orbitBy(left_rad, up_rad); };
  a.zoom = [this](double factor) { view.zoomBy(factor); };
  return a;
}

PanelContext Inspector::State::panelContext() {
  return {model,
          preferences,
          scene,
          widgets,
          candidates,
          commands.list(),
          themeOf(preferences.theme),
          ports.copy,
          [this](const Eye& eye) { view.setEye(eye); }};
}

/// Commands by their keys, unless something is being typed.
void Inspector::State::keys() {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantTextInput || dialog.isOpen()) return;
  for (const Command& command : commands.list().all()) {
    const Shortcut& keys = command.keys;
    if (keys.key == Key::None || keys.ctrl != io.KeyCtrl || keys.shift != io.KeyShift) continue;
    // Panels that are walked through with the keys keep the plain ones to themselves.
    if (preferences.keyboard_navigation && io.NavVisible && !keys.ctrl && keys.key < functionKey(1)) continue;
    if (ImGui::IsKeyPressed(static_cast<int>(keys.key), true) && command.enabled()) {
      command.run();
      return;
    }
  }
}

void Inspector::State::viewWindow(PanelContext& context, const WindowLayout& l, double pixel_scale) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
  const bool open = beginPart("3-D view", l.viewLeft(), l.menu, l.viewRight(), l.viewBottom(),
                              ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse |
                                  ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::PopStyleVar();
  if (open) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    view.draw(context, pixel_scale);
    if (model.shown().empty()) {
      const char* hint =
          model.loading() ? "loading…" : "Open a run with Ctrl+O, or drop a file here. F1 lists all keys.";
      ImGui::GetWindowDrawList()->AddText({at.x + 24.0f, at.y + 24.0f},
                                          packed(themeOf(preferences.theme).faint), hint);
    }
  }
  ImGui::End();
}

void Inspector::State::dialogs(PanelContext& context, const WindowLayout& l) {
  palette.draw(context);
  cheat_sheet.draw(context);
  drawNotices(context, l.viewLeft(), l.viewRight(), l.viewBottom());
  if (const auto file = dialog.draw(widgets)) {
    if (after_dialog == "open")
      model.open(*file);
    else
      writeConfig(*file);
  }
}

/// A stage that is gone to, by hand or by playing, brings its layers; so do a recipe and the first file.
void Inspector::State::followModel() {
  if (const auto recipe = model.takeRecipe()) {
    preferences.view = *recipe;
    eye_wanted = true;
  }
  if (model.file() != file_before) {
    eye_wanted |= !file_before.empty();
    file_before = model.file();
    stage_before = model.place().stage;
    preferences.addRecent(model.file());
  }
  if (model.recorded().empty()) return;
  LayerSet& shown = preferences.view.layers;
  const LayerSet& of_stage = model.stages()[model.place().stage].layers;
  const bool other_stage = model.place().stage != stage_before;
  // The same stage of another planner, or of the closing scan, has other layers.
  if (shown == LayerSet() || other_stage || shown == stage_layers_before) shown = of_stage;
  stage_before = model.place().stage;
  stage_layers_before = of_stage;
}

void Inspector::State::screenshot() {
  const StepData& shown = model.shown();
  if (shown.empty() || !ports.picture) return;
  const std::string stem =
      model.file().stem().string() + "-step" + std::to_string(shown.record->step) + "-view";
  std::filesystem::path file = stem + ".png";
  for (int n = 2; std::filesystem::exists(file); ++n) file = stem + "-" + std::to_string(n) + ".png";
  try {
    ViewSettings settings = preferences.view;
    settings.camera.eye = scene.eye();
    writePng(ports.picture(shown.frame(), settings, gl, 1280, 800), file);
    model.say(Notice::Level::Info, "picture saved as " + std::filesystem::absolute(file).string());
  } catch (const std::exception& e) {
    model.say(Notice::Level::Error, e.what());
  }
}

void Inspector::State::writeConfig(const std::filesystem::path& file) {
  try {
    saveFile(file, model.whatIf().edits().toml());
    model.say(Notice::Level::Info, "parameters written to " + file.string());
  } catch (const std::exception& e) {
    model.say(Notice::Level::Error, e.what());
  }
}

Inspector::Inspector(GlContext& context, InspectorPorts ports, Preferences preferences)
    : state_(std::make_unique<State>(context, std::move(ports), std::move(preferences))) {
  state_->model.read_recipe = state_->ports.recipe;
}

Inspector::~Inspector() = default;

void Inspector::open(const std::vector<std::filesystem::path>& files) {
  for (const auto& file : files) state_->model.open(file);
}

bool Inspector::update(double elapsed_s) {
  const bool changed = state_->model.update(elapsed_s);
  state_->followModel();
  const auto due_s = state_->view.nextRender_s();
  return changed || (due_s && *due_s <= 0.0);
}

void Inspector::draw(double pixel_scale) {
  State& s = *state_;
  s.widgets.beginFrame();
  ImGuiIO& io = ImGui::GetIO();
  io.ConfigFlags = s.preferences.keyboard_navigation ? ImGuiConfigFlags_NavEnableKeyboard : 0;
  PanelContext context = s.panelContext();
  s.keys();
  const WindowLayout layout = windowLayout(s.preferences);
  menuBar(context);
  s.viewWindow(context, layout, pixel_scale);
  if (s.eye_wanted && !s.model.recorded().empty()) {
    s.eye_wanted = false;
    s.view.resetEye(context);
  }
  leftPart(context, layout);
  rightPart(context, layout);
  timelinePart(context, layout);
  statusBar(context, layout);
  splitters(context, layout);
  s.dialogs(context, layout);
}

bool Inspector::idle() const {
  return state_->model.idle() && !state_->view.nextRender_s();
}

bool Inspector::wantsToClose() const {
  return state_->close;
}

const Preferences& Inspector::preferences() const {
  return state_->preferences;
}

const Widgets& Inspector::widgets() const {
  return state_->widgets;
}

const Commands& Inspector::commands() const {
  return state_->commands.list();
}

InspectorModel& Inspector::model() {
  return state_->model;
}

std::optional<std::string> Inspector::error() const {
  for (const Notice& notice : state_->model.notices())
    if (notice.level == Notice::Level::Error) return notice.text;
  return std::nullopt;
}

std::uint64_t Inspector::picturesRendered() const {
  return state_->view.viewport().framesRendered();
}

}  // namespace vantage
