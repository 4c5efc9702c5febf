#include "viewer/scene.h"

#include <vtkCamera.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "viewer/layers/layer.h"
#include "viewer/legend.h"
#include "viewer/page.h"
#include "viewer/vtk_messages.h"

namespace vantage {
namespace {

/// Sizes of a full page, in pixels for a picture of 1280 x 800.
constexpr double kColumn = 286.0, kBand = 100.0, kMargin = 18.0;

double unitOf(int width, int height) {
  return std::min(width / 1280.0, height / 800.0);
}

/// Direction from the focus to the eye.
Eigen::Vector3d towardEye(const CameraView& view) {
  return {std::cos(view.elevation_rad) * std::cos(view.azimuth_rad),
          std::cos(view.elevation_rad) * std::sin(view.azimuth_rad), std::sin(view.elevation_rad)};
}

void writeCaption(Page& page, const Caption& caption, double unit) {
  const double x = kMargin * unit;
  TextStyle title;
  title.size_px = static_cast<int>(std::lround(24.0 * unit));
  title.bold = true;
  page.text(x, 13.0 * unit, caption.title, title);
  TextStyle context;
  context.size_px = static_cast<int>(std::lround(15.0 * unit));
  context.color = palette::kFaintInk;
  context.horizontal = HorizontalAlign::Right;
  page.text(page.width() - x, 19.0 * unit, caption.context, context);
  TextStyle figures;
  figures.size_px = static_cast<int>(std::lround(16.0 * unit));
  page.paragraph(x, 49.0 * unit, page.width() - 2 * x, caption.figures, figures);
}

/// One light beside the eye and a weak one from above: faces of a box differ in lightness.
void addLights(vtkRenderer& renderer) {
  renderer.AutomaticLightCreationOff();
  vtkNew<vtkLight> head;
  head->SetLightTypeToCameraLight();
  head->SetPosition(-0.15, 0.25, 1.0);
  head->SetIntensity(0.72);
  renderer.AddLight(head);
  vtkNew<vtkLight> sky;
  sky->SetLightTypeToSceneLight();
  sky->SetPositional(false);
  sky->SetPosition(0.0, 0.0, 1.0);
  sky->SetFocalPoint(0.0, 0.0, 0.0);
  sky->SetIntensity(0.25);
  renderer.AddLight(sky);
}

}  // namespace

Eye fitEye(const CameraView& view, std::span<const Eigen::Vector3d> points, double width_to_height) {
  view.validate();
  if (points.empty()) throw std::invalid_argument("fitEye: there is nothing to be seen");
  Box box;
  for (const Eigen::Vector3d& p : points) box.extend(p);
  const Eigen::Vector3d back = towardEye(view);
  const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(back).normalized(), up = back.cross(right);
  const double tan_v = std::tan(view.fov_rad / 2), tan_h = tan_v * width_to_height;
  Eigen::Vector3d focus = box.center();
  double distance = std::max(1e-3, box.diagonal().norm()) / tan_v;
  for (int round = 0; round < 40; ++round) {
    double left = 1e9, rightmost = -1e9, bottom = 1e9, top = -1e9;
    for (const Eigen::Vector3d& point : points) {
      const Eigen::Vector3d p = point - focus;
      const double depth = distance - p.dot(back);
      const double x = p.dot(right) / depth / tan_h, y = p.dot(up) / depth / tan_v;
      left = std::min(left, x), rightmost = std::max(rightmost, x);
      bottom = std::min(bottom, y), top = std::max(top, y);
    }
    focus +=
        right * ((left + rightmost) / 2 * distance * tan_h) + up * ((bottom + top) / 2 * distance * tan_v);
    distance *= std::clamp(std::max(rightmost - left, top - bottom) / 2, 0.5, 2.0);
  }
  constexpr double kMargin = 1.02;  // nothing touches the edge
  return {focus + back * (kMargin * distance / view.zoom), focus};
}

struct Scene::State {
  std::optional<SceneFrame> frame;
  LayerStyle style;
  std::array<std::optional<LayerContent>, kLayerCount> built;
  LayerSet shown;
  vtkSmartPointer<vtkRenderer> view;
  std::unique_ptr<Page> page;

  void placeCamera(const CameraView& camera, double width_to_height) const;
};

void Scene::State::placeCamera(const CameraView& camera, double width_to_height) const {
  const bool on_object = camera.object && onOctree(*frame) && !frame->header.octree->object_box.isEmpty();
  const Box& workspace = on_object ? frame->header.octree->object_box : frame->header.workspace;
  const Box box = workspace.isEmpty() ? Box(Eigen::Vector3d(-1, -1, 0), Eigen::Vector3d(1, 1, 1)) : workspace;
  Box seen = box;
  const bool known_scene = frame->truth && !frame->truth->empty() && !on_object;
  seen.min().y() -= camera.front_m.value_or(known_scene ? 0.2 : 0.0);
  seen.max().z() = seen.min().z() + camera.height_share.value_or(known_scene ? 0.8 : 1.0) * box.sizes().z();
  std::vector<Eigen::Vector3d> points;
  for (int c = 0; c < 8; ++c) points.push_back(seen.corner(static_cast<Box::CornerType>(c)));
  for (int i = 0; i < kLayerCount; ++i) {
    if (!shown.has(static_cast<Layer>(i)) || !built[i]) continue;
    points.insert(points.end(), built[i]->must_see.begin(), built[i]->must_see.end());
  }
  const Eye eye = fitEye(camera, points, width_to_height);
  vtkCamera* target = view->GetActiveCamera();
  target->SetPosition(eye.position.data());
  target->SetFocalPoint(eye.focus.data());
  target->SetViewUp(0.0, 0.0, 1.0);
  target->SetViewAngle(camera.fov_rad * 180.0 / std::numbers::pi);
  view->ResetCameraClippingRange();
}

Scene::Scene() : state_(std::make_unique<State>()) {
  silenceVtk();
}
Scene::~Scene() = default;

void Scene::setFrame(const SceneFrame& frame) {
  state_->frame.emplace(frame);
  state_->built = {};
}

void Scene::show(const ViewSettings& settings, const Caption& caption, PageStyle page_style, int width,
                 int height) {
  if (!state_->frame) throw std::logic_error("Scene::show() before setFrame()");
  settings.style.validate();
  settings.camera.validate();
  const double unit = unitOf(width, height);
  LayerStyle style = settings.style;
  style.label_px *= unit;
  style.line_scale *= std::max(0.5, unit);
  if (style != state_->style) state_->built = {};
  state_->style = style;
  state_->shown = settings.layers;

  auto view = vtkSmartPointer<vtkRenderer>::New();
  view->SetBackground(palette::kPaper.r, palette::kPaper.g, palette::kPaper.b);
  addLights(*view);
  for (int i = 0; i < kLayerCount; ++i) {
    const Layer layer = static_cast<Layer>(i);
    if (!settings.layers.has(layer)) continue;
    auto& built = state_->built[i];
    if (!built) built = buildLayer(layer, *state_->frame, style);
    for (const auto& prop : built->props) view->AddViewProp(prop);
  }
  state_->view = view;
  state_->page = std::make_unique<Page>(width, height);
  double view_width = width, view_height = height;
  if (page_style == PageStyle::Full) {
    view_width = width - kColumn * unit;
    view_height = height - kBand * unit;
    writeCaption(*state_->page, caption, unit);
    const PageArea column{view_width + 6.0 * unit, kBand * unit + 8.0 * unit,
                          (kColumn - 6.0 - kMargin) * unit, view_height};
    drawLegend(*state_->page, column, shownNotes(), unit);
  }
  view->SetViewport(0.0, 0.0, view_width / width, view_height / height);
  state_->placeCamera(settings.camera, view_width / view_height);
}

std::vector<vtkRenderer*> Scene::renderers() const {
  if (!state_->view) return {};
  return {state_->page->renderer(), state_->view};
}

const LayerContent* Scene::content(Layer layer) const {
  const auto& built = state_->built[static_cast<std::size_t>(layer)];
  return built ? &*built : nullptr;
}

std::vector<const LayerNotes*> Scene::shownNotes() const {
  std::vector<const LayerNotes*> contents;
  for (int i = 0; i < kLayerCount; ++i) {
    const Layer layer = static_cast<Layer>(i);
    if (state_->shown.has(layer) && content(layer)) contents.push_back(content(layer));
  }
  return contents;
}

}  // namespace vantage
