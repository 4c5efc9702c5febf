// The menu bar: all commands by group, recent files, and what is open.
#include <imgui.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "viewer/captions.h"
#include "viewer/panels/window_frame.h"

namespace vantage {
namespace {

/// Groups of commands in the order in which they appear.
std::vector<std::string> groupsOf(const Commands& commands) {
  std::vector<std::string> groups;
  for (const Command& command : commands.all())
    if (std::ranges::find(groups, command.group) == groups.end()) groups.push_back(command.group);
  return groups;
}

void commandItem(PanelContext& context, const Command& command) {
  const bool on = command.checked && command.checked();
  const bool chosen =
      ImGui::MenuItem(command.title.c_str(), textOf(command.keys).c_str(), on, command.enabled());
  context.widgets.note("menu/" + command.id, command.enabled());
  if (chosen) command.run();
}

void recentItems(PanelContext& context) {
  if (context.preferences.recent_files.empty()) return;
  ImGui::Separator();
  ImGui::TextDisabled("Recent files");
  std::optional<std::filesystem::path> wanted;
  for (const RecentFile& recent : context.preferences.recent_files) {
    const std::string text = recent.path.string();
    if (ImGui::MenuItem((recent.missing ? text + "  (missing)" : text).c_str())) wanted = recent.path;
    context.widgets.note("menu/recent " + text);
  }
  if (wanted) context.model.open(*wanted);
}

/// File and step; less of it where there is less room.
std::string titleFor(const InspectorModel& model, float room) {
  if (model.file().empty()) return "no file is open";
  const std::string name = model.file().filename().string();
  if (model.shown().empty() || !model.isRun()) return name;
  const StepData& shown = model.shown();
  const std::string step = shown.record->closing ? "the end" : "step " + std::to_string(shown.record->step);
  for (const std::string& text : {name + "   ·   " + stepLine(shown.frame()), name + "   ·   " + step})
    if (ImGui::CalcTextSize(text.c_str()).x <= room) return text;
  return step;
}

void title(PanelContext& context) {
  constexpr float kBefore = 20.0f, kAfter = 16.0f;
  const float start = ImGui::GetCursorPosX() + kBefore, end = ImGui::GetIO().DisplaySize.x - kAfter;
  const std::string text = titleFor(context.model, end - start);
  ImGui::SameLine(std::max(start, end - ImGui::CalcTextSize(text.c_str()).x));
  ImGui::TextDisabled("%s", text.c_str());
  context.widgets.note("menu/title");
}

}  // namespace

void menuBar(PanelContext& context) {
  if (!ImGui::BeginMainMenuBar()) return;
  for (const std::string& group : groupsOf(context.commands)) {
    const bool open = ImGui::BeginMenu(group.c_str());
    context.widgets.note("menu/" + group);
    if (!open) continue;
    for (const Command& command : context.commands.all())
      if (command.group == group) commandItem(context, command);
    if (group == "File") recentItems(context);
    ImGui::EndMenu();
  }
  title(context);
  ImGui::EndMainMenuBar();
}

}  // namespace vantage
