// The run at a glance: residual unknown, coverage and gain of every step; where it stands; how it moves on.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "viewer/captions.h"
#include "viewer/panels/panel.h"
#include "viewer/panels/plot.h"

namespace vantage {
namespace {

constexpr float kBetweenStages = 2.0f;

struct Curves {
  std::vector<double> unknown_m3;  ///< of each step
  double most_unknown_m3 = 0.0, most_gain = 0.0;
  bool has_coverage = false;
};

Curves measure(const InspectorModel& model) {
  Curves curves;
  for (const StepSummary& step : model.steps()) {
    curves.unknown_m3.push_back(unknownVolume_m3(*model.header(), step));
    curves.most_unknown_m3 = std::max(curves.most_unknown_m3, curves.unknown_m3.back());
    curves.most_gain = std::max(curves.most_gain, step.gain.value_or(0.0));
    curves.has_coverage |= step.coverage.has_value();
  }
  return curves;
}

std::string nameOf(const StepSummary& step) {
  return step.closing ? "end" : std::to_string(step.step);
}

/// Everything about a step that the strip shows, in words.
void describe(const InspectorModel& model, int index) {
  const StepSummary& step = model.steps()[index];
  ImGui::BeginTooltip();
  if (step.closing)
    ImGui::TextUnformatted("Map after the last scan");
  else
    ImGui::Text("Step %d, %s planner", step.step, step.planner.c_str());
  ImGui::Text("unknown in the workspace: %s, %s voxels",
              volumeText(unknownVolume_m3(*model.header(), step)).c_str(),
              grouped(step.unknown_voxels).c_str());
  if (step.coverage) ImGui::Text("coverage of the objects: %.1f %%", 100.0 * *step.coverage);
  if (step.gain) ImGui::Text("gain of the chosen view: %s rays", grouped(std::llround(*step.gain)).c_str());
  if (step.gain_voxels) ImGui::Text("predicted: %s voxels", grouped(*step.gain_voxels).c_str());
  if (step.realised_voxels) ImGui::Text("realised: %s voxels", grouped(*step.realised_voxels).c_str());
  if (!step.closing && !step.gain) ImGui::TextUnformatted("no view was chosen");
  ImGui::EndTooltip();
}

class Strip {
 public:
  Strip(PanelContext& context, ImVec2 low, ImVec2 high)
      : context_(context),
        steps_(context.model.steps()),
        curves_(measure(context.model)),
        draw_(*ImGui::GetWindowDrawList()),
        low_(low),
        high_(high),
        slot_((high.x - low.x) / std::max<std::size_t>(1, steps_.size())) {}

  void draw() {
    const Theme& theme = context_.theme;
    draw_.AddRectFilled(low_, high_, packed(theme.paper));
    for (std::size_t i = 0; i < steps_.size(); ++i) drawGain(static_cast<int>(i));
    drawPlace();
    curve(theme.curve, curves_.most_unknown_m3,
          [this](std::size_t i) { return std::optional(curves_.unknown_m3[i]); });
    if (curves_.has_coverage)
      curve(theme.second_curve, 1.0, [this](std::size_t i) { return steps_[i].coverage; });
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const std::string text = nameOf(steps_[i]);
      const ImVec2 size = ImGui::CalcTextSize(text.c_str());
      draw_.AddText({middle(static_cast<int>(i)) - size.x / 2, high_.y - size.y}, packed(theme.faint),
                    text.c_str());
    }
    draw_.AddRect(low_, high_, packed(theme.faint, 0.5));
  }

  /// Index of the step under a horizontal place.
  int indexAt(float x) const {
    const float last = static_cast<float>(steps_.size()) - 1.0f;
    return static_cast<int>(std::clamp((x - low_.x) / slot_, 0.0f, last));
  }

  void nameSteps() {
    for (std::size_t i = 0; i < steps_.size(); ++i)
      context_.widgets.note("timeline/step " + nameOf(steps_[i]),
                            {low_.x + slot_ * i, low_.y, low_.x + slot_ * (i + 1), high_.y, true});
  }

 private:
  float middle(int index) const { return low_.x + slot_ * (static_cast<float>(index) + 0.5f); }
  float height(double share) const {
    const float text = ImGui::GetFontSize();
    return high_.y - text - static_cast<float>(share) * (high_.y - low_.y - text - 4.0f);
  }

  void drawGain(int index) {
    const double gain = steps_[index].gain.value_or(0.0);
    if (gain <= 0.0 || curves_.most_gain <= 0.0) return;
    const float half = std::min(14.0f, slot_ * 0.28f), x = middle(index);
    draw_.AddRectFilled({x - half, height(gain / curves_.most_gain)}, {x + half, height(0.0)},
                        packed(context_.theme.third_curve, 0.35));
  }

  void drawPlace() {
    const int index = context_.model.place().step;
    if (index >= static_cast<int>(steps_.size())) return;
    const ImVec2 a{low_.x + slot_ * index, low_.y}, b{low_.x + slot_ * (index + 1), high_.y};
    draw_.AddRectFilled(a, b, packed(context_.theme.accent, 0.12));
    draw_.AddRect(a, b, packed(context_.theme.accent), 0.0f, 0, 2.0f);
  }

  /// \param value of the step with an index, if it has one
  template <class ValueOf>
  void curve(Rgb color, double largest, const ValueOf& value) {
    if (largest <= 0.0) return;
    std::optional<ImVec2> before;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const std::optional<double> v = value(i);
      if (!v) continue;
      const ImVec2 at{middle(static_cast<int>(i)), height(*v / largest)};
      if (before) draw_.AddLine(*before, at, packed(color), 2.0f);
      draw_.AddCircleFilled(at, 3.5f, packed(color));
      before = at;
    }
  }

  PanelContext& context_;
  const std::vector<StepSummary>& steps_;
  Curves curves_;
  ImDrawList& draw_;
  ImVec2 low_, high_;
  float slot_;
};

void strip(PanelContext& context) {
  const ImVec2 low = ImGui::GetCursorScreenPos(), size = ImGui::GetContentRegionAvail();
  const ImVec2 high{low.x + std::max(60.0f, size.x), low.y + std::max(40.0f, size.y)};
  Strip strip(context, low, high);
  ImGui::InvisibleButton("strip", {high.x - low.x, high.y - low.y});
  context.widgets.note("timeline/strip");
  strip.nameSteps();
  strip.draw();
  const int index = strip.indexAt(ImGui::GetIO().MousePos.x);
  if (ImGui::IsItemActive() && index != context.model.place().step) context.model.goToStep(index);
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) describe(context.model, index);
}

void commandButton(PanelContext& context, const std::string& id, const std::string& label) {
  const Command* command = context.commands.find(id);
  if (!command) return;
  std::string text = command->title;
  if (command->keys.key != Key::None) text += "  (" + textOf(command->keys) + ")";
  if (context.widgets.button("timeline/" + id.substr(id.find('.') + 1), label, command->enabled(), text))
    command->run();
}

void transport(PanelContext& context) {
  Player& player = context.model.player;
  commandButton(context, "timeline.first", "|◀");
  ImGui::SameLine(0.0f, 2.0f);
  commandButton(context, "timeline.previous", "◀");
  ImGui::SameLine(0.0f, 2.0f);
  commandButton(context, "timeline.play", player.playing() ? "Pause" : "Play ▶");
  ImGui::SameLine(0.0f, 2.0f);
  commandButton(context, "timeline.next", "▶");
  ImGui::SameLine(0.0f, 2.0f);
  commandButton(context, "timeline.last", "▶|");
  ImGui::SameLine();
  context.widgets.toggle("timeline/loop", "loop", player.loop);
  ImGui::SameLine();
  context.widgets.toggle("timeline/by stage", "by stage", player.by_stage);
  tip("playing and stepping stop at every stage inside a step");
  ImGui::SameLine();
  double speed = player.speed();
  if (context.widgets.slider("timeline/speed", "", speed, Player::kSlowest, Player::kFastest, "%.2g / s",
                             true, ImGui::GetFontSize() * 7.0))
    player.setSpeed(speed);
  tip("steps (or stages) a second");
}

void showStage(PanelContext& context, int stage) {
  context.model.goTo({context.model.place().step, stage});
  context.preferences.view.layers = context.model.stages()[stage].layers;
}

/// Nothing else was switched on or off since.
bool isShown(const PanelContext& context, int stage) {
  return stage == context.model.place().stage &&
         context.preferences.view.layers == context.model.stages()[stage].layers;
}

float widthOfButtons(const std::vector<StageView>& stages) {
  float width = 0.0f;
  for (const StageView& stage : stages)
    width +=
        ImGui::CalcTextSize(stage.title.c_str()).x + 2 * ImGui::GetStyle().FramePadding.x + kBetweenStages;
  return width;
}

void stageButtons(PanelContext& context) {
  const auto& stages = context.model.stages();
  for (int i = 0; i < static_cast<int>(stages.size()); ++i) {
    if (i > 0) ImGui::SameLine(0.0f, kBetweenStages);
    const bool shown = isShown(context, i);
    if (shown) ImGui::PushStyleColor(ImGuiCol_Button, packed(context.theme.accent, 0.45));
    if (context.widgets.button("timeline/stage " + stages[i].name, stages[i].title, true, stages[i].about))
      showStage(context, i);
    if (shown) ImGui::PopStyleColor();
  }
}

/// The same where there is no room for buttons.
void stageList(PanelContext& context) {
  std::vector<std::string> titles;
  for (const StageView& stage : context.model.stages()) titles.push_back(stage.title);
  int stage = context.model.place().stage;
  if (context.widgets.combo("timeline/stages", "", titles, stage, ImGui::GetFontSize() * 7.0))
    showStage(context, stage);
  tip(context.model.stages()[context.model.place().stage].about);
}

void stages(PanelContext& context) {
  constexpr float kBefore = 16.0f;
  const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  const float room = end - ImGui::GetItemRectMax().x - kBefore;
  ImGui::SameLine(0.0f, kBefore);
  if (widthOfButtons(context.model.stages()) <= room)
    stageButtons(context);
  else
    stageList(context);
}

void curveLegend(PanelContext& context) {
  const Curves curves = measure(context.model);
  const auto entry = [&](Rgb color, const std::string& text) {
    const float size = ImGui::GetFontSize();
    ImGui::SameLine();
    const float needed = size + 4.0f + ImGui::CalcTextSize(text.c_str()).x;
    if (ImGui::GetContentRegionAvail().x < needed) return;  // the strip says it in words under the mouse
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + size * 0.35f}, {at.x + size, at.y + size * 0.7f},
                                              packed(color));
    ImGui::Dummy({size, size});
    ImGui::SameLine(0.0f, 4.0f);
    ImGui::TextUnformatted(text.c_str());
  };
  entry(context.theme.curve, "unknown, up to " + volumeText(curves.most_unknown_m3));
  if (curves.has_coverage) entry(context.theme.second_curve, "coverage, 0..100 %");
  if (curves.most_gain > 0.0)
    entry(context.theme.third_curve, "gain, up to " + shortNumber(curves.most_gain) + " rays");
}

}  // namespace

void timelinePanel(PanelContext& context) {
  if (context.model.steps().empty()) {
    ImGui::TextDisabled("No run is open: a timeline appears here.");
    return;
  }
  transport(context);
  stages(context);
  ImGui::Dummy({0.0f, 0.0f});
  curveLegend(context);
  strip(context);
}

}  // namespace vantage
