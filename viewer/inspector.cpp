#include "viewer/inspector.h"

#include <imgui.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "viewer/inspector_commands.h"
#include "viewer/inspector_documents.h"
#include "viewer/inspector_output.h"
#include "viewer/panels/dialogs.h"
#include "viewer/panels/file_dialog.h"
#include "viewer/panels/panel.h"
#include "viewer/panels/plot.h"
#include "viewer/panels/window_frame.h"

namespace vantage {

struct Inspector::State {
  State(GlContext& gl_, InspectorPorts ports_, Preferences preferences_)
      : gl(gl_),
        ports(std::move(ports_)),
        preferences(std::move(preferences_)),
        documents([this](std::string name) {
          auto made = std::make_unique<Document>(gl, std::move(name), ports.wake);
          made->model.read_recipe = ports.recipe;
          return made;
        }) {
    commands.emplace(document().model, preferences, actions());
  }

  GlContext& gl;
  InspectorPorts ports;
  Preferences preferences;
  Widgets widgets;
  CommandPalette palette;
  CheatSheet cheat_sheet;
  FileDialog dialog;
  std::function<void(const std::filesystem::path&)> after_dialog;  ///< what the chosen file is for
  bool close = false;
  bool walks_panels = false;
  Documents documents;
  /// Changes the documents at the next frame: a command must not take the ground from under itself.
  std::function<void()> at_next_frame;
  std::optional<InspectorCommands> commands;  ///< of the active document; last: refers to the others

  Document& document() { return documents.active(); }
  WindowActions actions();
  void addFileActions(WindowActions& a);
  void applyWish();
  void swapDocuments();
  PanelContext panelContext(Document& d);
  PanelContext panelContext() { return panelContext(document()); }
  void keys();
  bool beginsToWalkPanels();
  void viewWindows(const WindowLayout& l, double pixel_scale);
  void viewWindow(Document& d, double left, double right, const WindowLayout& l, double pixel_scale);
  void viewTitle(Document& d, double left, double top);
  void dialogs(PanelContext& context, const WindowLayout& l);
  void screenshot();
};

void Inspector::State::applyWish() {
  if (!at_next_frame) return;
  commands.reset();
  std::exchange(at_next_frame, nullptr)();
  commands.emplace(document().model, preferences, actions());
}

/// The same stage stays, with the layers that the other planner has for it.
void Inspector::State::swapDocuments() {
  if (!documents.other()) return;
  preferences.view = documents.viewOf(*documents.other(), preferences.view);
  documents.swap();
}

void Inspector::State::screenshot() {
  if (!ports.picture) return;
  ViewSettings settings = preferences.view;
  settings.camera.eye = document().scene.eye();
  savePicture(document().model, [&](const SceneFrame& frame, const std::string& what_if) {
    return ports.picture(frame, settings, what_if, gl, 1280, 800);
  });
}

void Inspector::State::addFileActions(WindowActions& a) {
  const auto choose = [this](FileDialog::Mode mode, const char* name, auto then) {
    after_dialog = std::move(then);
    dialog.open(mode, preferences.folder(), name);
  };
  a.open_dialog = [this, choose] {
    choose(FileDialog::Mode::Open, "", [this](const auto& file) { document().model.open(file); });
  };
  a.open_beside = [this, choose] {
    choose(FileDialog::Mode::Open, "", [this](const auto& file) { documents.openBeside(file); });
  };
  a.write_config = [this, choose] {
    choose(FileDialog::Mode::Save, "config.toml",
           [this](const auto& file) { saveConfig(document().model, file); });
  };
  a.close_beside = [this] { at_next_frame = [this] { documents.closeOther(); }; };
  a.has_beside = [this] { return documents.other() != nullptr; };
  a.switch_run = [this] { at_next_frame = [this] { swapDocuments(); }; };
}

WindowActions Inspector::State::actions() {
  WindowActions a;
  addFileActions(a);
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
  a.reset_eye = with_context([this](PanelContext& c) { document().view.resetEye(c); });
  a.look_through_view = with_context([this](PanelContext& c) { document().view.lookThroughView(c); });
  a.look_along = [this](int side) {
    PanelContext context = panelContext();
    document().view.lookAlong(context, side);
  };
  a.add_bookmark = [this] {
    auto& bookmarks = preferences.bookmarks;
    bookmarks.push_back({"camera " + std::to_string(bookmarks.size() + 1), document().scene.eye()});
  };
  a.bookmark = [this](int n) {
    if (n < static_cast<int>(preferences.bookmarks.size()))
      document().view.setEye(preferences.bookmarks[n].eye);
  };
  a.measure = [this] { document().view.toggleMeasuring(); };
  a.measuring = [this] { return document().view.measuring(); };
  a.select_view = [this](int by) {
    Document& d = document();
    d.candidates.table.show(d.model.recorded(), d.model.shown());
    const auto next = d.candidates.table.neighbour(d.model.explainedView(), by);
    if (next) d.model.selected_view = next;
  };
  a.orbit = [this](double left_rad, double up_rad) { document().view.orbitBy(left_rad, up_rad); };
  a.zoom = [this](double factor) { document().view.zoomBy(factor); };
  return a;
}

PanelContext Inspector::State::panelContext(Document& d) {
  return {d.model,
          preferences,
          d.scene,
          widgets,
          d.candidates,
          commands->list(),
          themeOf(preferences.theme),
          ports.copy,
          [&d](const Eye& eye) { d.view.setEye(eye); }};
}

/// Commands by their keys, but for those that a field or the panels take.
void Inspector::State::keys() {
  const ImGuiIO& io = ImGui::GetIO();
  if (dialog.isOpen() || io.KeyAlt || io.KeySuper) return;
  for (const Command& command : commands->list().all()) {
    const Shortcut& keys = command.keys;
    if (keys.key == Key::None || keys.ctrl != io.KeyCtrl) continue;
    if (io.WantTextInput && belongsToField(keys)) continue;
    // A plus needs Shift on some keyboards.
    if (keys.shift != io.KeyShift && keys.key != Key::Equal) continue;
    if (preferences.keyboard_navigation && !keys.ctrl && walksPanels(keys.key)) continue;
    if (ImGui::IsKeyPressed(static_cast<int>(keys.key), command.repeats) && command.enabled()) {
      command.run();
      return;
    }
  }
}

/// Keys that move inside the panels begin in the left one. \return whether they do in this frame
bool Inspector::State::beginsToWalkPanels() {
  const bool begins = preferences.keyboard_navigation && !walks_panels;
  walks_panels = preferences.keyboard_navigation;
  if (begins)
    document().model.say(
        Notice::Level::Info,
        "keys move inside the panels: arrows, Space and Enter, Esc to leave one; F6 ends it");
  return begins;
}

/// File, step and, in the active one, a line in the accent's colour.
void Inspector::State::viewTitle(Document& d, double left, double top) {
  const Theme& theme = themeOf(preferences.theme);
  const bool is_active = &d == &document();
  const std::string file = d.model.file().empty() ? "no file" : d.model.file().filename().string();
  const ImVec2 low{static_cast<float>(left) + 8.0f, static_cast<float>(top) + 8.0f};
  const ImVec2 size = ImGui::CalcTextSize(file.c_str());
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 end{low.x + size.x + 12.0f, low.y + size.y + 6.0f};
  draw.AddRectFilled(low, end, packed(theme.panel, 0.9));
  draw.AddRect(low, end, packed(is_active ? theme.accent : theme.faint), 0.0f, 0, is_active ? 2.0f : 1.0f);
  draw.AddText({low.x + 6.0f, low.y + 3.0f}, packed(is_active ? theme.ink : theme.faint), file.c_str());
  widgets.note(d.view_name + "/title", {low.x, low.y, end.x, end.y, true});
}

void Inspector::State::viewWindow(Document& d, double left, double right, const WindowLayout& l,
                                  double pixel_scale) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
  const bool open = beginPart(d.view_name.c_str(), left, l.menu, right, l.viewBottom(),
                              ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse |
                                  ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::PopStyleVar();
  if (open) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    PanelContext context = panelContext(d);
    const bool used = d.view.draw(context, documents.viewOf(d, preferences.view), pixel_scale);
    if (used && &d != &document()) at_next_frame = [this] { swapDocuments(); };
    if (d.model.shown().empty()) {
      const char* hint =
          d.model.loading() ? "loading…" : "Open a run with Ctrl+O, or drop a file here. F1 lists all keys.";
      ImGui::GetWindowDrawList()->AddText({at.x + 24.0f, at.y + 36.0f},
                                          packed(themeOf(preferences.theme).faint), hint);
    }
    if (documents.other()) viewTitle(d, at.x, at.y);
    if (d.eye_wanted && !d.model.recorded().empty()) {
      d.eye_wanted = false;
      d.view.resetEye(context);
    }
  }
  ImGui::End();
}

void Inspector::State::viewWindows(const WindowLayout& l, double pixel_scale) {
  const double width = (l.viewRight() - l.viewLeft()) / static_cast<double>(documents.all().size());
  double left = l.viewLeft();
  for (const auto& d : documents.all()) {
    viewWindow(*d, left, std::min(left + width, l.viewRight()), l, pixel_scale);
    left += width;
  }
  documents.linkEyes(at_next_frame != nullptr);
}

void Inspector::State::dialogs(PanelContext& context, const WindowLayout& l) {
  palette.draw(context);
  cheat_sheet.draw(context);
  drawNotices(context, l.viewLeft(), l.viewRight(), l.viewBottom());
  if (const auto file = dialog.draw(widgets)) after_dialog(*file);
}

Inspector::Inspector(GlContext& context, InspectorPorts ports, Preferences preferences)
    : state_(std::make_unique<State>(context, std::move(ports), std::move(preferences))) {}

Inspector::~Inspector() = default;

void Inspector::open(const std::vector<std::filesystem::path>& files) {
  state_->documents.open(files);
}

bool Inspector::update(double elapsed_s) {
  State& s = *state_;
  bool changed = false;
  for (const auto& d : s.documents.all()) {
    changed |= d->model.update(elapsed_s);
    s.documents.take(*d, s.preferences);
    const auto due_s = d->view.nextRender_s();
    changed |= due_s && *due_s <= 0.0;
  }
  s.documents.linkSteps();
  return changed;
}

void Inspector::draw(double pixel_scale) {
  State& s = *state_;
  s.applyWish();
  s.widgets.beginFrame();
  ImGuiIO& io = ImGui::GetIO();
  io.ConfigFlags = s.preferences.keyboard_navigation ? ImGuiConfigFlags_NavEnableKeyboard : 0;
  s.keys();
  PanelContext context = s.panelContext();
  const WindowLayout layout = windowLayout(s.preferences);
  menuBar(context);
  leftPart(context, layout, s.beginsToWalkPanels());
  rightPart(context, layout);
  s.viewWindows(layout, pixel_scale);  // after the panels: what they change is seen in this frame
  timelinePart(context, layout);
  statusBar(context, layout);
  splitters(context, layout);
  s.dialogs(context, layout);
}

bool Inspector::idle() const {
  return std::ranges::all_of(state_->documents.all(),
                             [](const auto& d) { return d->model.idle() && !d->view.nextRender_s(); });
}

bool Inspector::wantsToClose() const {
  return state_->close;
}

const Preferences& Inspector::preferences() const {
  return state_->preferences;
}

Preferences Inspector::toKeep() const {
  Preferences kept = state_->preferences;
  // What a stage shows comes with the stage: the next start begins with the overview.
  const Document& d = state_->document();
  if (!d.model.recorded().empty() && kept.view.layers == d.stageLayers()) kept.view.layers = {};
  return kept;
}

const Widgets& Inspector::widgets() const {
  return state_->widgets;
}

const Commands& Inspector::commands() const {
  return state_->commands->list();
}

InspectorModel& Inspector::model() {
  return state_->document().model;
}

std::optional<std::string> Inspector::error() const {
  for (const Notice& notice : state_->document().model.notices())
    if (notice.level == Notice::Level::Error) return notice.text;
  return std::nullopt;
}

std::uint64_t Inspector::picturesRendered() const {
  std::uint64_t count = 0;
  for (const auto& d : state_->documents.all()) count += d->view.viewport().framesRendered();
  return count;
}

bool Inspector::pictureIsFull() const {
  return std::ranges::all_of(state_->documents.all(),
                             [](const auto& d) { return d->view.viewport().settled(); });
}

}  // namespace vantage
