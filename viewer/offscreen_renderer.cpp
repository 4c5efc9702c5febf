#include "viewer/offscreen_renderer.h"

#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <exception>

#include "core/geometry/check.h"
#include "viewer/gl_window.h"

namespace vantage {
namespace {

constexpr int kSamples = 4;  // what the software driver offers at most

}  // namespace

struct OffscreenRenderer::State {
  GlContext& context;
  vtkSmartPointer<GlWindow> window;
};

OffscreenRenderer::OffscreenRenderer(GlContext& context) {
  state_ = std::make_unique<State>(State{context, makeMemoryWindow(context, kSamples)});
}

OffscreenRenderer::~OffscreenRenderer() {
  try {
    state_->context.makeCurrent();
    state_->window->Finalize();
  } catch (const std::exception&) {
    // The context is gone, and its objects with it.
  }
}

RgbImage OffscreenRenderer::render(std::span<vtkRenderer* const> renderers, int width, int height) {
  requireInRange("picture width", width, 16, kLargestPicture);
  requireInRange("picture height", height, 16, kLargestPicture);
  state_->context.makeCurrent();
  GlWindow& window = *state_->window;
  window.SetSize(width, height);
  for (vtkRenderer* renderer : renderers) window.AddRenderer(renderer);
  window.Render();
  RgbImage image = readPicture(window);
  for (vtkRenderer* renderer : renderers) window.RemoveRenderer(renderer);
  return image;
}

}  // namespace vantage
