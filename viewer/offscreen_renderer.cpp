#include "viewer/offscreen_renderer.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkWindowToImageFilter.h>

#include <cstring>
#include <stdexcept>

#include "core/geometry/check.h"
#include "viewer/gl_window.h"
#include "viewer/vtk_messages.h"

namespace vantage {
namespace {

constexpr int kSamples = 4;  // what the software driver offers at most

RgbImage fromVtk(vtkImageData& data) {
  const int* size = data.GetDimensions();
  RgbImage image(size[0], size[1]);
  const std::size_t row = static_cast<std::size_t>(size[0]) * 3;
  const auto* in = static_cast<const std::uint8_t*>(data.GetScalarPointer());
  for (int y = 0; y < size[1]; ++y)
    std::memcpy(image.pixels.data() + row * y, in + row * (size[1] - 1 - y), row);
  return image;
}

}  // namespace

struct OffscreenRenderer::State {
  GlContext& context;
  vtkSmartPointer<GlWindow> window;
};

OffscreenRenderer::OffscreenRenderer(GlContext& context) {
  silenceVtk();
  context.makeCurrent();
  auto window = vtkSmartPointer<GlWindow>::New();
  window->setGlContext(&context);
  window->SetOwnContext(0);
  window->SetMapped(1);
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(kSamples);
  window->SwapBuffersOn();  // off, the display framebuffer stays black
  window->SetFrameBlitModeToNoBlit();
  window->SetReadyForRendering(true);
  state_ = std::make_unique<State>(State{context, window});
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
  vtkNew<vtkWindowToImageFilter> reader;
  reader->SetInput(&window);
  reader->SetInputBufferTypeToRGB();
  reader->ReadFrontBufferOff();
  reader->ShouldRerenderOff();
  reader->Update();
  for (vtkRenderer* renderer : renderers) window.RemoveRenderer(renderer);
  vtkImageData* data = reader->GetOutput();
  if (!data || data->GetNumberOfPoints() != static_cast<vtkIdType>(width) * height) {
    throw std::runtime_error("OpenGL: the picture could not be read back; " + takeVtkMessages());
  }
  return fromVtk(*data);
}

}  // namespace vantage
