#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/gpu/gl_context.h"
#include "viewer/image.h"
#include "viewer/panels/widgets.h"
#include "viewer/preferences.h"
#include "viewer/scene_frame.h"
#include "viewer/view_settings.h"

namespace vantage {

class Commands;
class InspectorModel;

/// What the inspector needs from above.
struct InspectorPorts {
  /// A picture of a view with caption and legend, as snapshots make it. `what_if`: parameters that differ
  /// from the run, for the caption; empty if none do.
  std::function<RgbImage(const SceneFrame&, const ViewSettings&, const std::string& what_if, GlContext&,
                         int width, int height)>
      picture;
  std::function<void(const std::string&)> copy = [](const std::string&) {};  ///< to the clipboard
  std::function<void()> wake = [] {};  ///< called from any thread: draw a frame soon
  /// The view of a recipe file; called from any thread. Without it recipes cannot be opened.
  std::function<ViewSettings(const std::filesystem::path&)> recipe = nullptr;
};

/// The contents of the inspector's window: panels around the 3-D view. Knows no window system; whoever owns a
/// window, or plays one, gives it OpenGL, input and time.
class Inspector {
 public:
  /// The context must outlive the inspector. \throws std::runtime_error if OpenGL lacks what is needed.
  Inspector(GlContext& context, InspectorPorts ports, Preferences preferences);
  ~Inspector();
  Inspector(const Inspector&) = delete;

  /// Opens files that the program knows: a run, a map, a scene, a cloud, a recipe, a configuration. What
  /// cannot be opened is told in the window.
  void open(const std::vector<std::filesystem::path>& files);

  /// Takes over finished background work and lets time pass; true if a frame should be drawn.
  bool update(double elapsed_s);
  /// Submits one frame to Dear ImGui, between UiHost::begin() and end(), and renders the 3-D view if
  /// something in it changed. \param pixel_scale pixels of the framebuffer for one unit of the window (HiDPI)
  void draw(double pixel_scale);
  /// Nothing is loading, computing, playing or waiting to be refined.
  bool idle() const;
  bool wantsToClose() const;

  /// Theme and text height for the host, window and all else that is set.
  const Preferences& preferences() const;
  /// What is to be kept for the next start.
  Preferences toKeep() const;
  const Widgets& widgets() const;
  const Commands& commands() const;
  InspectorModel& model();
  /// What went wrong last, if that is still being told.
  std::optional<std::string> error() const;
  /// Pictures of the 3-D view that were rendered so far.
  std::uint64_t picturesRendered() const;
  /// The last of each file is a full one of the scene as it is.
  bool pictureIsFull() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage
