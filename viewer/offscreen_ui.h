#pragma once

#include <memory>
#include <string>

#include "core/gpu/gl_context.h"
#include "viewer/image.h"
#include "viewer/inspector.h"
#include "viewer/keys.h"

namespace vantage {

/// The inspector without a window: the same frames drawn into memory, driven by synthetic input. Tests,
/// benchmarks and pictures of the program use it.
class OffscreenUi {
 public:
  /// \param context must outlive it; used on this thread only
  OffscreenUi(GlContext& context, Inspector& inspector, int width, int height);
  ~OffscreenUi();
  OffscreenUi(const OffscreenUi&) = delete;

  /// One frame; `elapsed_s` is what the program believes has passed since the last one.
  void frame(double elapsed_s = 1.0 / 60.0);
  /// Frames until nothing is loading, computing or to be drawn again. \throws std::runtime_error after
  /// `limit_s` seconds of wall clock.
  void settle(double limit_s = 60.0);

  void moveMouse(double x, double y);
  void pressMouse(int button = 0);
  void releaseMouse(int button = 0);
  void wheel(double clicks);
  /// Down and up again, with a frame for each.
  void press(const Shortcut& keys);
  /// Down until it is released, with a frame: keys that are held repeat while time passes.
  void hold(const Shortcut& keys);
  void release(const Shortcut& keys);
  void type(const std::string& utf8);

  // By name (Widgets). Each scrolls the widget into its panel first, draws the frames it needs, and throws
  // std::runtime_error that lists similar names if there is no such widget, or says that it is disabled.
  void click(const std::string& name, int button = 0);
  void doubleClick(const std::string& name);
  void hover(const std::string& name);
  /// From one place of the widget to another, each as a share of its width and height.
  void drag(const std::string& name, double from_x, double from_y, double to_x, double to_y, int button = 0);
  /// Puts text into a field and confirms it with Enter.
  void enter(const std::string& name, const std::string& text);
  bool has(const std::string& name) const;

  /// What the last frame showed.
  RgbImage image() const;
  /// All words that it drew, see drawnWords().
  std::string words() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage
