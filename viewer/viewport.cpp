#include <GL/glew.h>
// GLEW comes before everything that includes OpenGL headers.
#include <vtkLightCollection.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLState.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "core/geometry/check.h"
#include "viewer/gl_window.h"
#include "viewer/offscreen_renderer.h"
#include "viewer/viewport.h"
#include "viewer/vtk_messages.h"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kSmallest = 16;
constexpr double kSmallShare = 0.5;
constexpr int kSamples = 4;                                    // what the software driver offers at most
constexpr double kTurnPerHeight_rad = 3.14159265358979323846;  // a drag across the picture turns by half
constexpr double kZoomPerNotch = 1.15;

double secondsSince(Clock::time_point from) {
  return std::chrono::duration<double>(Clock::now() - from).count();
}

}  // namespace

struct Viewport::State {
  GlContext& context;
  Scene& scene;
  vtkSmartPointer<GlWindow> window;
  PictureSize size{640, 400};
  unsigned texture = 0;
  std::uint64_t frames = 0;
  bool dirty = true;    ///< something changed since the last picture
  bool rough = true;    ///< the last picture is a rough one
  bool moving = false;  ///< within kSettle_s after moved_at
  Clock::time_point moved_at = {};
  std::optional<double> full_s = {};  ///< what the last full picture took
  double rough_share = kSmallShare;   ///< resolution of rough pictures
  std::optional<Drag> drag = {};
  Eigen::Vector2d cursor = Eigen::Vector2d::Zero();

  double sinceMove_s() const { return secondsSince(moved_at); }
  bool wantsRough() const { return moving && sinceMove_s() < kSettle_s && full_s.value_or(1.0) > kQuick_s; }
  void touch() {
    moving = true;
    moved_at = Clock::now();
    dirty = true;
  }
  void setEye(const Eye& eye) {
    scene.setEye(eye);
    touch();
  }
  void drawView(bool as_rough);
  void draw(std::span<vtkRenderer* const> wanted);
  void keepPicture();
};

/// Draws these renderers alone. The others stay with the window, so that what they have on the
/// graphics card stays too.
void Viewport::State::draw(std::span<vtkRenderer* const> wanted) {
  vtkRendererCollection* all = window->GetRenderers();
  for (vtkRenderer* renderer : wanted)
    if (!all->IsItemPresent(renderer)) window->AddRenderer(renderer);
  vtkCollectionSimpleIterator at;
  all->InitTraversal(at);
  while (vtkRenderer* renderer = all->GetNextRenderer(at))
    renderer->SetDraw(std::ranges::find(wanted, renderer) != wanted.end());
  for (vtkRenderer* renderer : wanted) {
    renderer->ResetCameraClippingRange();
    // Shaders are shared by renderers and keep the lights of the last one unless these are newer.
    renderer->GetLights()->Modified();
  }
  window->Render();
  all->InitTraversal(at);
  while (vtkRenderer* renderer = all->GetNextRenderer(at)) renderer->DrawOn();  // others may draw them too
}

/// Rough pictures are not smoothed, smaller where even that is slow, and lack the scene's fine parts.
void Viewport::State::drawView(bool as_rough) {
  const auto began = Clock::now();
  const double share = as_rough ? rough_share : 1.0;
  window->SetMultiSamples(as_rough ? 0 : kSamples);
  window->SetSize(std::max(kSmallest, static_cast<int>(std::lround(share * size.width))),
                  std::max(kSmallest, static_cast<int>(std::lround(share * size.height))));
  scene.setRough(as_rough, share);
  vtkRenderer* const view = scene.view();
  draw({&view, 1});
  keepPicture();
  glFinish();
  const double took_s = secondsSince(began);
  if (!as_rough)
    full_s = took_s;
  else if (share == 1.0 && took_s > kQuick_s)
    rough_share = kSmallShare;
  else if (share < 1.0 && took_s < kQuick_s * share * share)
    rough_share = 1.0;
  rough = as_rough;
}

/// Copies the window's picture into the texture.
void Viewport::State::keepPicture() {
  const int* drawn = window->GetSize();
  vtkOpenGLState* gl = window->GetState();
  gl->PushFramebufferBindings();
  vtkOpenGLFramebufferObject* display = window->GetDisplayFramebuffer();
  display->Bind(GL_READ_FRAMEBUFFER);
  display->ActivateReadBuffer(0);
  GLint bound = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  if (!texture) glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, 0, 0, drawn[0], drawn[1], 0);
  glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(bound));
  gl->PopFramebufferBindings();
}

Viewport::Viewport(GlContext& context, Scene& scene)
    : state_(std::make_unique<State>(State{context, scene, makeMemoryWindow(context, kSamples)})) {
  state_->window->AddRenderer(scene.view());
}

Viewport::~Viewport() {
  try {
    state_->context.makeCurrent();
    if (state_->texture) glDeleteTextures(1, &state_->texture);
    state_->window->Finalize();
    while (vtkRenderer* renderer = state_->window->GetRenderers()->GetFirstRenderer())
      state_->window->RemoveRenderer(renderer);
  } catch (const std::exception&) {
    // The context is gone, and its objects with it.
  }
}

void Viewport::resize(int width, int height) {
  const PictureSize wanted{std::clamp(width, kSmallest, kLargestPicture),
                           std::clamp(height, kSmallest, kLargestPicture)};
  if (wanted.width == state_->size.width && wanted.height == state_->size.height) return;
  state_->size = wanted;
  state_->touch();
}

PictureSize Viewport::size() const {
  return state_->size;
}

void Viewport::requestRender() {
  state_->touch();
}

bool Viewport::render() {
  if (nextRender_s() != 0.0) return false;
  state_->context.makeCurrent();
  state_->drawView(state_->wantsRough());
  state_->dirty = false;
  ++state_->frames;
  return true;
}

std::optional<double> Viewport::nextRender_s() const {
  if (state_->dirty) return 0.0;
  if (!state_->rough) return std::nullopt;
  return state_->moving ? std::max(0.0, kSettle_s - state_->sinceMove_s()) : 0.0;
}

unsigned Viewport::texture() const {
  return state_->texture;
}

std::uint64_t Viewport::framesRendered() const {
  return state_->frames;
}

void Viewport::press(Drag drag, const Eigen::Vector2d& at_px) {
  state_->drag = drag;
  state_->cursor = at_px;
}

void Viewport::move(const Eigen::Vector2d& at_px) {
  const Eigen::Vector2d moved = at_px - state_->cursor;
  state_->cursor = at_px;
  if (!state_->drag || moved.isZero()) return;
  const Eye eye = state_->scene.eye();
  const double turn_rad = kTurnPerHeight_rad / state_->size.height;
  switch (*state_->drag) {
    case Drag::Orbit:
      return state_->setEye(orbited(eye, -moved.x() * turn_rad, moved.y() * turn_rad));
    case Drag::Pan:
      return state_->setEye(panned(eye, moved, state_->size));
  }
}

void Viewport::release() {
  state_->drag.reset();
}

bool Viewport::dragging() const {
  return state_->drag.has_value();
}

void Viewport::wheel(double notches, const Eigen::Vector2d& at_px) {
  if (notches == 0.0) return;
  state_->setEye(zoomed(state_->scene.eye(), std::pow(kZoomPerNotch, notches), at_px, state_->size));
}

void Viewport::setMoving(bool moving) {
  state_->moving = moving;
  if (moving) state_->moved_at = Clock::now();
}

bool Viewport::settled() const {
  return !state_->dirty && !state_->rough;
}

RgbImage Viewport::screenshot() {
  state_->scene.setRough(false);
  vtkRenderer* const view = state_->scene.view();
  return picture({&view, 1}, state_->size.width, state_->size.height);
}

RgbImage Viewport::picture(std::span<vtkRenderer* const> renderers, int width, int height) {
  requireInRange("picture width", width, kSmallest, kLargestPicture);
  requireInRange("picture height", height, kSmallest, kLargestPicture);
  state_->context.makeCurrent();
  GlWindow& window = *state_->window;
  window.SetMultiSamples(kSamples);
  window.SetSize(width, height);
  state_->draw(renderers);
  return readPicture(window);
}

}  // namespace vantage
