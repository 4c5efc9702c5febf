#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/gpu/gl_context.h"
#include "viewer/image.h"
#include "viewer/scene.h"

class vtkRenderer;

namespace vantage {

/// What a drag with the mouse does to the eye.
enum class Drag { Orbit, Pan };

/// A scene's view as an OpenGL texture that follows the mouse: for a window's panel, or without any window.
/// Draws only if something changed. Where a full picture takes longer than kQuick_s (software drivers), a
/// rough one comes first and the full one kSettle_s after the last movement or change. Pixels count from the
/// top left.
class Viewport {
 public:
  static constexpr double kSettle_s = 0.2, kQuick_s = 0.06;

  /// Context and scene must outlive the viewport; all calls come from the context's thread.
  /// \throws std::runtime_error if OpenGL fails.
  Viewport(GlContext& context, Scene& scene);
  ~Viewport();
  Viewport(const Viewport&) = delete;
  Viewport& operator=(const Viewport&) = delete;

  /// Pixels of the picture, each side clamped to 16..kLargestPicture.
  void resize(int width, int height);
  PictureSize size() const;

  /// The scene or its settings changed: the next render() draws.
  void requestRender();
  /// Draws if there is something to do; true if it drew. Leaves the context current. \throws
  /// std::runtime_error if OpenGL fails.
  bool render();
  /// Seconds until render() has something to do: 0 = now; nothing = not before the next change.
  std::optional<double> nextRender_s() const;
  /// The last picture: a texture of the context, opaque, its first row at the bottom; 0 before the first
  /// render(). May be smaller than size(), to be stretched.
  unsigned texture() const;
  /// Pictures drawn so far, rough ones included.
  std::uint64_t framesRendered() const;

  /// Between press and release move() changes the scene's eye.
  void press(Drag drag, const Eigen::Vector2d& at_px);
  void move(const Eigen::Vector2d& at_px);
  void release();
  bool dragging() const;
  /// Positive notches come nearer to what is under the cursor.
  void wheel(double notches, const Eigen::Vector2d& at_px);
  /// The eye is moved by somebody else, a key or an animation: pictures may be rough until kSettle_s after
  /// the last call with true; with false the full one comes at once.
  void setMoving(bool moving);
  /// The last picture is a full one of the scene as it is.
  bool settled() const;

  /// The view as it is now, at its size and in full quality.
  RgbImage screenshot();
  /// Other renderers in this context, e.g. Scene::inset(); the first is drawn first. The view's texture
  /// stays. \throws std::invalid_argument for a size outside 16..kLargestPicture, std::runtime_error if
  /// OpenGL fails.
  RgbImage picture(std::span<vtkRenderer* const> renderers, int width, int height);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage
