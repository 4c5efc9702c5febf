#include "viewer/panels/widgets.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "viewer/text_lines.h"

namespace vantage {
namespace {

/// What Dear ImGui calls a widget: its label, made unique by its name.
std::string idOf(const std::string& name, const std::string& label) {
  return label + "##" + name;
}

/// The number on the half of the track where the handle is not.
void writeOnTrack(const WidgetBox& track, const char* format, double value, double share) {
  std::array<char, 48> text;
  std::snprintf(text.data(), text.size(), format, value);
  const float pad = ImGui::GetStyle().FramePadding.x, width = ImGui::CalcTextSize(text.data()).x;
  const auto left = static_cast<float>(track.left), right = static_cast<float>(track.right);
  ImGui::GetWindowDrawList()->AddText({share < 0.5 ? right - pad - width : left + pad,
                                       static_cast<float>(track.top) + ImGui::GetStyle().FramePadding.y},
                                      ImGui::GetColorU32(ImGuiCol_Text), text.data());
}

}  // namespace

double shareOnTrack(double value, double low, double high, bool logarithmic) {
  return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

std::string inLines(const std::string& text, double width_px) {
  const auto width_of = [](std::string_view part) {
    return static_cast<double>(ImGui::CalcTextSize(part.data(), part.data() + part.size()).x);
  };
  const double width = width_px > 0.0 ? width_px : ImGui::GetContentRegionAvail().x;
  return brokenAtSpaces(text, width, width_of);
}

void wrappedText(const std::string& text, double width_px) {
  ImGui::TextUnformatted(inLines(text, width_px).c_str());
}

void sameLineIfFits(const std::string& label, Follows what) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float text = ImGui::CalcTextSize(label.c_str()).x;
  const float width = text + (what == Follows::Button ? 2.0f * style.FramePadding.x
                                                      : ImGui::GetFrameHeight() + style.ItemInnerSpacing.x);
  const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  if (ImGui::GetItemRectMax().x + style.ItemSpacing.x + width <= end) ImGui::SameLine();
}

void tip(const std::string& text) {
  if (text.empty() || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  wrappedText(text, ImGui::GetFontSize() * 28.0f);
  ImGui::EndTooltip();
}

void Widgets::note(const std::string& name, bool enabled) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  WidgetBox box{low.x, low.y, high.x, high.y, false, enabled};
  const ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 clip_low = draw.GetClipRectMin(), clip_high = draw.GetClipRectMax();
  box.visible =
      box.x() > clip_low.x && box.x() < clip_high.x && box.y() > clip_low.y && box.y() < clip_high.y;
  boxes_[name] = box;
}

bool Widgets::button(const std::string& name, const std::string& label, bool enabled,
                     const std::string& text) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::Button(idOf(name, label).c_str());
  ImGui::EndDisabled();
  note(name, enabled);
  tip(text);
  return pressed;
}

bool Widgets::toggle(const std::string& name, const std::string& label, bool& on) {
  const bool switched = ImGui::Checkbox(idOf(name, label).c_str(), &on);
  note(name);
  return switched;
}

bool Widgets::choice(const std::string& name, const std::string& label, bool active) {
  const bool pressed = ImGui::RadioButton(idOf(name, label).c_str(), active);
  note(name);
  return pressed;
}

bool Widgets::slider(const std::string& name, const std::string& label, double& value, double low,
                     double high, const char* format, bool logarithmic, double width_px) {
  ImGui::SetNextItemWidth(width_px > 0.0 ? static_cast<float>(width_px) : -FLT_MIN);
  const float width = ImGui::CalcItemWidth();
  const ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput |
                                 (logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  const bool moved =
      ImGui::SliderScalar(idOf(name, label).c_str(), ImGuiDataType_Double, &value, &low, &high, "", flags);
  note(name);
  WidgetBox& track = boxes_[name];
  track.right = track.left + width;  // without its label
  // What is almost nothing of the track's length is nothing: -0.000.
  const bool nothing = std::abs(value) < 1e-9 * (high - low);
  if (*format)
    writeOnTrack(track, format, nothing ? 0.0 : value, shareOnTrack(value, low, high, logarithmic));
  return moved;
}

bool Widgets::field(const std::string& name, std::string& text, double width_px, const std::string& hint) {
  ImGui::SetNextItemWidth(width_px > 0.0 ? static_cast<float>(width_px) : -FLT_MIN);
  const bool entered = ImGui::InputTextWithHint(("##" + name).c_str(), hint.c_str(), &text,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  note(name);
  if (ImGui::IsItemActive()) typed_ = {name, text};
  if (entered || !ImGui::IsItemDeactivatedAfterEdit() || typed_.name != name) return entered;
  // Left by Tab or a click elsewhere: Dear ImGui has forgotten what was typed. Esc takes it back.
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) return false;
  text = std::exchange(typed_, {}).text;
  return true;
}

bool Widgets::combo(const std::string& name, const std::string& label,
                    const std::vector<std::string>& entries, int& chosen, double width_px) {
  ImGui::SetNextItemWidth(width_px > 0.0 ? static_cast<float>(width_px) : -FLT_MIN);
  const bool in_range = chosen >= 0 && chosen < static_cast<int>(entries.size());
  bool changed = false;
  const bool open = ImGui::BeginCombo(idOf(name, label).c_str(), in_range ? entries[chosen].c_str() : "");
  note(name);
  if (!open) return false;
  for (int i = 0; i < static_cast<int>(entries.size()); ++i) {
    if (ImGui::Selectable(entries[i].c_str(), i == chosen)) {
      chosen = i;
      changed = true;
    }
    note(name + "/" + entries[i]);
  }
  ImGui::EndCombo();
  return changed;
}

const WidgetBox* Widgets::find(std::string_view name) const {
  const auto found = boxes_.find(name);
  return found == boxes_.end() ? nullptr : &found->second;
}

std::vector<std::string> Widgets::names() const {
  std::vector<std::string> names;
  for (const auto& [name, box] : boxes_) names.push_back(name);
  return names;
}

}  // namespace vantage
