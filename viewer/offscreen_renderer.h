#pragma once

#include <memory>
#include <span>

#include "core/gpu/gl_context.h"
#include "viewer/image.h"

class vtkRenderer;

namespace vantage {

inline constexpr int kLargestPicture = 8192;  ///< pixels a side

/// Draws VTK renderers into memory through a context of ours. The same input gives the same bytes.
class OffscreenRenderer {
 public:
  /// The context must outlive the renderer and be used on this thread only.
  explicit OffscreenRenderer(GlContext& context);
  ~OffscreenRenderer();
  OffscreenRenderer(const OffscreenRenderer&) = delete;
  OffscreenRenderer& operator=(const OffscreenRenderer&) = delete;

  /// One picture; the first renderer is drawn first. Overlapping viewports: later renderers cover earlier
  /// ones. \throws std::invalid_argument for a size outside 16..kLargestPicture, std::runtime_error if OpenGL
  /// fails.
  RgbImage render(std::span<vtkRenderer* const> renderers, int width, int height);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage
