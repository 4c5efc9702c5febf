#pragma once

#include <memory>
#include <string>
#include <vector>

#include "viewer/eye.h"
#include "viewer/layers/layer_notes.h"
#include "viewer/scene_frame.h"
#include "viewer/theme.h"
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
/// context draws its renderers, in order. A picture on a page is laid out by show(); a window that is looked
/// at for long calls arrange() and draws view().
class Scene {
 public:
  Scene();
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// The step to draw from now on. Layers are built when they are first shown and kept until something that
  /// they depend on is another one: a product of the record, the map's version, a setting of the run, a field
  /// of the style. What the frame refers to must outlive its use.
  void setFrame(const SceneFrame& frame);
  /// Drops everything that was built: before another run.
  void forget();

  /// Lays out a picture of the frame. \throws std::invalid_argument for settings out of range,
  /// std::logic_error without a frame.
  void show(const ViewSettings& settings, const Caption& caption, PageStyle page, int width, int height);
  /// Renderers of the last show(), in drawing order; owned by the scene.
  std::vector<vtkRenderer*> renderers() const;

  /// Brings view() to the frame and the settings; the eye stays where it is (settings.camera counts for the
  /// first time only). Layers that are switched off stay built. \param scale of letters and lines, for
  /// displays with small pixels. \throws as show() does; view() then shows what could be built.
  void arrange(const ViewSettings& settings, const SceneTheme& theme = {}, double scale = 1.0);
  /// The one renderer of arrange(), for the scene's life.
  vtkRenderer* view() const;
  /// The eye of view().
  Eye eye() const;
  void setEye(const Eye& eye);
  /// Puts the eye of view() where pictures have it, so that all that must be seen is. \throws
  /// std::invalid_argument for a view out of range, std::logic_error without a frame.
  void placeEye(const CameraView& camera, double width_to_height);

  /// Leaves out of view() what makes a picture fine but slow, until switched off again. \param share of the
  /// resolution at which the picture is drawn, to be stretched: lines and letters keep their sizes
  void setRough(bool rough, double share = 1.0);

  /// The layers of the last arrange() seen from somewhere else, for a picture beside the view; layers that it
  /// lacks are built. One renderer for the scene's life, drawn in the window that draws view(), after it.
  /// \throws as arrange() does.
  vtkRenderer* inset(const Eye& eye, const LayerSet& layers);

  /// What a layer adds, as built for the last show() or arrange() that had it; null if it was not shown
  /// since.
  const LayerContent* content(Layer layer) const;
  /// The layer was built and there is something of it in this frame.
  bool hasContent(Layer layer) const;
  /// Legend entries, scales and insets of the layers that were shown last, in drawing order.
  std::vector<const LayerNotes*> shownNotes() const;
  /// How often a layer was built so far.
  int timesBuilt(Layer layer) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage
