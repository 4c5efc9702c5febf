// Why one view was chosen or not: its factors beside those of the view that it is measured against.
#include <imgui.h>

#include <algorithm>

#include "viewer/captions.h"
#include "viewer/explanation.h"
#include "viewer/panels/panel.h"
#include "viewer/panels/plot.h"

namespace vantage {
namespace {

/// The view is filled, what it is measured against is outlined and hatched.
void bar(const PanelContext& context, ImVec2 low, ImVec2 high, double share, bool is_view) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const Theme& theme = context.theme;
  const Rgb color = is_view ? theme.accent : theme.chosen;
  const ImVec2 end{low.x + std::max(1.0f, static_cast<float>(share) * (high.x - low.x)), high.y};
  draw.AddRectFilled(low, high, packed(theme.ink, 0.08));
  if (!(share > 0.0)) return;
  draw.AddRectFilled(low, end, packed(color, is_view ? 0.9 : 0.25));
  if (is_view) return;
  const float height = high.y - low.y, gap = height * 0.8f;
  draw.PushClipRect(low, end, true);
  for (float x = low.x - height; x < end.x; x += gap)
    draw.AddLine({x, high.y}, {x + height, low.y}, packed(color, 0.8), 1.0f);
  draw.PopClipRect();
  draw.AddRect(low, end, packed(color));
}

class Bars {
 public:
  Bars(PanelContext& context, const Explanation& explanation) : context_(context), explanation_(explanation) {
    const float room = ImGui::GetContentRegionAvail().x;
    for (const ViewFactor& factor : explanation.factors)
      for (const auto& reading : {factor.view, factor.other})
        if (reading && reading->share) text_ = std::max(text_, ImGui::CalcTextSize(reading->text.c_str()).x);
    width_ = std::max(room - text_ - ImGui::GetStyle().ItemSpacing.x, room * 0.3f);
  }

  void draw() {
    legend();
    for (const ViewFactor& factor : explanation_.factors)
      if (hasBar(factor)) barsOf(factor);
    facts();
  }

 private:
  static bool hasBar(const ViewFactor& factor) {
    return (factor.view && factor.view->share) || (factor.other && factor.other->share);
  }

  void legend() {
    const std::string id = std::to_string(explanation_.id);
    const auto entry = [&](const std::string& name, bool is_view) {
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const float size = ImGui::GetFontSize();
      bar(context_, {at.x, at.y + 0.2f * size}, {at.x + 1.5f * size, at.y + 0.9f * size}, 1.0, is_view);
      ImGui::Dummy({1.5f * size, size});
      ImGui::SameLine();
      ImGui::TextUnformatted(name.c_str());
    };
    entry((explanation_.is_winner ? "chosen: " : "view ") + id, true);
    if (!explanation_.other) return;
    ImGui::SameLine(0.0f, ImGui::GetFontSize());
    entry((explanation_.is_winner ? "next: " : "chosen: ") + std::to_string(*explanation_.other), false);
  }

  /// One bar if both views have the same, of the same segment say.
  void barsOf(const ViewFactor& factor) {
    ImGui::TextUnformatted(factor.name.c_str());
    context_.widgets.note("explain/factor " + factor.name);
    tip(factor.about);
    const bool both = explanation_.other && factor.view == factor.other;
    const std::string note = !both                  ? factor.limit
                             : factor.limit.empty() ? "(both)"
                                                    : "(both)  " + factor.limit;
    if (!note.empty()) {
      ImGui::SameLine();
      faintText(context_.theme, note);
    }
    const ImVec2 from = ImGui::GetCursorScreenPos();
    line(factor.view, true);
    if (explanation_.other && factor.view != factor.other) line(factor.other, false);
    if (!factor.limit_share) return;
    const float x = from.x + static_cast<float>(*factor.limit_share) * width_;
    const float bottom = ImGui::GetCursorScreenPos().y - ImGui::GetStyle().ItemSpacing.y;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddLine({x, from.y - 2.0f}, {x, bottom + 1.0f}, packed(context_.theme.ink), 2.0f);
    draw.AddTriangleFilled({x - 4.0f, from.y - 4.0f}, {x + 4.0f, from.y - 4.0f}, {x, from.y + 2.0f},
                           packed(context_.theme.ink));
  }

  void line(const std::optional<FactorReading>& reading, bool is_view) {
    const float height = ImGui::GetFontSize() * 0.8f;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, 2.0f});
    const ImVec2 low{at.x, at.y + 2.0f};
    bar(context_, low, {at.x + width_, low.y + height}, reading ? reading->share.value_or(0.0) : 0.0,
        is_view);
    ImGui::Dummy({width_, ImGui::GetFontSize()});
    ImGui::SameLine(0.0f, ImGui::GetStyle().ItemSpacing.x);
    if (reading)
      ImGui::TextUnformatted(reading->text.c_str());
    else
      faintText(context_.theme, explanation_.missing);
    ImGui::PopStyleVar();
  }

  /// What has no scale, side by side.
  void facts() {
    if (!ImGui::BeginTable("facts", explanation_.other ? 3 : 2,
                           ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_BordersInnerH))
      return;
    for (const ViewFactor& factor : explanation_.factors) {
      if (hasBar(factor) || (!factor.view && !factor.other)) continue;
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(factor.name.c_str());
      tip(factor.about);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(factor.view ? factor.view->text.c_str() : "–");
      if (!explanation_.other) continue;
      ImGui::TableNextColumn();
      faintText(context_.theme, factor.other ? factor.other->text : "–");
    }
    ImGui::EndTable();
  }

  PanelContext& context_;
  const Explanation& explanation_;
  float text_ = 0.0f, width_ = 0.0f;  ///< of readings and of bars, pixels
};

/// Layers that show what a view counts.
std::vector<Layer> countedLayers(const PanelContext& context) {
  if (!onOctree(context.model.shown().frame())) return {Layer::HitVoxels, Layer::Occluders};
  return {Layer::HitVoxels, Layer::Occluders, Layer::CoarseRays, Layer::RefinedRays};
}

void buttons(PanelContext& context, const Explanation& e) {
  const Command* through = context.commands.find("view.through");
  if (through && context.widgets.button("explain/look through", "look through it",
                                        through->enabled() && e.row.has_value(),
                                        through->title + "  " + textOf(through->keys)))
    through->run();
  LayerSet& layers = context.preferences.view.layers;
  const std::vector<Layer> counted = countedLayers(context);
  const bool on = std::ranges::all_of(counted, [&](Layer layer) { return layers.has(layer); });
  const std::string label = on ? "hide what it counts" : "show what it counts";
  sameLineIfFits(label);
  if (context.widgets.button("explain/show counted", label, e.row.has_value(),
                             "voxels on which its rays end, and what is in their way"))
    for (const Layer layer : counted) layers.set(layer, !on);
  if (e.is_winner || !e.other) return;
  if (context.widgets.button("explain/select winner", "select the chosen view", true,
                             "the one that it is measured against"))
    context.model.selected_view = *e.other;
}

template <class T>
bool isSame(const std::weak_ptr<const T>& known, const std::shared_ptr<const T>& now) {
  return !known.owner_before(now) && !now.owner_before(known);
}

/// Distinct voxels that the view counts. They are counted anew only if they may be others, and not while a
/// slider is moved: that casts a whole view.
void countedLine(PanelContext& context, const Explanation& e) {
  const StepData& shown = context.model.shown();
  const auto region = e.row ? countedRegion(shown.frame(), *e.row) : std::nullopt;
  if (!region) return;
  CandidateState& state = context.candidates;
  const bool known = state.counted && state.counted->region == *region &&
                     isSame(state.counted->states, shown.states) && isSame(state.counted->tree, shown.tree);
  if (!known && ImGui::IsMouseDown(0)) return;
  if (!known) state.counted = {*region, shown.states, shown.tree, countedVoxels(shown.frame(), *region)};
  const std::string voxels = grouped(state.counted->voxels) + " unknown voxels";
  // Coarse rays may miss what all of the finest would see.
  faintText(context.theme, onOctree(shown.frame())
                               ? "Without coarse rays it would see " + voxels + " of the object's box."
                               : "It sees " + voxels + " that count.");
  context.widgets.note("explain/voxels");
}

}  // namespace

void explainPanel(PanelContext& context) {
  const StepData& shown = context.model.shown();
  const auto id = context.model.explainedView();
  if (shown.empty() || !id) {
    if (shown.empty())
      emptyText(context, "explain", "No step is open.");
    else if (shown.record->closing)
      faintText(context.theme, "Nothing was planned on the map after the last scan.");
    else if (context.model.isRun())
      wrappedText((onOctree(shown.frame()) ? utilityFigures : viewFigures)(shown.frame(), {}));
    else
      faintText(context.theme, "The file holds no plan.");
    context.widgets.note("explain/no view");
    return;
  }
  context.candidates.table.show(context.model.recorded(), shown);
  const Explanation explanation = explain(shown.frame(), context.candidates.table.rows(), *id);
  wrappedText(explanation.sentence);
  context.widgets.note("explain/sentence");
  buttons(context, explanation);
  Bars(context, explanation).draw();
  countedLine(context, explanation);
}

}  // namespace vantage
