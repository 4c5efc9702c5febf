#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "viewer/layers/layer_notes.h"
#include "viewer/scene_frame.h"
#include "viewer/view_settings.h"

class vtkRenderer;

namespace vantage {

struct LayerContent;

/// Words above a picture.
struct Caption {
  std::string title;    ///< what is shown: "Voxel states"
  std::string context;  ///< run and step
  std::string figures;  ///< key figures; broken into lines as needed
};

/// How much stands around the view.
enum class PageStyle {
  Full,      ///< caption above, legend, scales and insets at the right
  ViewOnly,  ///< nothing but the scene: tiles of a contact sheet, a window with panels of its own
};

/// What is drawn: a function of a frame and view settings. Knows no OpenGL, window or file; whoever has a
/// context draws its renderers, in order.
class Scene {
 public:
  Scene();
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// The step to draw from now on. Layers are built when they are first shown, then kept until the next frame
  /// or style.
  void setFrame(const SceneFrame& frame);

  /// Lays out a picture of the frame. \throws std::invalid_argument for settings out of range,
  /// std::logic_error without a frame.
  void show(const ViewSettings& settings, const Caption& caption, PageStyle page, int width, int height);

  /// Renderers of the last show(), in drawing order; owned by the scene.
  std::vector<vtkRenderer*> renderers() const;

  /// What a layer adds, as built for the last show() that had it; null if it was not shown since.
  const LayerContent* content(Layer layer) const;
  /// Legend entries, scales and insets of the layers that were shown last, in drawing order.
  std::vector<const LayerNotes*> shownNotes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Eye of a view for points that must all be seen, in a picture of the given shape. \throws
/// std::invalid_argument for a view out of range or no points.
struct Eye {
  Eigen::Vector3d position, focus;
};
Eye fitEye(const CameraView& view, std::span<const Eigen::Vector3d> points, double width_to_height);

}  // namespace vantage
