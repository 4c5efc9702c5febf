#pragma once

#include <vtkGenericOpenGLRenderWindow.h>

#include "core/gpu/gl_context.h"

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

}  // namespace vantage
