#include "viewer/inspector.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/text_file.h"
#include "viewer/captions.h"
#include "viewer/inspector_commands.h"
#include "viewer/inspector_model.h"
#include "viewer/panels/dialogs.h"
#include "viewer/panels/file_dialog.h"
#include "viewer/panels/panel.h"
#include "viewer/panels/plot.h"
#include "viewer/panels/view_panel.h"

namespace vantage {
namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoTitleBar |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;
constexpr double kSmallestPanel_em = 12.0, kSmallestView_em = 16.0;

/// Where the parts of the window are, its own units.
struct Layout {
  double menu = 0.0, status = 0.0;   ///< heights
  double left = 0.0, right = 0.0;    ///< widths; 0: not shown
  double timeline = 0.0;             ///< height
  double width = 0.0, height = 0.0;  ///< of the window
  double viewLeft() const { return left; }
  double viewRight() const { return width - right; }
  double viewBottom() const { return height - status - timeline; }
};

void place(double left, double top, double right, double bottom) {
  ImGui::SetNextWindowPos({static_cast<float>(left), static_cast<float>(top)});
  ImGui::SetNextWindowSize(
      {static_cast<float>(std::max(1.0, right - left)), static_cast<float>(std::max(1.0, bottom - top))});
}

}  // namespace

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
  TimelinePlace place_before;
  bool eye_wanted = false;  ///< a recipe places the eye at the next frame
  std::filesystem::path file_before;
  InspectorCommands commands;  ///< last: refers to the others

  WindowActions actions();
  PanelContext panelContext();
  Layout layout() const;
  void keys();
  void menus(PanelContext& context);
  void leftPanel(PanelContext& context, const Layout& l);
  void rightPanel(PanelContext& context, const Layout& l);
  void viewWindow(PanelContext& context, const Layout& l, double pixel_scale);
  void timelineWindow(PanelContext& context, const Layout& l);
  void statusBar(const Layout& l);
  void splitters(const Layout& l);
  void dialogs(PanelContext& context, const Layout& l);
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

Layout Inspector::State::layout() const {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const double em = ImGui::GetFontSize();
  Layout l;
  l.width = size.x;
  l.height = size.y;
  l.menu = ImGui::GetFrameHeight();
  l.status = ImGui::GetFrameHeight();
  const double room = std::max(0.0, l.width - kSmallestView_em * em);
  if (preferences.show_left) l.left = std::clamp(preferences.left_em, kSmallestPanel_em, 60.0) * em;
  if (preferences.show_right) l.right = std::clamp(preferences.right_em, kSmallestPanel_em, 60.0) * em;
  if (l.left + l.right > room && l.left + l.right > 0.0) {
    const double share = room / (l.left + l.right);
    l.left *= share;
    l.right *= share;
  }
  if (preferences.show_timeline)
    l.timeline = std::min(std::clamp(preferences.timeline_em, 7.0, 40.0) * em, l.height / 2);
  return l;
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

void Inspector::State::menus(PanelContext& context) {
  if (!ImGui::BeginMainMenuBar()) return;
  std::vector<std::string> groups;
  for (const Command& command : context.commands.all())
    if (std::ranges::find(groups, command.group) == groups.end()) groups.push_back(command.group);
  for (const std::string& group : groups) {
    const bool open = ImGui::BeginMenu(group.c_str());
    widgets.note("menu/" + group);
    if (!open) continue;
    for (const Command& command : context.commands.all()) {
      if (command.group != group) continue;
      const bool on = command.checked && command.checked();
      const bool chosen =
          ImGui::MenuItem(command.title.c_str(), textOf(command.keys).c_str(), on, command.enabled());
      widgets.note("menu/" + command.id, command.enabled());
      if (chosen) command.run();
    }
    if (group == "File" && !preferences.recent_files.empty()) {
      ImGui::Separator();
      ImGui::TextDisabled("Recent files");
      std::optional<std::filesystem::path> wanted;
      for (const RecentFile& recent : preferences.recent_files) {
        const std::string text = recent.path.string();
        if (ImGui::MenuItem((recent.missing ? text + "  (missing)" : text).c_str())) wanted = recent.path;
        widgets.note("menu/recent " + text);
      }
      if (wanted) model.open(*wanted);
    }
    ImGui::EndMenu();
  }
  const std::string title = model.file().empty() ? "no file is open" : model.file().filename().string();
  const StepData& shown = model.shown();
  const std::string text = shown.empty() ? title : title + "   ·   " + stepLine(shown.frame());
  ImGui::SameLine(std::max(ImGui::GetCursorPosX() + 20.0f,
                           ImGui::GetIO().DisplaySize.x - ImGui::CalcTextSize(text.c_str()).x - 16.0f));
  ImGui::TextDisabled("%s", text.c_str());
  ImGui::EndMainMenuBar();
}

void Inspector::State::leftPanel(PanelContext& context, const Layout& l) {
  if (l.left <= 0.0) return;
  place(0.0, l.menu, l.left, l.viewBottom());
  if (ImGui::Begin("left", nullptr, kFixed) && ImGui::BeginTabBar("left tabs")) {
    const auto tab = [&](const char* title, void (*panel)(PanelContext&)) {
      const bool open = ImGui::BeginTabItem(title);
      widgets.note("tab/" + std::string(title));
      if (!open) return;
      if (ImGui::BeginChild(title)) panel(context);
      ImGui::EndChild();
      ImGui::EndTabItem();
    };
    tab("Layers", layersPanel);
    tab("What if", whatIfPanel);
    ImGui::EndTabBar();
  }
  ImGui::End();
}

void Inspector::State::rightPanel(PanelContext& context, const Layout& l) {
  if (l.right <= 0.0) return;
  place(l.width - l.right, l.menu, l.width, l.viewBottom());
  if (ImGui::Begin("right", nullptr, kFixed) && ImGui::BeginTabBar("right tabs")) {
    const auto tab = [&](const char* title, auto panels) {
      const bool open = ImGui::BeginTabItem(title);
      widgets.note("tab/" + std::string(title));
      if (!open) return;
      panels();
      ImGui::EndTabItem();
    };
    tab("Views", [&] {
      const float half = ImGui::GetContentRegionAvail().y * 0.52f;
      if (ImGui::BeginChild("candidates", {0.0f, half})) candidatesPanel(context);
      ImGui::EndChild();
      ImGui::Separator();
      if (ImGui::BeginChild("explain")) explainPanel(context);
      ImGui::EndChild();
    });
    tab("Gains", [&] {
      if (ImGui::BeginChild("gains")) gainsPanel(context);
      ImGui::EndChild();
    });
    ImGui::EndTabBar();
  }
  ImGui::End();
}

void Inspector::State::viewWindow(PanelContext& context, const Layout& l, double pixel_scale) {
  place(l.viewLeft(), l.menu, l.viewRight(), l.viewBottom());
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
  const bool open = ImGui::Begin("3-D view", nullptr,
                                 kFixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
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

void Inspector::State::timelineWindow(PanelContext& context, const Layout& l) {
  if (l.timeline <= 0.0) return;
  place(0.0, l.viewBottom(), l.width, l.height - l.status);
  if (ImGui::Begin("timeline", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar)) timelinePanel(context);
  ImGui::End();
}

void Inspector::State::statusBar(const Layout& l) {
  place(0.0, l.height - l.status, l.width, l.height);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8.0f, 2.0f});
  const bool open = ImGui::Begin("status", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar);
  ImGui::PopStyleVar();
  if (open) {
    std::string text;
    for (const auto& work : model.work().running()) {
      text += (text.empty() ? "" : "   ·   ") + (work.phase.empty() ? work.name : work.phase);
      if (work.total > 0) text += " " + std::to_string(100 * work.done / work.total) + " %";
    }
    if (model.growing()) text += (text.empty() ? "" : "   ·   ") + std::string("the run is being written");
    if (text.empty()) text = "ready";
    ImGui::TextDisabled("%s", text.c_str());
    widgets.note("status");
  }
  ImGui::End();
}

void Inspector::State::splitters(const Layout& l) {
  const double em = ImGui::GetFontSize(), half = 3.0;
  const auto splitter = [&](const char* name, double left, double top, double right, double bottom,
                            ImGuiMouseCursor cursor) {
    place(left, top, right, bottom);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0f, 1.0f});
    ImGui::SetNextWindowBgAlpha(0.0f);
    bool active = false;
    if (ImGui::Begin(name, nullptr, kFixed & ~ImGuiWindowFlags_NoBringToFrontOnFocus)) {
      ImGui::InvisibleButton(name, {static_cast<float>(right - left), static_cast<float>(bottom - top)});
      widgets.note(name);
      active = ImGui::IsItemActive();
      if (active || ImGui::IsItemHovered()) ImGui::SetMouseCursor(cursor);
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
    return active;
  };
  const ImVec2 moved = ImGui::GetIO().MouseDelta;
  if (l.left > 0.0 && splitter("splitter/left", l.left - half, l.menu, l.left + half, l.viewBottom(),
                               ImGuiMouseCursor_ResizeEW))
    preferences.left_em = (l.left + moved.x) / em;
  if (l.right > 0.0 && splitter("splitter/right", l.width - l.right - half, l.menu, l.width - l.right + half,
                                l.viewBottom(), ImGuiMouseCursor_ResizeEW))
    preferences.right_em = (l.right - moved.x) / em;
  if (l.timeline > 0.0 && splitter("splitter/timeline", 0.0, l.viewBottom() - half, l.width,
                                   l.viewBottom() + half, ImGuiMouseCursor_ResizeNS))
    preferences.timeline_em = (l.timeline - moved.y) / em;
}

void Inspector::State::dialogs(PanelContext& context, const Layout& l) {
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
    place_before = model.place();
    preferences.addRecent(model.file());
  }
  if (preferences.view.layers == LayerSet() && !model.recorded().empty())
    preferences.view.layers = overviewLayers(model.planner());
  if (model.place().stage != place_before.stage)
    preferences.view.layers = model.stages()[model.place().stage].layers;
  place_before = model.place();
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
  const Layout layout = s.layout();
  s.menus(context);
  s.viewWindow(context, layout, pixel_scale);
  if (s.eye_wanted && !s.model.recorded().empty()) {
    s.eye_wanted = false;
    s.view.resetEye(context);
  }
  s.leftPanel(context, layout);
  s.rightPanel(context, layout);
  s.timelineWindow(context, layout);
  s.statusBar(layout);
  s.splitters(layout);
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
