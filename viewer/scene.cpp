#include "viewer/scene.h"

#include <vtkCamera.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "viewer/layers/layer.h"
#include "viewer/layers/layer_inputs.h"
#include "viewer/layers/prop_look.h"
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

/// What the camera is focused on.
struct Subject {
  Box box;
  bool workspace = false;  ///< it is the whole of it
};

Subject subjectOf(const SceneFrame& frame, CameraFocus focus) {
  if (focus == CameraFocus::Object && onOctree(frame) && !frame.header.octree->object_box.isEmpty())
    return {frame.header.octree->object_box};
  const SegmentSearch* search = focus == CameraFocus::Segment ? shownSearch(frame.record) : nullptr;
  if (search && search->sphere.radius > 0.0) {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(search->sphere.radius);
    return {Box(search->sphere.center - half, search->sphere.center + half)};
  }
  if (!frame.header.workspace.isEmpty()) return {frame.header.workspace, true};
  return {Box(Eigen::Vector3d(-1, -1, 0), Eigen::Vector3d(1, 1, 1)), true};
}

/// What must be seen of a frame and the layers that are shown.
std::vector<Eigen::Vector3d> mustSee(const SceneFrame& frame, const CameraView& camera,
                                     const std::vector<const LayerContent*>& shown) {
  const Subject subject = subjectOf(frame, camera.focus);
  Box seen = subject.box;
  const bool known_scene = subject.workspace && frame.truth && !frame.truth->empty();
  seen.min().y() -= camera.front_m.value_or(known_scene ? 0.2 : 0.0);
  seen.max().z() =
      seen.min().z() + camera.height_share.value_or(known_scene ? 0.8 : 1.0) * subject.box.sizes().z();
  std::vector<Eigen::Vector3d> points;
  for (int c = 0; c < 8; ++c) points.push_back(seen.corner(static_cast<Box::CornerType>(c)));
  for (const LayerContent* content : shown)
    points.insert(points.end(), content->must_see.begin(), content->must_see.end());
  return points;
}

Eye eyeFor(const SceneFrame& frame, const CameraView& camera, const std::vector<const LayerContent*>& shown,
           double width_to_height) {
  camera.validate();
  return camera.eye ? *camera.eye : fitEye(camera, mustSee(frame, camera, shown), width_to_height);
}

void moveCamera(vtkRenderer& renderer, const Eye& eye) {
  vtkCamera* camera = renderer.GetActiveCamera();
  camera->SetPosition(eye.position.data());
  camera->SetFocalPoint(eye.focus.data());
  camera->SetViewUp(eye.up.data());
  camera->SetViewAngle(eye.fov_rad * 180.0 / std::numbers::pi);
  renderer.ResetCameraClippingRange();
}

vtkSmartPointer<vtkRenderer> makeRenderer(Rgb background) {
  auto renderer = vtkSmartPointer<vtkRenderer>::New();
  renderer->SetBackground(background.r, background.g, background.b);
  addLights(*renderer);
  return renderer;
}

/// Puts the props into the renderer in this order. Those that leave keep what they have on the graphics card,
/// so that a layer can be switched on again at no cost.
void setProps(vtkRenderer& renderer, const std::vector<const LayerContent*>& contents) {
  renderer.GetViewProps()->RemoveAllItems();
  for (const LayerContent* content : contents)
    for (const auto& prop : content->props) renderer.AddViewProp(prop);
}

}  // namespace

/// A layer as it was built, and from what.
struct BuiltLayer {
  LayerContent content;
  PropLooks looks;
  LayerStyle style;
  SceneTheme theme;
};

struct Scene::State {
  std::optional<SceneFrame> frame;
  std::optional<LayerInputs> inputs;  ///< of the frame
  std::array<std::optional<BuiltLayer>, kLayerCount> built;
  std::array<int, kLayerCount> times_built = {};
  LayerSet shown;
  ClipPlanes clip;
  // A picture on a page.
  vtkSmartPointer<vtkRenderer> page_view;
  std::unique_ptr<Page> page;
  // A window.
  vtkSmartPointer<vtkRenderer> view = makeRenderer(palette::kPaper);
  vtkSmartPointer<vtkRenderer> inset;
  ViewSettings settings;
  SceneTheme theme;
  double scale = 1.0;
  Eye eye;
  bool eye_placed = false;

  void requireFrame(const char* caller) const;
  bool rough = false;
  double share = 1.0;  ///< of the resolution

  void adjust(Layer layer, const ViewSettings& wanted) const;
  void build(Layer layer, const ViewSettings& wanted, const LayerStyle& base, const SceneTheme& wanted_theme);
  void prepare(const LayerSet& layers, const ViewSettings& wanted, const LayerStyle& base,
               const SceneTheme& wanted_theme);
  std::vector<const LayerContent*> contents(const LayerSet& layers) const;
  LayerStyle windowStyle() const;
};

void Scene::State::requireFrame(const char* caller) const {
  if (!frame) throw std::logic_error(std::string("Scene::") + caller + "() before setFrame()");
}

void Scene::State::adjust(Layer layer, const ViewSettings& wanted) const {
  const auto& layer_built = built[static_cast<std::size_t>(layer)];
  if (!layer_built) return;
  LayerLook look = wanted.look(layer);
  look.size *= share;
  layer_built->looks.apply(look, isClipped(layer) ? &clip : nullptr, rough);
}

/// Builds a layer unless it stands, and adjusts it.
void Scene::State::build(Layer layer, const ViewSettings& wanted, const LayerStyle& base,
                         const SceneTheme& wanted_theme) {
  const auto i = static_cast<std::size_t>(layer);
  const LayerLook& look = wanted.looks[i];
  LayerStyle style = base;
  if (look.color_map) style.color_map = look.color_map;
  if (!built[i] || !sameStyle(layer, style, built[i]->style) || built[i]->theme != wanted_theme) {
    built[i].reset();
    LayerContent content = buildLayer(layer, *frame, style);
    applyTheme(content, wanted_theme);
    PropLooks looks(content);
    built[i].emplace(BuiltLayer{std::move(content), std::move(looks), style, wanted_theme});
    ++times_built[i];
  }
  adjust(layer, wanted);
}

/// Builds and adjusts all of the layers; the first error is reported after the last layer.
void Scene::State::prepare(const LayerSet& layers, const ViewSettings& wanted, const LayerStyle& base,
                           const SceneTheme& wanted_theme) {
  std::exception_ptr error;
  clip.set(wanted.clip);
  for (int i = 0; i < kLayerCount; ++i) {
    if (!layers.has(static_cast<Layer>(i))) continue;
    try {
      build(static_cast<Layer>(i), wanted, base, wanted_theme);
    } catch (...) {
      if (!error) error = std::current_exception();
    }
  }
  if (error) std::rethrow_exception(error);
}

std::vector<const LayerContent*> Scene::State::contents(const LayerSet& layers) const {
  std::vector<const LayerContent*> all;
  for (int i = 0; i < kLayerCount; ++i)
    if (layers.has(static_cast<Layer>(i)) && built[i]) all.push_back(&built[i]->content);
  return all;
}

LayerStyle Scene::State::windowStyle() const {
  LayerStyle style = settings.style;
  style.label_px *= scale;
  style.line_scale *= scale;
  return style;
}

Scene::Scene() {
  silenceVtk();
  state_ = std::make_unique<State>();
}
Scene::~Scene() = default;

void Scene::setFrame(const SceneFrame& frame) {
  LayerInputs inputs(frame);
  for (int i = 0; i < kLayerCount; ++i) {
    if (!state_->inputs || !stillStands(static_cast<Layer>(i), *state_->inputs, inputs))
      state_->built[i].reset();
  }
  state_->frame.emplace(frame);
  state_->inputs.emplace(std::move(inputs));
}

void Scene::forget() {
  state_->built = {};
  state_->frame.reset();
  state_->inputs.reset();
  setProps(*state_->view, {});
  if (state_->inset) setProps(*state_->inset, {});
  state_->page_view = nullptr;
  state_->page.reset();
}

void Scene::show(const ViewSettings& settings, const Caption& caption, PageStyle page_style, int width,
                 int height) {
  state_->requireFrame("show");
  settings.validate();
  const double unit = unitOf(width, height);
  LayerStyle style = settings.style;
  style.label_px *= unit;
  style.line_scale *= std::max(0.5, unit);
  state_->shown = settings.layers;
  state_->rough = false;
  state_->share = 1.0;
  state_->prepare(settings.layers, settings, style, {});

  state_->page_view = makeRenderer(palette::kPaper);
  setProps(*state_->page_view, state_->contents(settings.layers));
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
  state_->page_view->SetViewport(0.0, 0.0, view_width / width, view_height / height);
  moveCamera(*state_->page_view, eyeFor(*state_->frame, settings.camera, state_->contents(settings.layers),
                                        view_width / view_height));
}

std::vector<vtkRenderer*> Scene::renderers() const {
  if (!state_->page_view) return {};
  return {state_->page->renderer(), state_->page_view};
}

void Scene::arrange(const ViewSettings& settings, const SceneTheme& theme, double scale) {
  state_->requireFrame("arrange");
  settings.validate();
  state_->settings = settings;
  state_->theme = theme;
  state_->scale = scale;
  state_->shown = settings.layers;
  state_->view->SetBackground(theme.background.r, theme.background.g, theme.background.b);
  std::exception_ptr error;
  try {
    state_->prepare(settings.layers, settings, state_->windowStyle(), theme);
  } catch (...) {
    error = std::current_exception();
  }
  setProps(*state_->view, state_->contents(settings.layers));
  if (!state_->eye_placed) placeEye(settings.camera, 1.6);
  if (error) std::rethrow_exception(error);
}

vtkRenderer* Scene::view() const {
  return state_->view;
}

Eye Scene::eye() const {
  return state_->eye;
}

void Scene::setEye(const Eye& eye) {
  state_->eye = eye;
  state_->eye_placed = true;
  moveCamera(*state_->view, eye);
}

void Scene::placeEye(const CameraView& camera, double width_to_height) {
  state_->requireFrame("placeEye");
  setEye(eyeFor(*state_->frame, camera, state_->contents(state_->shown), width_to_height));
}

void Scene::setRough(bool rough, double share) {
  if (rough == state_->rough && share == state_->share) return;
  state_->rough = rough;
  state_->share = share;
  for (int i = 0; i < kLayerCount; ++i)
    if (state_->settings.layers.has(static_cast<Layer>(i)))
      state_->adjust(static_cast<Layer>(i), state_->settings);
}

vtkRenderer* Scene::inset(const Eye& eye, const LayerSet& layers) {
  state_->requireFrame("inset");
  setRough(false);
  const Rgb& ground = state_->theme.background;
  if (!state_->inset) state_->inset = makeRenderer(ground);
  state_->inset->SetBackground(ground.r, ground.g, ground.b);
  state_->prepare(layers, state_->settings, state_->windowStyle(), state_->theme);
  setProps(*state_->inset, state_->contents(layers));
  moveCamera(*state_->inset, eye);
  return state_->inset;
}

const LayerContent* Scene::content(Layer layer) const {
  const auto& built = state_->built[static_cast<std::size_t>(layer)];
  return built ? &built->content : nullptr;
}

bool Scene::hasContent(Layer layer) const {
  const LayerContent* built = content(layer);
  return built && (!built->props.empty() || built->inset);
}

std::vector<const LayerNotes*> Scene::shownNotes() const {
  const std::vector<const LayerContent*> contents = state_->contents(state_->shown);
  return {contents.begin(), contents.end()};
}

int Scene::timesBuilt(Layer layer) const {
  return state_->times_built[static_cast<std::size_t>(layer)];
}

}  // namespace vantage
