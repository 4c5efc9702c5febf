// Legends, colour scales and insets of the layers that are shown, over the 3-D view.
#include <imgui.h>

#include <algorithm>

#include "viewer/panels/panel.h"
#include "viewer/panels/plot.h"

namespace vantage {
namespace {

constexpr float kTextScale = 0.87f;  ///< of the legend, which stands in the way of the scene

/// The sign of a legend entry in a square of the given size.
void drawMark(ImDrawList& draw, ImVec2 at, float size, const LegendEntry& entry, ImU32 ink) {
  const ImVec2 end{at.x + size, at.y + size}, middle{at.x + size / 2, at.y + size / 2};
  const ImU32 color = packed(entry.color, std::max(0.35, entry.opacity));
  using Mark = LegendEntry::Mark;
  switch (entry.mark) {
    case Mark::Line:
      draw.AddLine({at.x, middle.y}, {end.x, middle.y}, color, 2.5f);
      return;
    case Mark::Dashed:
      for (int i = 0; i < 3; ++i)
        draw.AddLine({at.x + size * (0.4f * i), middle.y}, {at.x + size * (0.4f * i + 0.22f), middle.y},
                     color, 2.0f);
      return;
    case Mark::Dot:
      draw.AddCircleFilled(middle, size * 0.28f, color);
      return;
    case Mark::Cross:
      draw.AddLine({at.x + 2, at.y + 2}, {end.x - 2, end.y - 2}, color, 1.5f);
      draw.AddLine({at.x + 2, end.y - 2}, {end.x - 2, at.y + 2}, color, 1.5f);
      return;
    default:
      break;
  }
  draw.AddRectFilled(at, end, color);
  if (entry.mark == Mark::Crossed) {
    draw.AddLine(at, end, ink);
    draw.AddLine({at.x, end.y}, {end.x, at.y}, ink);
  } else if (entry.mark == Mark::Striped) {
    for (int i = 0; i < 3; ++i)
      draw.AddLine({at.x + size * (0.33f * i), end.y}, {at.x + size * (0.33f * i + 0.33f), at.y}, ink);
  } else if (entry.mark == Mark::Diamond) {
    draw.AddQuadFilled({middle.x, at.y + 2}, {end.x - 2, middle.y}, {middle.x, end.y - 2},
                       {at.x + 2, middle.y}, ink);
  } else if (entry.mark == Mark::Ringed) {
    draw.AddCircle(middle, size * 0.3f, ink, 0, 1.5f);
  }
  draw.AddRect(at, end, ink & IM_COL32(255, 255, 255, 90));
}

void drawScale(ImDrawList& draw, const ColorScale& scale, const Theme& theme) {
  ImGui::TextUnformatted(scale.title.c_str());
  const float width = ImGui::GetFontSize() * 13.0f, height = ImGui::GetFontSize() * 0.7f;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  constexpr int kPieces = 32;
  for (int i = 0; i < kPieces; ++i) {
    const float x0 = at.x + width * i / kPieces, x1 = at.x + width * (i + 1) / kPieces;
    draw.AddRectFilled({x0, at.y}, {x1, at.y + height}, packed(colorAt(scale.map, (i + 0.5) / kPieces)));
  }
  ImGui::Dummy({width, height});
  const double step = (scale.high - scale.low) / 2.0;
  for (int i = 0; i <= 2; ++i) {
    const std::string text = (i == 2 && scale.open_top ? "≥ " : "") + shortNumber(scale.low + i * step);
    const float size = ImGui::CalcTextSize(text.c_str()).x;
    draw.AddText({at.x + (width - size) * i / 2.0f, at.y + height + 1.0f}, packed(theme.ink), text.c_str());
  }
  ImGui::Dummy({width, ImGui::GetFontSize()});
}

}  // namespace

void legendOverlay(PanelContext& context, double left, double top, double right, double bottom) {
  const std::vector<const LayerNotes*> notes = context.scene.shownNotes();
  const bool any = std::ranges::any_of(notes, [](const LayerNotes* n) { return !n->legend.empty(); });
  if (!any || !context.preferences.show_legend) return;
  ImGui::SetNextWindowPos({static_cast<float>(left) + 8.0f, static_cast<float>(top) + 8.0f});
  ImGui::SetNextWindowSizeConstraints(
      {0.0f, 0.0f}, {static_cast<float>(right - left) * 0.45f, static_cast<float>(bottom - top) - 16.0f});
  ImGui::SetNextWindowBgAlpha(0.78f);
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoInputs |
                                      ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing;
  if (ImGui::Begin("legend", nullptr, kFlags)) {
    ImGui::SetWindowFontScale(kTextScale);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float size = ImGui::GetFontSize() * 0.8f;
    for (const LayerNotes* layer : notes) {
      for (const LegendEntry& entry : layer->legend) {
        drawMark(draw, ImGui::GetCursorScreenPos(), size, entry, packed(context.theme.ink));
        ImGui::Dummy({size, size});
        ImGui::SameLine();
        ImGui::TextUnformatted(entry.text.c_str());
      }
      if (layer->scale) drawScale(draw, *layer->scale, context.theme);
    }
    const ImVec2 at = ImGui::GetWindowPos(), extent = ImGui::GetWindowSize();
    context.widgets.note("view/legend", {at.x, at.y, at.x + extent.x, at.y + extent.y, true});
  }
  ImGui::End();
}

}  // namespace vantage
