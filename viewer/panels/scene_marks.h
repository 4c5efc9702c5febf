#pragma once

#include <imgui.h>

#include <optional>
#include <string>

#include "viewer/eye.h"
#include "viewer/layers/layer_notes.h"
#include "viewer/panels/panel.h"

namespace vantage {

/// Draws over the picture of a scene, at places of the scene.
struct SceneMarks {
  ImDrawList& draw;
  Eye eye;
  PictureSize size;    ///< of the picture
  double left, top;    ///< of the picture in the window, its own units
  double pixel_scale;  ///< pixels of the picture per unit of the window

  /// Where a world point appears in the window; nothing behind the eye.
  std::optional<ImVec2> at(const Eigen::Vector3d& p_world) const;
  void line(const Eigen::Vector3d& a_world, const Eigen::Vector3d& b_world, ImU32 color, float width) const;
  void arrow(const Eigen::Vector3d& a_world, const Eigen::Vector3d& b_world, ImU32 color) const;
  void frustum(const PinholeCamera& camera, const Pose& T_world_camera, ImU32 color) const;
  /// On a plate beside the place.
  void text(const Eigen::Vector3d& p_world, const std::string& text, const Theme& theme) const;
};

/// Marks the selected view, and where other parameters choose another one an arrow to it from the run's
/// choice. \return what the marks stand for
LayerNotes markChoices(PanelContext& context, const SceneMarks& marks);

}  // namespace vantage
