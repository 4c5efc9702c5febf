// Marks over the 3-D view: the selected view, and what other parameters change in the choice.
#include "viewer/panels/scene_marks.h"

#include <cmath>

#include "viewer/panels/plot.h"

namespace vantage {
namespace {

using Mark = LegendEntry::Mark;

/// From the view that the run chose to the one that would be chosen now.
void markOtherChoice(PanelContext& context, const SceneMarks& marks, LayerNotes& notes) {
  const Theme& theme = context.theme;
  const StepData &recorded = context.model.recorded(), &shown = context.model.shown();
  if (!recorded.record->hasView() || !shown.record->hasView()) return;
  const ChosenView &then = *recorded.record->chosen(), &now = *shown.record->chosen();
  if (then.T_world_camera.isApprox(now.T_world_camera)) return;
  marks.frustum(viewCamera(recorded.frame()), then.T_world_camera, packed(theme.faint));
  marks.arrow(then.T_world_camera.translation(), now.T_world_camera.translation(), packed(theme.accent));
  marks.text(now.T_world_camera.translation(), "now chosen", theme);
  notes.legend.push_back(
      {Mark::Line, theme.faint, 1.0, "view that the run chose, with an arrow to the one now"});
}

}  // namespace

std::optional<ImVec2> SceneMarks::at(const Eigen::Vector3d& p_world) const {
  const auto px = pixelOf(eye, p_world, size);
  if (!px) return std::nullopt;
  return ImVec2(static_cast<float>(left + px->x() / pixel_scale),
                static_cast<float>(top + px->y() / pixel_scale));
}

void SceneMarks::line(const Eigen::Vector3d& a_world, const Eigen::Vector3d& b_world, ImU32 color,
                      float width) const {
  const auto from = at(a_world), to = at(b_world);
  if (from && to) draw.AddLine(*from, *to, color, width);
}

void SceneMarks::arrow(const Eigen::Vector3d& a_world, const Eigen::Vector3d& b_world, ImU32 color) const {
  constexpr float kHead = 12.0f, kHalfHead = 6.0f, kWidth = 3.0f;
  const auto from = at(a_world), to = at(b_world);
  if (!from || !to) return;
  const float dx = to->x - from->x, dy = to->y - from->y, length = std::hypot(dx, dy);
  if (length < kHead) return;
  const float u = dx / length, v = dy / length;
  const ImVec2 neck{to->x - kHead * u, to->y - kHead * v};
  draw.AddLine(*from, neck, color, kWidth);
  draw.AddTriangleFilled(*to, {neck.x - kHalfHead * v, neck.y + kHalfHead * u},
                         {neck.x + kHalfHead * v, neck.y - kHalfHead * u}, color);
}

void SceneMarks::frustum(const PinholeCamera& camera, const Pose& T_world_camera, ImU32 color) const {
  constexpr double kLength_m = 0.2;
  const FrustumCorners corners = frustumCorners(camera, T_world_camera, kLength_m);
  for (int i = 0; i < 4; ++i) {
    line(corners.apex, corners.image[i], color, 2.5f);
    line(corners.image[i], corners.image[(i + 1) % 4], color, 2.5f);
  }
}

void SceneMarks::text(const Eigen::Vector3d& p_world, const std::string& text, const Theme& theme) const {
  const auto place = at(p_world);
  if (!place) return;
  const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
  const ImVec2 low{place->x + 8.0f, place->y - extent.y - 4.0f};
  draw.AddRectFilled({low.x - 4.0f, low.y - 2.0f}, {low.x + extent.x + 4.0f, low.y + extent.y + 2.0f},
                     packed(theme.panel, 0.9));
  draw.AddText(low, packed(theme.ink), text.c_str());
}

LayerNotes markChoices(PanelContext& context, const SceneMarks& marks) {
  LayerNotes notes;
  markOtherChoice(context, marks, notes);
  const SceneFrame frame = context.model.shown().frame();
  const auto selected = context.model.selected_view;
  const auto pose = selected ? poseOfCandidate(frame, *selected) : std::nullopt;
  if (!pose) return notes;
  marks.frustum(viewCamera(frame), *pose, packed(context.theme.accent));
  notes.legend.push_back(
      {Mark::Line, context.theme.accent, 1.0, "selected view " + std::to_string(*selected)});
  return notes;
}

}  // namespace vantage
