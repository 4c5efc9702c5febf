#include <GL/glew.h>
// GLEW comes before everything that includes OpenGL headers.
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkWindowToImageFilter.h>

#include <cstring>
#include <stdexcept>

#include "viewer/gl_window.h"
#include "viewer/vtk_messages.h"

namespace vantage {

vtkStandardNewMacro(GlWindow);

void GlWindow::MakeCurrent() {
  if (context_ && !context_->isCurrent()) context_->makeCurrent();
}

void GlWindow::OpenGLInitContext() {
  if (this->Initialized) return;
  this->ContextCreationTime.Modified();
  glewExperimental = GL_TRUE;
  const GLenum result = glewInit();
  if (result != GLEW_OK && result != GLEW_ERROR_NO_GLX_DISPLAY) {
    vtkErrorMacro("GLEW: " << glewGetErrorString(result));
    return;
  }
  if (!GLEW_VERSION_3_2) {
    vtkErrorMacro("OpenGL 3.2 is needed");
    return;
  }
  this->GlewInitValid = true;
  this->Initialized = true;
  GLfloat range[2] = {1.0f, 1.0f};
  glGetFloatv(GL_ALIASED_LINE_WIDTH_RANGE, range);
  this->MaximumHardwareLineWidth = range[1];
}

vtkSmartPointer<GlWindow> makeMemoryWindow(GlContext& context, int samples) {
  silenceVtk();
  context.makeCurrent();
  auto window = vtkSmartPointer<GlWindow>::New();
  window->setGlContext(&context);
  window->SetOwnContext(0);
  window->SetMapped(1);
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(samples);
  window->SwapBuffersOn();  // off, the display framebuffer stays black
  window->SetFrameBlitModeToNoBlit();
  window->SetReadyForRendering(true);
  return window;
}

RgbImage readPicture(GlWindow& window) {
  vtkNew<vtkWindowToImageFilter> reader;
  reader->SetInput(&window);
  reader->SetInputBufferTypeToRGB();
  reader->ReadFrontBufferOff();
  reader->ShouldRerenderOff();
  reader->Update();
  vtkImageData* data = reader->GetOutput();
  const int* size = window.GetSize();
  if (!data || data->GetNumberOfPoints() != static_cast<vtkIdType>(size[0]) * size[1])
    throw std::runtime_error("OpenGL: the picture could not be read back; " + takeVtkMessages());
  RgbImage image(size[0], size[1]);
  const std::size_t row = static_cast<std::size_t>(size[0]) * 3;
  const auto* in = static_cast<const std::uint8_t*>(data->GetScalarPointer());
  for (int y = 0; y < size[1]; ++y)
    std::memcpy(image.pixels.data() + row * y, in + row * (size[1] - 1 - y), row);
  return image;
}

}  // namespace vantage
