#pragma once

#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkSmartPointer.h>

#include "core/gpu/gl_context.h"
#include "viewer/image.h"

namespace vantage {

/// VTK window that draws through a GlContext of ours. Debian's GLEW knows only GLX: under EGL it loads every
/// function and then reports a missing GLX display, which VTK's own class takes for a failure.
class GlWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static GlWindow* New();
  vtkTypeMacro(GlWindow, vtkGenericOpenGLRenderWindow);

  /// Not owned; must outlive the window's Finalize().
  void setGlContext(GlContext* context) { context_ = context; }

  void MakeCurrent() override;
  bool IsCurrent() override { return context_ && context_->isCurrent(); }
  int SupportsOpenGL() override { return 1; }
  vtkTypeBool IsDirect() override { return 1; }

 protected:
  GlWindow() = default;
  void OpenGLInitContext() override;

 private:
  GlContext* context_ = nullptr;
};

/// Makes the context current and a window in it that draws into memory of its own. \param samples of a pixel,
/// 0 = no smoothing
vtkSmartPointer<GlWindow> makeMemoryWindow(GlContext& context, int samples);

/// What the window drew last. \throws std::runtime_error if OpenGL fails.
RgbImage readPicture(GlWindow& window);

}  // namespace vantage
