#include "viewer/panels/view_panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "viewer/captions.h"
#include "viewer/panels/plot.h"
#include "viewer/panels/scene_marks.h"
#include "viewer/pick_text.h"
#include "viewer/ui_host.h"

namespace vantage {
namespace {

SceneTheme sceneTheme(const Theme& theme) {
  return {theme.paper, theme.ink};
}

ImTextureID textureId(unsigned handle) {
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(handle));
}

/// To the millimetre.
std::string exactLength(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, metres < 1.0 ? "%.1f cm" : "%.3f m",
                metres < 1.0 ? 100.0 * metres : metres);
  return text;
}

}  // namespace

ViewPanel::ViewPanel(GlContext& context, Scene& scene, std::string name)
    : name_(std::move(name)), context_(context), scene_(scene), viewport_(context, scene) {}

ViewPanel::~ViewPanel() {
  try {
    context_.makeCurrent();  // the insets' textures are in it
  } catch (const std::exception&) {
    // The context is gone, and its objects with it.
  }
}

void ViewPanel::update(PanelContext& context, ViewSettings wanted) {
  const InspectorModel& model = context.model;
  const StepData& shown = model.shown();
  if (shown.empty()) {
    if (has_frame_) scene_.forget();
    has_frame_ = false;
    data_ = {};
    hovered_.reset();
    return;
  }
  if (const auto view = model.explainedView()) wanted.style.view_id = static_cast<int>(*view);
  const bool new_data = !has_frame_ || revision_ != model.revision() + model.whatIf().revision();
  const double scale = pixel_scale_ * context.preferences.font_scale;
  const bool other_look = arranged_paper_ != context.theme.paper || scale != arranged_scale_;
  if (!new_data && !other_look && wanted == arranged_) return;
  ++insets_revision_;
  if (new_data) {
    const StepData before = std::exchange(data_, shown);
    scene_.setFrame(data_.frame());
    hovered_.reset();
    hovered_at_.setConstant(-1.0);
  }
  revision_ = model.revision() + model.whatIf().revision();
  has_frame_ = true;
  arranged_ = wanted;
  arranged_paper_ = context.theme.paper;
  arranged_scale_ = scale;
  problem_.clear();
  try {
    scene_.arrange(wanted, sceneTheme(context.theme), scale);
  } catch (const std::exception& e) {
    problem_ = e.what();
  }
  if (!eye_placed_) {
    eye_placed_ = true;
    if (context.preferences.eye)
      scene_.setEye(*context.preferences.eye);
    else
      resetEye(context);
  }
  viewport_.requestRender();
}

void ViewPanel::resetEye(PanelContext& context) {
  if (!has_frame_) return;
  scene_.placeEye(context.preferences.view.camera, viewport_.size().shape());
  viewport_.requestRender();
}

void ViewPanel::lookAlong(PanelContext& context, int side) {
  if (!has_frame_) return;
  CameraView camera = context.preferences.view.camera;
  constexpr double kAlmostUp_rad = 1.54;
  camera.azimuth_rad = side == 1 ? 0.0 : -std::numbers::pi / 2;
  camera.elevation_rad = side == 2 ? kAlmostUp_rad : 0.0;
  scene_.placeEye(camera, viewport_.size().shape());
  viewport_.requestRender();
}

void ViewPanel::setEye(const Eye& eye) {
  scene_.setEye(eye);
  eye_placed_ = true;
  viewport_.requestRender();
}

void ViewPanel::follow(const ViewPanel& other) {
  if (!has_frame_) return;
  setEye(other.scene_.eye());
  viewport_.setMoving(other.viewport_.dragging() || !other.viewport_.settled());
}

void ViewPanel::lookThroughView(PanelContext& context) {
  const auto view = context.model.explainedView();
  if (!view || !has_frame_) return;
  const SceneFrame frame = context.model.shown().frame();
  const auto pose = poseOfCandidate(frame, *view);
  if (!pose) return;
  Eye eye = eyeOfView(viewCamera(frame), *pose, 0.8);
  constexpr double kBeforeThePath_m = 0.04;  // the path ends where the view is, and would fill the picture
  eye.position += kBeforeThePath_m * (eye.focus - eye.position).normalized();
  setEye(eye);
}

void ViewPanel::orbitBy(double left_rad, double up_rad) {
  scene_.setEye(orbited(scene_.eye(), left_rad, up_rad));
  viewport_.requestRender();
}

void ViewPanel::zoomBy(double factor) {
  const PictureSize size = viewport_.size();
  scene_.setEye(zoomed(scene_.eye(), factor, {size.width / 2.0, size.height / 2.0}, size));
  viewport_.requestRender();
}

std::optional<double> ViewPanel::nextRender_s() const {
  return has_frame_ ? viewport_.nextRender_s() : std::nullopt;
}

bool ViewPanel::draw(PanelContext& context, const ViewSettings& settings, double pixel_scale) {
  pixel_scale_ = pixel_scale;
  const ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const ImVec2 size{std::max(32.0f, room.x), std::max(32.0f, room.y)};
  viewport_.resize(static_cast<int>(std::lround(size.x * pixel_scale)),
                   static_cast<int>(std::lround(size.y * pixel_scale)));
  update(context, settings);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 end{at.x + size.x, at.y + size.y};
  if (has_frame_) {
    viewport_.render();
    draw.AddImage(textureId(viewport_.texture()), at, end, {0.0f, 1.0f}, {1.0f, 0.0f});
  } else {
    draw.AddRectFilled(at, end, packed(context.theme.paper));
  }
  ImGui::InvisibleButton("view", size,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  context.widgets.note(name_);
  const bool used = ImGui::IsItemActive();
  if (measuring_ && !ImGui::GetIO().WantTextInput &&
      ImGui::IsKeyPressed(static_cast<int>(Key::Escape), false))
    toggleMeasuring();
  if (has_frame_) {
    mouse(context, at.x, at.y);
    const LayerNotes notes = marks(context, at.x, at.y);
    const ViewArea area{name_, at.x, at.y, end.x, end.y};
    const float legend = legendOverlay(context, area, notes);
    try {
      insets_.draw(context, viewport_, area, area.width() - legend, pixel_scale_, insets_revision_);
    } catch (const std::exception& e) {
      problem_ = e.what();
    }
  }
  if (!problem_.empty())
    draw.AddText({at.x + 12.0f, end.y - 2 * ImGui::GetFontSize()}, packed(context.theme.warning),
                 problem_.c_str());
  return used;
}

void ViewPanel::mouse(PanelContext& context, double left, double top) {
  const ImGuiIO& io = ImGui::GetIO();
  context.preferences.eye = scene_.eye();
  if (!ImGui::IsMousePosValid(&io.MousePos)) {  // the window lost the mouse, in a drag perhaps
    viewport_.release();
    hovered_.reset();
    return;
  }
  const Eigen::Vector2d at_px = pixel_scale_ * Eigen::Vector2d(io.MousePos.x - left, io.MousePos.y - top);
  const bool hovered = ImGui::IsItemHovered() && !insets_.cover(io.MousePos.x, io.MousePos.y);
  if (hovered && !viewport_.dragging()) {
    if (ImGui::IsMouseClicked(0)) viewport_.press(io.KeyShift ? Drag::Pan : Drag::Orbit, at_px);
    if (ImGui::IsMouseClicked(1) || ImGui::IsMouseClicked(2)) viewport_.press(Drag::Pan, at_px);
    if (ImGui::IsMouseClicked(0)) pressed_at_ = at_px;
  }
  if (viewport_.dragging()) {
    viewport_.move(at_px);
    if (!ImGui::IsMouseDown(0) && !ImGui::IsMouseDown(1) && !ImGui::IsMouseDown(2)) viewport_.release();
  } else if (hovered) {
    hover(context, at_px);
  } else {
    hovered_.reset();
  }
  constexpr double kStill_px = 4.0;
  const bool clicked = ImGui::IsMouseReleased(0) && (at_px - pressed_at_).norm() <= kStill_px;
  if (hovered && clicked) {
    hover(context, at_px);
    click(context);
  }
  if (hovered && ImGui::IsMouseDoubleClicked(0) && hovered_) lookAt(hovered_->p_world);
  if (hovered && io.MouseWheel != 0.0f) viewport_.wheel(io.MouseWheel, at_px);
  context.preferences.eye = scene_.eye();
}

void ViewPanel::hover(PanelContext& context, const Eigen::Vector2d& at_px) {
  const StepData& step = context.model.shown();
  if (at_px != hovered_at_ || viewport_.nextRender_s()) {
    hovered_at_ = at_px;
    hovered_ = picker_.at(step.frame(), arranged_, scene_.eye(), at_px, viewport_.size());
  }
  if (!hovered_) return;
  const std::string text = textOf(*hovered_, step, context.candidates.table.rows());
  ImGui::BeginTooltip();
  ImGui::TextUnformatted(text.c_str());
  ImGui::EndTooltip();
  context.widgets.note(name_ + "/hover");
}

void ViewPanel::click(PanelContext& context) {
  if (!hovered_) {
    if (!measuring_) context.model.selected_view.reset();
    return;
  }
  if (measuring_) {
    if (measured_.size() == 2) measured_.clear();
    measured_.push_back(hovered_->p_world);
  } else if (hovered_->kind == PickedKind::Frustum) {
    context.model.selected_view = hovered_->id;
  }
}

void ViewPanel::toggleMeasuring() {
  measuring_ = !measuring_;
  measured_.clear();
}

void ViewPanel::lookAt(const Eigen::Vector3d& p_world) {
  Eye eye = scene_.eye();
  eye.position += p_world - eye.focus;
  eye.focus = p_world;
  setEye(eye);
}

/// Choices, and the distance that is measured. \return what stands for what
LayerNotes ViewPanel::marks(PanelContext& context, double left, double top) {
  const SceneMarks marks{
      *ImGui::GetWindowDrawList(), scene_.eye(), viewport_.size(), left, top, pixel_scale_};
  const Theme& theme = context.theme;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  marks.draw.PushClipRect(low, high, true);
  const LayerNotes notes = markChoices(context, marks);
  for (const Eigen::Vector3d& end : measured_)
    if (const auto at = marks.at(end)) marks.draw.AddCircleFilled(*at, 4.0f, packed(theme.chosen));
  if (measured_.size() == 2) {
    marks.line(measured_[0], measured_[1], packed(theme.chosen), 2.0f);
    if (const auto from = marks.at(measured_[0]), to = marks.at(measured_[1]); from && to)
      context.widgets.note(name_ + "/measured", {from->x, from->y, to->x, to->y, true});
    marks.text(0.5 * (measured_[0] + measured_[1]), exactLength((measured_[1] - measured_[0]).norm()), theme);
  } else if (measuring_) {
    constexpr float kBelowTitle = 40.0f;
    marks.draw.AddText({low.x + 12.0f, low.y + kBelowTitle}, packed(theme.accent),
                       measured_.empty() ? "measuring: click the first point" : "click the second point");
  }
  marks.draw.PopClipRect();
  return notes;
}

}  // namespace vantage
