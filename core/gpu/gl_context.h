#pragma once

#include <string>

namespace vantage {

/// An OpenGL context that somebody can make current on the calling thread. Contexts without a display
/// (EglContext) and contexts of windows look alike to whoever renders.
class GlContext {
 public:
  virtual ~GlContext() = default;
  /// \throws std::runtime_error if the context is lost.
  virtual void makeCurrent() = 0;
  virtual bool isCurrent() const = 0;
  /// One line for `doctor` and logs: platform, versions, renderer.
  virtual std::string describe() const = 0;
};

}  // namespace vantage
