// Legends and colour scales of the layers that are shown, over the 3-D view.
#include <imgui.h>

#include <algorithm>

#include "viewer/panels/overlays.h"
#include "viewer/panels/plot.h"

namespace vantage {
namespace {

constexpr float kTextScale = 0.87f;  ///< of the legend, which stands in the way of the scene
constexpr float kMark_em = 0.8f, kScale_em = 13.0f, kNarrowScale_em = 8.0f, kTooltip_em = 26.0f;
constexpr float kGap_px = 8.0f;

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

/// Width of the widest line, if there is room for it.
float widthOf(const std::vector<LayerNotes>& notes) {
  const float em = ImGui::GetFontSize() * kTextScale;
  float widest = 0.0f;
  for (const LayerNotes& layer : notes) {
    for (const LegendEntry& entry : layer.legend)
      widest = std::max(widest, kTextScale * ImGui::CalcTextSize(entry.text.c_str()).x + kMark_em * em +
                                    ImGui::GetStyle().ItemSpacing.x);
    if (layer.scale)
      widest =
          std::max({widest, kTextScale * ImGui::CalcTextSize(layer.scale->title.c_str()).x, kScale_em * em});
  }
  return widest + 2.0f * ImGui::GetStyle().WindowPadding.x +
         0.5f * em;  // else rounding breaks the widest line
}

/// \param width_px of a line; 0: what is left
void drawNotes(const LayerNotes& notes, const Theme& theme, float width_px = 0.0f) {
  for (const LegendEntry& entry : notes.legend) drawLegendEntry(entry, theme, width_px);
  if (!notes.scale) return;
  wrappedText(notes.scale->title, width_px);
  drawColorScale(*notes.scale,
                 std::min(ImGui::GetFontSize() * kScale_em,
                          width_px > 0.0f ? width_px : ImGui::GetContentRegionAvail().x),
                 theme);
}

/// What several layers explain is explained once.
std::vector<LayerNotes> withoutRepeats(const std::vector<const LayerNotes*>& notes) {
  std::vector<LayerNotes> once;
  std::vector<LegendEntry> known;
  for (const LayerNotes* layer : notes) {
    LayerNotes& kept = once.emplace_back(LayerNotes{{}, layer->scale, {}});
    for (const LegendEntry& entry : layer->legend) {
      if (std::ranges::find(known, entry) != known.end()) continue;
      known.push_back(entry);
      kept.legend.push_back(entry);
    }
  }
  return once;
}

/// In less it would cover the scene.
bool hasRoomForLegend(const ViewArea& area) {
  constexpr float kLeastWidth_em = 26.0f, kLeastHeight_em = 20.0f;
  const float em = ImGui::GetFontSize();
  return area.width() >= kLeastWidth_em * em && area.height() >= kLeastHeight_em * em;
}

/// Opens and closes the legend.
void foldButton(PanelContext& context, const std::string& view, bool shown) {
  if (context.widgets.button(view + "/legend/fold", shown ? "▼ legend" : "▶ legend"))
    context.preferences.show_legend = !context.preferences.show_legend;
}

/// While it is folded, or there is no room for it.
void tellNotes(const std::vector<LayerNotes>& notes, const Theme& theme) {
  ImGui::BeginTooltip();
  for (const LayerNotes& layer : notes) drawNotes(layer, theme, kTooltip_em * ImGui::GetFontSize());
  ImGui::EndTooltip();
}

/// Begins a window on the scene with its lower left corner there; to be closed with ImGui::End().
void beginOverlay(const std::string& name, float left, float bottom, ImGuiWindowFlags flags) {
  ImGui::SetNextWindowPos({left, bottom}, ImGuiCond_Always, {0.0f, 1.0f});
  ImGui::SetNextWindowBgAlpha(0.78f);
  ImGui::Begin(name.c_str(), nullptr,
               flags | ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::SetWindowFontScale(kTextScale);
}

}  // namespace

void drawLegendEntry(const LegendEntry& entry, const Theme& theme, float width_px) {
  const float size = ImGui::GetFontSize() * kMark_em;
  drawMark(*ImGui::GetWindowDrawList(), ImGui::GetCursorScreenPos(), size, entry, packed(theme.ink));
  ImGui::Dummy({size, size});
  ImGui::SameLine();
  wrappedText(entry.text, width_px > 0.0f ? width_px - size - ImGui::GetStyle().ItemSpacing.x : 0.0);
}

void drawColorScale(const ColorScale& scale, float width, const Theme& theme) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float height = ImGui::GetFontSize() * 0.7f;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  constexpr int kPieces = 32;
  for (int i = 0; i < kPieces; ++i) {
    const float x0 = at.x + width * i / kPieces, x1 = at.x + width * (i + 1) / kPieces;
    draw.AddRectFilled({x0, at.y}, {x1, at.y + height}, packed(colorAt(scale.map, (i + 0.5) / kPieces)));
  }
  ImGui::Dummy({width, height});
  const double step = (scale.high - scale.low) / 2.0;
  const int every = width < kNarrowScale_em * ImGui::GetFontSize() ? 2 : 1;  // else the numbers run together
  for (int i = 0; i <= 2; i += every) {
    const std::string text = (i == 2 && scale.open_top ? "≥ " : "") + shortNumber(scale.low + i * step);
    const float size = ImGui::CalcTextSize(text.c_str()).x;
    draw.AddText({at.x + (width - size) * i / 2.0f, at.y + height + 1.0f}, packed(theme.ink), text.c_str());
  }
  ImGui::Dummy({width, ImGui::GetFontSize()});
}

float legendOverlay(PanelContext& context, const ViewArea& area, const LayerNotes& more) {
  constexpr float kLargestShare = 0.45f;
  std::vector<const LayerNotes*> shown_notes = context.scene.shownNotes();
  shown_notes.push_back(&more);
  std::vector<LayerNotes> notes = withoutRepeats(shown_notes);
  std::erase_if(notes, [](const LayerNotes& n) { return n.legend.empty() && !n.scale; });
  if (notes.empty()) return 0.0f;
  const float left = area.left + kGap_px, bottom = area.bottom - kGap_px;
  beginOverlay(area.name + " fold", left, bottom, 0);
  const bool shown = context.preferences.show_legend && hasRoomForLegend(area);
  foldButton(context, area.name, shown);
  const ImVec2 button = ImGui::GetWindowSize();
  if (!shown && ImGui::IsItemHovered()) tellNotes(notes, context.theme);
  ImGui::End();
  if (!shown) return button.x + kGap_px;
  const float width = std::min(widthOf(notes), kLargestShare * area.width());
  ImGui::SetNextWindowSize({width, 0.0f});
  ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, {width, std::max(1.0f, bottom - button.y - area.top)});
  beginOverlay(area.name + " legend", left, bottom - button.y, ImGuiWindowFlags_NoInputs);
  for (const LayerNotes& layer : notes) drawNotes(layer, context.theme);
  const ImVec2 at = ImGui::GetWindowPos(), extent = ImGui::GetWindowSize();
  context.widgets.note(area.name + "/legend", {at.x, at.y, at.x + extent.x, at.y + extent.y, true});
  ImGui::End();
  return std::max(width, button.x) + kGap_px;
}

}  // namespace vantage
