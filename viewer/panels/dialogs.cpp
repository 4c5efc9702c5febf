#include "viewer/panels/dialogs.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <string>
#include <vector>

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

/// A line of the cheat sheet: keys, or what the mouse does, and what that is good for.
struct Hint {
  std::string group, what, does;
  bool wide = true;  ///< room for a phrase; keys need less
};

std::vector<Hint> hintsOf(const Commands& commands) {
  std::vector<Hint> all;
  for (const Command& command : commands.all())
    if (command.keys.key != Key::None)
      all.push_back({command.group, textOf(command.keys), command.title, false});
  const std::string mouse = "Mouse", panels = "Panels and dialogs";
  for (const Hint& hint :
       {Hint{mouse, "left drag", "turn about the scene"},
        Hint{mouse, "right, middle or Shift+left drag", "move the scene"},
        Hint{mouse, "wheel", "nearer and farther"}, Hint{mouse, "hover", "what is under the cursor"},
        Hint{mouse, "double click", "look at this point"},
        Hint{mouse, "click on a frustum or a table row", "select and explain it"},
        Hint{mouse, "drop a file", "open it"},
        Hint{panels, "drag a border between panels", "make one larger"},
        Hint{panels, "right click on a table head", "choose columns"},
        Hint{panels, "commands: arrows, Enter, Esc", "choose, run, close"},
        Hint{panels, "files: arrows, Enter, Esc", "choose, open, close"},
        Hint{panels, "files: Tab, Backspace", "complete, folder above"},
        Hint{panels, "after F6: arrows, Space, Enter", "for the panels alone"}})
    all.push_back(hint);
  return all;
}

/// All hints under the headings of their groups, in columns of equal length.
void hintTable(const PanelContext& context, int columns) {
  const std::vector<Hint> all = hintsOf(context.commands);
  if (!ImGui::BeginTable("sheet", columns, ImGuiTableFlags_SizingStretchSame)) return;
  std::size_t lines = all.size();
  for (std::size_t i = 0; i < all.size(); ++i) lines += i == 0 || all[i].group != all[i - 1].group;
  lines += 2 * (columns - 1);  // rounded up, and a group that goes on in the next column is named again
  const std::size_t most = lines / columns;
  std::size_t line = most;
  std::string group;
  for (const Hint& hint : all) {
    if (line >= most) {
      ImGui::TableNextColumn();
      group.clear();
      line = 0;
    }
    if (group != hint.group) {
      ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(packed(context.theme.accent)), "%s",
                         hint.group.c_str());
      ++line;
    }
    group = hint.group;
    ImGui::TextUnformatted(hint.what.c_str());
    const float em = ImGui::GetFontSize();
    ImGui::SameLine((hint.wide ? 15.5f : 8.0f) * em);
    ImGui::TextUnformatted(hint.does.c_str());
    ++line;
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
  constexpr double kColumn_em = 27.0, kTop = 0.05;
  const ImVec2 room = ImGui::GetIO().DisplaySize;
  const int columns = std::clamp(static_cast<int>(room.x / (kColumn_em * ImGui::GetFontSize())), 1, 3);
  center(kColumn_em * columns + 2.0, kTop);
  ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, {room.x, room.y * static_cast<float>(1.0 - 2.0 * kTop)});
  bool stays = true;
  if (ImGui::Begin("Keys and mouse", &stays, kDialog)) {
    const ImVec2 at = ImGui::GetWindowPos(), extent = ImGui::GetWindowSize();
    context.widgets.note("cheat sheet", {at.x, at.y, at.x + extent.x, at.y + extent.y, true});
    hintTable(context, columns);
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
