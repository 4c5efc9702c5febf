// The parts of the window around the 3-D view: where they are, what they hold, how their borders are moved.
#include "viewer/panels/window_frame.h"

#include <imgui.h>

#include <algorithm>

#include "viewer/panels/plot.h"

namespace vantage {
namespace {

constexpr double kSmallestPanel_em = 12.0, kLargestPanel_em = 60.0, kSmallestView_em = 16.0;
constexpr double kSmallestTimeline_em = 7.0, kLargestTimeline_em = 40.0;

/// A tab whose content scrolls by itself. \param takes_keys they move inside it from now on
template <class Content>
void tab(PanelContext& context, const char* title, bool takes_keys, const Content& content) {
  const bool open = ImGui::BeginTabItem(title);
  context.widgets.note("tab/" + std::string(title));
  if (!open) return;
  if (takes_keys) ImGui::SetNextWindowFocus();
  if (ImGui::BeginChild(title)) content();
  ImGui::EndChild();
  ImGui::EndTabItem();
}

/// A handle on a border; true while it is dragged.
bool splitter(PanelContext& context, const char* name, double left, double top, double right, double bottom,
              ImGuiMouseCursor cursor) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0f, 1.0f});
  ImGui::SetNextWindowBgAlpha(0.0f);
  bool active = false;
  if (beginPart(name, left, top, right, bottom)) {
    ImGui::InvisibleButton(name, {static_cast<float>(right - left), static_cast<float>(bottom - top)});
    context.widgets.note(name);
    active = ImGui::IsItemActive();
    if (active || ImGui::IsItemHovered()) ImGui::SetMouseCursor(cursor);
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
  return active;
}

/// What is being done, and how far; a look at the file is not worth a word.
std::string workText(const InspectorModel& model) {
  std::string text;
  for (const auto& work : model.work().running()) {
    if (work.phase.empty()) continue;
    text += (text.empty() ? "" : "   ·   ") + work.phase;
    if (work.total > 0) text += " " + std::to_string(100 * work.done / work.total) + " %";
  }
  if (text.empty() && model.whatIf().busy()) text = stateText(model.whatIf());
  if (model.growing()) text += (text.empty() ? "" : "   ·   ") + std::string("the run is being written");
  return text.empty() ? "ready" : text;
}

/// At the right end of the line.
void pictureButton(PanelContext& context, double right) {
  const Command* save = context.commands.find("file.screenshot");
  if (!save) return;
  const char* label = "save picture";
  const ImGuiStyle& style = ImGui::GetStyle();
  const float width = ImGui::CalcTextSize(label).x + 2 * style.FramePadding.x + 8.0f;
  ImGui::SameLine(static_cast<float>(right) - width);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {style.FramePadding.x, 0.0f});
  if (context.widgets.button("status/save picture", label, save->enabled(),
                             save->title + "  (" + textOf(save->keys) + ")"))
    save->run();
  ImGui::PopStyleVar();
}

}  // namespace

WindowLayout windowLayout(const Preferences& preferences) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const double em = ImGui::GetFontSize();
  WindowLayout l;
  l.width = size.x;
  l.height = size.y;
  l.menu = ImGui::GetFrameHeight();
  l.status = ImGui::GetFrameHeight();
  const double room = std::max(0.0, l.width - kSmallestView_em * em);
  if (preferences.show_left)
    l.left = std::clamp(preferences.left_em, kSmallestPanel_em, kLargestPanel_em) * em;
  if (preferences.show_right)
    l.right = std::clamp(preferences.right_em, kSmallestPanel_em, kLargestPanel_em) * em;
  if (l.left + l.right > room && l.left + l.right > 0.0) {
    const double share = room / (l.left + l.right);
    l.left *= share;
    l.right *= share;
  }
  if (preferences.show_timeline)
    l.timeline = std::min(std::clamp(preferences.timeline_em, kSmallestTimeline_em, kLargestTimeline_em) * em,
                          l.height / 2);
  return l;
}

bool beginPart(const char* name, double left, double top, double right, double bottom, int flags) {
  constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoTitleBar |
                                      ImGuiWindowFlags_NoSavedSettings;
  ImGui::SetNextWindowPos({static_cast<float>(left), static_cast<float>(top)});
  ImGui::SetNextWindowSize(
      {static_cast<float>(std::max(1.0, right - left)), static_cast<float>(std::max(1.0, bottom - top))});
  return ImGui::Begin(name, nullptr, kFixed | flags);
}

void leftPart(PanelContext& context, const WindowLayout& l, bool takes_keys) {
  if (l.left <= 0.0) return;
  if (beginPart("left", 0.0, l.menu, l.left, l.viewBottom(), ImGuiWindowFlags_NoBringToFrontOnFocus) &&
      ImGui::BeginTabBar("left tabs")) {
    tab(context, "Layers", takes_keys, [&] { layersPanel(context); });
    tab(context, "What if", takes_keys, [&] { whatIfPanel(context); });
    ImGui::EndTabBar();
  }
  ImGui::End();
}

void rightPart(PanelContext& context, const WindowLayout& l) {
  if (l.right <= 0.0) return;
  if (beginPart("right", l.width - l.right, l.menu, l.width, l.viewBottom(),
                ImGuiWindowFlags_NoBringToFrontOnFocus) &&
      ImGui::BeginTabBar("right tabs")) {
    tab(context, "Views", false, [&] {
      const float half = ImGui::GetContentRegionAvail().y * 0.52f;
      if (ImGui::BeginChild("candidates", {0.0f, half})) candidatesPanel(context);
      ImGui::EndChild();
      ImGui::Separator();
      if (ImGui::BeginChild("explain")) explainPanel(context);
      ImGui::EndChild();
    });
    tab(context, "Gains", false, [&] { gainsPanel(context); });
    ImGui::EndTabBar();
  }
  ImGui::End();
}

void timelinePart(PanelContext& context, const WindowLayout& l) {
  if (l.timeline <= 0.0) return;
  if (beginPart("timeline", 0.0, l.viewBottom(), l.width, l.height - l.status,
                ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoBringToFrontOnFocus))
    timelinePanel(context);
  ImGui::End();
}

void statusBar(PanelContext& context, const WindowLayout& l) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8.0f, 2.0f});
  const bool open = beginPart("status", 0.0, l.height - l.status, l.width, l.height,
                              ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::PopStyleVar();
  if (open) {
    ImGui::TextDisabled("%s", workText(context.model).c_str());
    context.widgets.note("status");
    pictureButton(context, l.width);
  }
  ImGui::End();
}

void splitters(PanelContext& context, const WindowLayout& l) {
  const double em = ImGui::GetFontSize(), half = 3.0;
  Preferences& preferences = context.preferences;
  const ImVec2 moved = ImGui::GetIO().MouseDelta;
  if (l.left > 0.0 && splitter(context, "splitter/left", l.left - half, l.menu, l.left + half, l.viewBottom(),
                               ImGuiMouseCursor_ResizeEW))
    preferences.left_em = (l.left + moved.x) / em;
  if (l.right > 0.0 && splitter(context, "splitter/right", l.viewRight() - half, l.menu, l.viewRight() + half,
                                l.viewBottom(), ImGuiMouseCursor_ResizeEW))
    preferences.right_em = (l.right - moved.x) / em;
  if (l.timeline > 0.0 && splitter(context, "splitter/timeline", 0.0, l.viewBottom() - half, l.width,
                                   l.viewBottom() + half, ImGuiMouseCursor_ResizeNS))
    preferences.timeline_em = (l.timeline - moved.y) / em;
}

}  // namespace vantage
