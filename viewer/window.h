#pragma once

#include <stdexcept>
#include <stop_token>
#include <string>

#include "viewer/inspector.h"

namespace vantage {

/// No window can be opened; what() is one line that names what helps. The executable exits with 3.
class WindowUnavailable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct WindowOptions {
  std::string title = "Vantage";
  int width = 1280, height = 800;  ///< of the window, as if its monitor had pixels of the usual size
  double quit_after_s = 0.0;       ///< > 0: closes by itself, for tests
  std::stop_token stop;            ///< asked for: closes as by a click, within half a second
};

/// The real window of the inspector: GLFW on X11 or XWayland.
class Window {
 public:
  /// \throws WindowUnavailable without a display or OpenGL 3.2.
  explicit Window(const WindowOptions& options);
  ~Window();
  Window(const Window&) = delete;

  GlContext& context();
  /// Draws a frame soon; any thread.
  void wake();
  void copy(const std::string& utf8);
  /// Size of the window, in the units of WindowOptions.
  int width() const;
  int height() const;

  /// Shows the inspector until it or its window is closed. An idle window sleeps.
  void show(Inspector& inspector);

  struct State;

 private:
  std::unique_ptr<State> state_;
};

}  // namespace vantage
