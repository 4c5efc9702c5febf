#pragma once

#include <memory>

#include "core/gpu/gl_context.h"
#include "viewer/image.h"
#include "viewer/panels/theme.h"

struct ImGuiContext;

namespace vantage {

/// Dear ImGui on an OpenGL context of ours: fonts, theme and drawing, one frame at a time. Who owns the
/// window (or plays one) puts the input into ImGuiIO before begin(). One thread, that of the context.
class UiHost {
 public:
  /// The context must outlive the host. \throws std::runtime_error if OpenGL lacks what is needed.
  explicit UiHost(GlContext& context);
  ~UiHost();
  UiHost(const UiHost&) = delete;

  /// Theme and size of text from the next frame on. \param scale 1: 15 pixels
  void setLook(ThemeName theme, double scale);

  /// Makes the context and ImGui's context current.
  void makeCurrent();
  /// Starts a frame; everything that is submitted until end() is drawn.
  void begin();
  /// Draws the frame into a framebuffer of the given size (0: that of the window).
  void end(unsigned framebuffer, int width, int height);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Colour buffer to draw into where there is no window.
class UiSurface {
 public:
  UiSurface(GlContext& context, int width, int height);
  ~UiSurface();
  UiSurface(const UiSurface&) = delete;

  unsigned framebuffer() const { return framebuffer_; }
  RgbImage read() const;
  /// Waits until what was drawn is there, as a window does when its buffers change: software drivers would
  /// else pile up the geometry of many frames.
  void finish() const;

 private:
  GlContext& context_;
  int width_, height_;
  unsigned framebuffer_ = 0, texture_ = 0;
};

/// Picture as a texture for the window; made again when the picture changes.
class UiTexture {
 public:
  UiTexture() = default;
  ~UiTexture();
  UiTexture(const UiTexture&) = delete;

  /// \pre the context is current
  void set(const RgbImage& image);
  unsigned handle() const { return texture_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  unsigned texture_ = 0;
  int width_ = 0, height_ = 0;
};

}  // namespace vantage
