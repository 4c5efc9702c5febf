// Parameters: what would have been decided with other ones.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "viewer/panels/panel.h"
#include "viewer/panels/plot.h"
#include "viewer/parameter_text.h"
#include "viewer/parameters.h"

namespace vantage {
namespace {

/// A mark on the slider that was drawn last.
void tick(const Parameter& p, double value, Rgb color, const std::string& text) {
  const double share = shareOnTrack(value, p.low, p.high, p.logarithmic);
  if (!(share >= 0.0 && share <= 1.0)) return;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const float grab = ImGui::GetStyle().GrabMinSize / 2 + 2.0f;
  const float x = low.x + grab + static_cast<float>(share) * (high.x - low.x - 2 * grab);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddTriangleFilled({x - 4.0f, low.y - 1.0f}, {x + 4.0f, low.y - 1.0f}, {x, low.y + 5.0f},
                         packed(color));
  const float mouse = ImGui::GetIO().MousePos.x;
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive() && std::abs(mouse - x) < 8.0f)
    ImGui::SetTooltip("%s", text.c_str());
}

double numberOf(const config::Value& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  const auto* number = std::get_if<double>(&value);
  return number ? *number : 0.0;
}

/// A number of the slider as a value of the key.
config::Value valueOf(const config::Field& field, const Parameter& p, double number) {
  if (p.step > 0.0) number = std::round(number / p.step) * p.step;
  number = std::clamp(number, field.low, field.high);
  if (field.kind == config::Kind::Integer) return static_cast<std::int64_t>(std::llround(number));
  return std::round(number * 1e9) / 1e9;
}

class Row {
 public:
  Row(PanelContext& context, const Parameter& p)
      : context_(context),
        what_if_(context.model.whatIf()),
        p_(p),
        field_(*config::find(p.key)),
        name_("what-if/" + p.key) {}

  void draw() {
    title();
    switch (field_.kind) {
      case config::Kind::Boolean:
        toggle();
        break;
      case config::Kind::Choice:
        choice();
        break;
      case config::Kind::Number:
      case config::Kind::Integer:
        number();
        break;
      default:
        list();
        break;
    }
    const std::string error = what_if_.edits().error(p_.key);
    if (error.empty()) return;
    ImGui::PushStyleColor(ImGuiCol_Text, packed(context_.theme.warning));
    wrappedText(error);
    ImGui::PopStyleColor();
    context_.widgets.note(name_ + "/error");
  }

 private:
  void title() {
    const bool changed = what_if_.edits().changed(p_.key);
    const std::string symbol = p_.symbol.empty() ? "" : p_.symbol + "  ";
    if (field_.kind == config::Kind::Boolean) return;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted((symbol + p_.label).c_str());
    tip(p_.key + "\n" + field_.documentation + "\nallowed: " + allowedText(field_) +
        (p_.paper ? "\nthe paper: " + shownText(p_.key, *p_.paper) + " " + p_.unit : ""));
    if (changed) resetButton();
  }

  void resetButton() {
    const std::string then = shownText(p_.key, what_if_.edits().recordedValue(p_.key));
    ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::GetFontSize() * 3.6f);
    if (context_.widgets.button(name_ + "/reset", "reset", true, "back to the run's value, " + then))
      what_if_.reset(p_.key);
  }

  void toggle() {
    bool on = std::get<bool>(what_if_.edits().value(p_.key));
    if (context_.widgets.toggle(name_, p_.label, on)) {
      what_if_.set(p_.key, on);
      what_if_.finishEdit();
    }
    tip(p_.key + "\n" + field_.documentation);
    if (what_if_.edits().changed(p_.key)) resetButton();
  }

  void choice() {
    const std::string now = std::get<std::string>(what_if_.edits().value(p_.key));
    int chosen = static_cast<int>(std::ranges::find(field_.choices, now) - field_.choices.begin());
    if (context_.widgets.combo(name_, "", field_.choices, chosen)) {
      what_if_.set(p_.key, field_.choices[chosen]);
      what_if_.finishEdit();
    }
  }

  void number() {
    const float field_width = ImGui::GetFontSize() * 4.6f, unit_width = ImGui::GetFontSize() * 2.4f;
    const float room =
        ImGui::GetContentRegionAvail().x - field_width - unit_width - 2 * ImGui::GetStyle().ItemSpacing.x;
    double value = numberOf(what_if_.edits().value(p_.key));
    if (p_.high > p_.low) {
      if (context_.widgets.slider(name_, "", value, p_.low, p_.high, "", p_.logarithmic, room))
        what_if_.set(p_.key, valueOf(field_, p_, value));
      if (ImGui::IsItemDeactivated()) what_if_.finishEdit();
      if (p_.paper)
        tick(p_, *p_.paper, context_.theme.chosen,
             "the paper: " + shownText(p_.key, *p_.paper) + " " + p_.unit);
      ImGui::SameLine();
    }
    text(field_width);
    unit();
  }

  void list() {
    text(ImGui::GetContentRegionAvail().x - ImGui::GetFontSize() * 2.4f - ImGui::GetStyle().ItemSpacing.x);
    unit();
  }

  void unit() {
    if (p_.unit.empty()) return;
    ImGui::SameLine();
    ImGui::TextDisabled("%s", p_.unit.c_str());
  }

  void text(float width) {
    std::string now = shownText(p_.key, what_if_.edits().value(p_.key));
    if (context_.widgets.field(name_ + "/text", now, width)) what_if_.setText(p_.key, now);
  }

  PanelContext& context_;
  WhatIf& what_if_;
  const Parameter& p_;
  const config::Field& field_;
  std::string name_;
};

/// The view that the run chose and the one that would be chosen now.
void decision(PanelContext& context) {
  const StepData &then = context.model.recorded(), &now = context.model.shown();
  if (then.empty() || now.empty()) return;
  const auto nameOf = [](const StepData& data) {
    return data.record->hasView() ? "view " + std::to_string(data.record->chosen()->id) : std::string("none");
  };
  const auto poseOf = [](const StepData& data) {
    return data.record->hasView() ? std::optional(data.record->chosen()->T_world_camera) : std::nullopt;
  };
  const std::string before = nameOf(then), after = nameOf(now);
  const auto was = poseOf(then), is = poseOf(now);
  const bool same = was && is ? was->isApprox(*is) : !was && !is;  // numbers may be given anew
  if (same)
    ImGui::Text("Decision: %s, as in the run", before.c_str());
  else
    ImGui::Text("Decision: %s  →  %s", before.c_str(), after.c_str());
  context.widgets.note("what-if/decision");
}

void header(PanelContext& context) {
  WhatIf& what_if = context.model.whatIf();
  decision(context);
  ImGui::PushStyleColor(ImGuiCol_Text, packed(what_if.state() == WhatIfState::Failed ? context.theme.warning
                                                                                     : context.theme.faint));
  // Always as many lines: the sliders below stay under the mouse.
  ImGui::TextUnformatted(stateText(what_if).c_str());
  tip(stateText(what_if));
  ImGui::PopStyleColor();
  ImGui::TextDisabled("%s", scoredText(what_if).c_str());
  Widgets& w = context.widgets;
  const auto command = [&](const char* id, const char* label) {
    const Command* c = context.commands.find(id);
    if (c &&
        w.button(std::string("what-if/") + label, label, c->enabled(), c->title + "  " + textOf(c->keys)))
      c->run();
  };
  command("what-if.undo", "undo");
  sameLineIfFits("redo");
  command("what-if.redo", "redo");
  sameLineIfFits("reset all");
  command("what-if.reset", "reset all");
  sameLineIfFits(what_if.cancelled() ? "run again" : "cancel");
  if (what_if.cancelled())
    command("what-if.run again", "run again");
  else
    command("what-if.cancel", "cancel");
  if (w.button("what-if/copy", "copy as TOML", true, "the changed parameters as a configuration file")) {
    context.copy(what_if.edits().toml());
    context.model.say(Notice::Level::Info, "the changed parameters are on the clipboard, as TOML");
  }
  sameLineIfFits("write config…");
  command("file.write config", "write config…");
}

}  // namespace

void whatIfPanel(PanelContext& context) {
  const WhatIf& what_if = context.model.whatIf();
  if (context.model.recorded().empty() || !context.model.isRun()) {
    emptyText(context, "what-if",
              "Open a run: then the parameters of its planner can be tried on every step.");
    return;
  }
  if (context.model.recorded().record->closing) {
    wrappedText("Nothing was planned on the map after the last scan; go to a step.");
    return;
  }
  header(context);
  ImGui::Separator();
  ImGui::BeginDisabled(!what_if.ready());
  for (const ParameterGroup& group : parametersOf(context.model.planner())) {
    const bool first = &group == &parametersOf(context.model.planner()).front();
    const bool open =
        ImGui::CollapsingHeader(group.title.c_str(), first ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    context.widgets.note("what-if/group " + group.title);
    if (!open) continue;
    for (const Parameter& parameter : group.parameters) Row(context, parameter).draw();
  }
  ImGui::EndDisabled();
}

}  // namespace vantage
