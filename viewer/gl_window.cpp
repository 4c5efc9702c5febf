#include <GL/glew.h>
// GLEW comes before everything that includes OpenGL headers.
#include <vtkObjectFactory.h>

#include "viewer/gl_window.h"

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

}  // namespace vantage
