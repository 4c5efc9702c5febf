// Predicted against realised gain: a point a step, on the diagonal if the prediction was right.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "viewer/captions.h"
#include "viewer/panels/panel.h"
#include "viewer/panels/plot.h"
#include "viewer/view_words.h"

namespace vantage {
namespace {

/// One step in the scatter.
struct GainPoint {
  int index = 0;  ///< in the timeline
  const StepSummary* step = nullptr;
  double predicted = 0.0, realised = 0.0;  ///< voxels
};

std::vector<GainPoint> pointsOf(const std::vector<StepSummary>& steps) {
  std::vector<GainPoint> points;
  for (int i = 0; i < static_cast<int>(steps.size()); ++i) {
    const StepSummary& step = steps[i];
    if (step.gain_voxels && step.realised_voxels)
      points.push_back(
          {i, &step, static_cast<double>(*step.gain_voxels), static_cast<double>(*step.realised_voxels)});
  }
  return points;
}

/// Planners of a run in the order of their names; their place gives colour and shape.
std::vector<std::string> plannersOf(const std::vector<StepSummary>& steps) {
  std::vector<std::string> planners;
  for (const StepSummary& step : steps)
    if (!step.closing && std::ranges::find(planners, step.planner) == planners.end())
      planners.push_back(step.planner);
  std::ranges::sort(planners);
  return planners;
}

struct Mark {
  Rgb color;
  int corners;  ///< 0 = round
};

Mark markOf(const Theme& theme, const std::vector<std::string>& planners, const std::string& planner) {
  const std::size_t place = std::ranges::find(planners, planner) - planners.begin();
  const Mark marks[] = {{theme.third_curve, 0}, {theme.curve, 4}, {theme.second_curve, 3}, {theme.chosen, 6}};
  return marks[place % std::size(marks)];
}

void drawMark(ImVec2 at, const Mark& mark, float radius, bool filled) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const int corners = mark.corners > 0 ? mark.corners : 16;
  if (filled) draw.AddNgonFilled(at, radius, packed(mark.color), corners);
  draw.AddNgon(at, radius, packed(mark.color), corners, 2.0f);
}

std::string nameOf(const StepSummary& step) {
  return "step " + std::to_string(step.step);
}

/// "10.6" or "12 345"; nothing was predicted: "–".
std::string ratioText(const GainPoint& point) {
  if (!(point.predicted > 0.0)) return "–";
  const double ratio = point.realised / point.predicted;
  return ratio < 1000.0 ? rounded(ratio, 3) : whole(ratio);
}

class Scatter {
 public:
  Scatter(PanelContext& context, std::vector<GainPoint> points)
      : context_(context), points_(std::move(points)), planners_(plannersOf(context.model.steps())) {
    double least = 1e18, most = 1.0;
    for (const GainPoint& p : points_) {
      for (const double voxels : {p.predicted, p.realised}) {
        if (voxels > 0.0) least = std::min(least, voxels);
        most = std::max(most, voxels);
      }
    }
    low_ = std::floor(std::log10(std::min(least, most)));
    high_ = std::max(low_ + 1.0, std::ceil(std::log10(most)));
  }

  void draw() {
    layOut();
    axes();
    diagonal();
    const GainPoint* hovered = nearest();
    for (const GainPoint& p : points_) point(p, hovered == &p);
    for (const GainPoint& p : points_) label(p);
    if (!hovered) return;
    describe(*hovered);
    ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (clicked_) context_.model.goToStep(hovered->index);
  }

  void legend() {
    if (planners_.size() < 2) return;
    for (const std::string& planner : planners_) {
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const float size = ImGui::GetFontSize();
      drawMark({at.x + size / 2, at.y + size / 2}, markOf(context_.theme, planners_, planner), size * 0.32f,
               true);
      ImGui::Dummy({size, size});
      ImGui::SameLine();
      ImGui::TextUnformatted(planner.empty() ? "planner" : (planner + " planner").c_str());
    }
  }

 private:
  float radius() const { return ImGui::GetFontSize() * 0.38f; }

  /// A square as large as fits, with room for the axes.
  void layOut() {
    const float em = ImGui::GetFontSize();
    float widest = 0.0f;
    for (double decade = low_; decade <= high_; ++decade)
      widest = std::max(widest, ImGui::CalcTextSize(tickText(decade).c_str()).x);
    const ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const float left = widest + 0.7f * em, top = 1.6f * em, bottom = 2.8f * em, right = 1.2f * em;
    const float side = std::max(6.0f * em, std::min(room.x - left - right, room.y - top - bottom));
    area_ = {{at.x + left, at.y + top}, {at.x + left + side, at.y + top + side}, low_, high_, low_, high_};
    ImGui::InvisibleButton("scatter", {left + side + right, top + side + bottom});
    context_.widgets.note("gains/plot");
    over_ = ImGui::IsItemHovered();
    clicked_ = ImGui::IsItemClicked();
  }

  void axes() {
    const Theme& theme = context_.theme;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float em = ImGui::GetFontSize();
    const ImVec2 low = area_.low, high = area_.high;
    draw.AddRectFilled(low, high, packed(theme.paper));
    for (double decade = low_; decade <= high_; ++decade) {
      const ImVec2 x = area_.at(decade, low_), y = area_.at(low_, decade);
      draw.AddLine({x.x, low.y}, {x.x, high.y}, packed(theme.faint, 0.25));
      draw.AddLine({low.x, y.y}, {high.x, y.y}, packed(theme.faint, 0.25));
      const std::string text = tickText(decade);
      const ImVec2 size = ImGui::CalcTextSize(text.c_str());
      draw.AddText({x.x - size.x / 2, high.y + 0.2f * em}, packed(theme.ink), text.c_str());
      draw.AddText({low.x - size.x - 0.4f * em, y.y - size.y / 2}, packed(theme.ink), text.c_str());
    }
    draw.AddRect(low, high, packed(theme.ink, 0.6));
    const char *across = "predicted, voxels (logarithmic)", *up = "realised, voxels (logarithmic)";
    draw.AddText({(low.x + high.x - ImGui::CalcTextSize(across).x) / 2, high.y + 1.4f * em},
                 packed(theme.ink), across);
    draw.AddText({low.x, low.y - 1.4f * em}, packed(theme.ink), up);
  }

  void diagonal() {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    constexpr int kDashes = 24;
    const auto at = [&](int dash) {
      const double decade = low_ + (high_ - low_) * dash / kDashes;
      return area_.at(decade, decade);
    };
    for (int i = 0; i < kDashes; i += 2)
      draw.AddLine(at(i), at(i + 1), packed(context_.theme.ink, 0.6), 1.5f);
  }

  /// Values span decades, so both axes are logarithmic; what is nothing lies on the axis.
  ImVec2 placeOf(const GainPoint& p) const {
    const auto decade = [&](double voxels) {
      return voxels > 0.0 ? std::clamp(std::log10(voxels), low_, high_) : low_;
    };
    return area_.at(decade(p.predicted), decade(p.realised));
  }

  static std::string tickText(double decade) { return shortNumber(std::pow(10.0, decade)); }

  /// The point under the mouse.
  const GainPoint* nearest() const {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const GainPoint* best = nullptr;
    float best_px = 2.0f * radius();
    for (const GainPoint& p : points_) {
      const ImVec2 at = placeOf(p);
      const float away_px = std::hypot(at.x - mouse.x, at.y - mouse.y);
      if (over_ && away_px < best_px) {
        best = &p;
        best_px = away_px;
      }
    }
    return best;
  }

  void point(const GainPoint& p, bool hovered) {
    const Theme& theme = context_.theme;
    const ImVec2 at = placeOf(p);
    const float r = radius();
    drawMark(at, markOf(theme, planners_, p.step->planner), hovered ? 1.3f * r : r, true);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (p.index == context_.model.place().step) draw.AddCircle(at, 1.9f * r, packed(theme.accent), 0, 2.0f);
    context_.widgets.note("gains/point " + std::to_string(p.step->step),
                          {at.x - r, at.y - r, at.x + r, at.y + r, true});
  }

  /// The step's number, where it covers no other point.
  void label(const GainPoint& p) {
    const std::string text = std::to_string(p.step->step);
    const ImVec2 at = placeOf(p), size = ImGui::CalcTextSize(text.c_str());
    const float r = radius(), dx = r + 3.0f;
    const ImVec2 places[] = {{at.x + dx, at.y - size.y * 0.9f}, {at.x - dx - size.x, at.y - size.y * 0.9f},
                             {at.x + dx, at.y - size.y * 0.1f}, {at.x - dx - size.x, at.y - size.y * 0.1f},
                             {at.x - size.x / 2, at.y + r},     {at.x - size.x / 2, at.y - r - size.y}};
    const auto isFree = [&](ImVec2 place) {
      return place.x > area_.low.x && place.x + size.x < area_.high.x &&
             std::ranges::none_of(points_, [&](const GainPoint& other) {
               const ImVec2 o = placeOf(other);
               return &other != &p && o.x > place.x - r && o.x < place.x + size.x + r && o.y > place.y - r &&
                      o.y < place.y + size.y + r;
             });
    };
    const auto found = std::ranges::find_if(places, isFree);
    ImGui::GetWindowDrawList()->AddText(found == std::end(places) ? places[0] : *found,
                                        packed(context_.theme.ink), text.c_str());
  }

  void describe(const GainPoint& p) {
    ImGui::BeginTooltip();
    ImGui::Text("%s%s", nameOf(*p.step).c_str(),
                p.step->planner.empty() ? "" : (", " + p.step->planner + " planner").c_str());
    ImGui::Text("predicted: %s voxels", whole(p.predicted).c_str());
    ImGui::Text("realised: %s voxels", whole(p.realised).c_str());
    ImGui::Text("realised / predicted: %s", ratioText(p).c_str());
    ImGui::EndTooltip();
  }

  PanelContext& context_;
  std::vector<GainPoint> points_;
  std::vector<std::string> planners_;
  double low_ = 0.0, high_ = 1.0;  ///< decades at the ends of both axes
  PlotArea area_;
  bool over_ = false, clicked_ = false;
};

/// Steps that have no point, and why.
void missing(PanelContext& context) {
  const std::vector<StepSummary>& steps = context.model.steps();
  for (int i = 0; i < static_cast<int>(steps.size()); ++i) {
    const StepSummary& step = steps[i];
    if (step.closing || (step.gain_voxels && step.realised_voxels)) continue;
    std::string text = nameOf(step) + ": ";
    if (!step.has_view)
      text += "no view was chosen";
    else if (!step.gain_voxels)
      text += "no prediction in voxels";
    else
      text += whole(static_cast<double>(*step.gain_voxels)) + " voxels predicted, realised not yet known";
    if (context.widgets.button("gains/missing " + std::to_string(step.step), text)) context.model.goToStep(i);
  }
}

}  // namespace

void gainsPanel(PanelContext& context) {
  if (context.model.steps().empty()) {
    emptyText(context, "gains", "No run is open: its gains appear here.");
    return;
  }
  std::vector<GainPoint> points = pointsOf(context.model.steps());
  wrappedText(
      "Unknown voxels that a view was predicted to see, and by how many its region held fewer after the next "
      "scan.");
  if (points.empty()) {
    faintText(context.theme, "No step has both yet.");
  } else {
    Scatter scatter(context, std::move(points));
    scatter.draw();
    scatter.legend();
  }
  missing(context);
}

}  // namespace vantage
