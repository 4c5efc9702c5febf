#include "viewer/panels/dialogs.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <span>

#include "viewer/panels/plot.h"

namespace vantage {
namespace {

constexpr ImGuiWindowFlags kDialog = ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoResize |
                                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;

bool pressed(Key key) {
  return ImGui::IsKeyPressed(static_cast<int>(key), true);
}

/// Puts the next window into the middle, `down` of the height from the top.
void center(double width_em, double down) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float width = std::min(size.x - 20.0f, static_cast<float>(width_em) * ImGui::GetFontSize());
  ImGui::SetNextWindowPos({(size.x - width) / 2, size.y * static_cast<float>(down)});
  ImGui::SetNextWindowSize({width, 0.0f});
}

void commandLine(PanelContext& context, const Command& command, bool selected) {
  const std::string keys = textOf(command.keys);
  const bool on = command.checked && command.checked();
  ImGui::BeginDisabled(!command.enabled());
  ImGui::Selectable((command.group + ":  " + command.title + (on ? "  ✓" : "") + "##" + command.id).c_str(),
                    selected);
  ImGui::EndDisabled();
  context.widgets.note("palette/" + command.id, command.enabled());
  if (keys.empty()) return;
  ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(keys.c_str()).x);
  ImGui::TextDisabled("%s", keys.c_str());
}

/// What is done, and what it does.
struct Hint {
  const char* what;
  const char* does;
};

constexpr Hint kMouse[] = {{"left drag", "turn about the scene, z stays up"},
                           {"right, middle or Shift+left drag", "move the scene"},
                           {"wheel", "nearer and farther, toward the cursor"},
                           {"hover", "voxel, segment or view under the cursor"},
                           {"double click", "look at this point"},
                           {"click on a frustum or a table row", "select the view and explain it"},
                           {"drop a file", "open it"}};

constexpr Hint kPanels[] = {{"drag a border between panels", "make one larger"},
                            {"right click on a table head", "choose columns"},
                            {"commands: arrows, Enter, Esc", "choose, run, close"},
                            {"files: arrows, Enter, Esc", "choose, open, close"},
                            {"files: Tab, Backspace", "complete a path, folder above"},
                            {"after F6: arrows, Space, Enter", "walk the panels; no commands"}};

void heading(const PanelContext& context, const char* text) {
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(packed(context.theme.accent)), "%s", text);
}

/// A column of the table that is open.
void hints(const PanelContext& context, const char* title, std::span<const Hint> all) {
  ImGui::TableNextColumn();
  heading(context, title);
  for (const Hint& hint : all) {
    ImGui::TextUnformatted(hint.what);
    ImGui::SameLine(ImGui::GetFontSize() * 15.5f);
    ImGui::TextUnformatted(hint.does);
  }
}

/// Commands that have keys, group after group, in two columns.
void commandKeys(const PanelContext& context) {
  if (!ImGui::BeginTable("sheet", 2, ImGuiTableFlags_SizingStretchSame)) return;
  ImGui::TableNextColumn();
  const auto& all = context.commands.all();
  const auto with_keys =
      std::ranges::count_if(all, [](const Command& command) { return command.keys.key != Key::None; });
  std::string group;
  int line = 0;
  for (const Command& command : all) {
    if (command.keys.key == Key::None) continue;
    if (line++ == (with_keys + 1) / 2) {
      ImGui::TableNextColumn();
      group.clear();
    }
    if (group != command.group) heading(context, command.group.c_str());
    group = command.group;
    ImGui::TextUnformatted(textOf(command.keys).c_str());
    ImGui::SameLine(ImGui::GetFontSize() * 8.0f);
    ImGui::TextUnformatted(command.title.c_str());
  }
  ImGui::EndTable();
}

}  // namespace

void CommandPalette::open() {
  open_ = focus_ = true;
  selected_ = 0;
  query_.clear();
}

void CommandPalette::draw(PanelContext& context) {
  if (!open_) return;
  center(34.0, 0.12);
  bool stays = true;
  if (ImGui::Begin("Commands", &stays, kDialog)) {
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (focus_) ImGui::SetKeyboardFocusHere();
    focus_ = false;
    if (ImGui::InputTextWithHint("##query", "type a few letters of a command", &query_)) selected_ = 0;
    context.widgets.note("palette/query");
    const std::vector<const Command*> found = context.commands.matching(query_);
    const int count = static_cast<int>(found.size());
    if (pressed(Key::Down)) ++selected_;
    if (pressed(Key::Up)) --selected_;
    selected_ = std::clamp(selected_, 0, std::max(0, count - 1));
    const Command* wanted = nullptr;
    if (count > 0 && (pressed(Key::Enter) || pressed(Key::KeypadEnter))) wanted = found[selected_];
    if (ImGui::BeginChild("list", {0.0f, ImGui::GetFontSize() * 20.0f})) {
      for (int i = 0; i < count; ++i) {
        commandLine(context, *found[i], i == selected_);
        if (ImGui::IsItemClicked()) wanted = found[i];
        if (i == selected_) ImGui::SetScrollHereY(0.5f);
      }
      if (count == 0) ImGui::TextDisabled("no command has these letters");
    }
    ImGui::EndChild();
    if (pressed(Key::Escape)) stays = false;
    if (wanted && wanted->enabled()) {
      stays = false;
      wanted->run();
    }
  }
  ImGui::End();
  open_ = stays;
}

void CheatSheet::draw(PanelContext& context) {
  if (!open_) return;
  center(60.0, 0.05);
  bool stays = true;
  if (ImGui::Begin("Keys and mouse", &stays, kDialog)) {
    const ImVec2 at = ImGui::GetWindowPos(), extent = ImGui::GetWindowSize();
    context.widgets.note("cheat sheet", {at.x, at.y, at.x + extent.x, at.y + extent.y, true});
    commandKeys(context);
    ImGui::Separator();
    if (ImGui::BeginTable("hints", 2, ImGuiTableFlags_SizingStretchSame)) {
      hints(context, "Mouse", kMouse);
      hints(context, "Panels and dialogs", kPanels);
      ImGui::EndTable();
    }
    if (pressed(Key::Escape)) stays = false;
  }
  ImGui::End();
  open_ = stays;
}

void drawNotices(PanelContext& context, double left, double right, double bottom) {
  const auto& notices = context.model.notices();
  if (notices.empty()) return;
  const float width = static_cast<float>(right - left) - 24.0f;
  ImGui::SetNextWindowPos({static_cast<float>(left) + 12.0f, static_cast<float>(bottom) - 12.0f},
                          ImGuiCond_Always, {0.0f, 1.0f});
  ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, {width, 400.0f});
  ImGui::SetNextWindowBgAlpha(0.94f);
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                      ImGuiWindowFlags_NoFocusOnAppearing;
  bool dismiss = false;
  if (ImGui::Begin("notices", nullptr, kFlags)) {
    for (const Notice& notice : notices) {
      const Rgb color = notice.level == Notice::Level::Info ? context.theme.ink : context.theme.warning;
      ImGui::PushStyleColor(ImGuiCol_Text, packed(color));
      wrappedText((notice.level == Notice::Level::Error ? "Error: " : "") + notice.text, width - 60.0f);
      ImGui::PopStyleColor();
    }
    dismiss = context.widgets.button("notices/dismiss", "dismiss");
    const ImVec2 at = ImGui::GetWindowPos(), extent = ImGui::GetWindowSize();
    context.widgets.note("notices", {at.x, at.y, at.x + extent.x, at.y + extent.y, true});
  }
  ImGui::End();
  if (dismiss) context.model.dismissNotices();
}

}  // namespace vantage
