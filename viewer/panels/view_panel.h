#pragma once

#include <memory>
#include <optional>

#include "core/gpu/gl_context.h"
#include "viewer/panels/overlays.h"
#include "viewer/panels/panel.h"
#include "viewer/pick.h"
#include "viewer/viewport.h"

namespace vantage {

/// The 3-D view: the scene under the mouse, what is hovered, selected and measured, and the view through the
/// explained frustum as an inset.
class ViewPanel {
 public:
  /// \param name of its widgets, "view" gives "view", "view/legend" and so on
  ViewPanel(GlContext& context, Scene& scene, std::string name);
  ~ViewPanel();

  /// Fills what is left of the window that is open. True if it was clicked or dragged in.
  bool draw(PanelContext& context, const ViewSettings& settings, double pixel_scale);
  /// Seconds until the view wants to be drawn again; nothing = not before the next change.
  std::optional<double> nextRender_s() const;

  Viewport& viewport() { return viewport_; }
  /// Puts the eye where pictures have it.
  void resetEye(PanelContext& context);
  /// Looks along an axis, z upward: 0 from the front (-y), 1 from the right (+x), 2 from above.
  void lookAlong(PanelContext& context, int side);
  void setEye(const Eye& eye);
  /// Looks from where another view of the same scene is looked at from, which may be under the mouse.
  void follow(const ViewPanel& other);
  /// Two clicks measure a distance while it is on.
  bool measuring() const { return measuring_; }
  void toggleMeasuring();
  /// What was measured belongs to another scene.
  void forgetMeasured() { measured_.clear(); }
  /// Looks through the explained view.
  void lookThroughView(PanelContext& context);
  void orbitBy(double left_rad, double up_rad);
  void zoomBy(double factor);

 private:
  /// Brings the scene to model and settings.
  void update(PanelContext& context, ViewSettings wanted);
  void mouse(PanelContext& context, double left, double top);
  void hover(PanelContext& context, const Eigen::Vector2d& at_px);
  void click(PanelContext& context);
  void lookAt(const Eigen::Vector3d& p_world);
  LayerNotes marks(PanelContext& context, double left, double top);

  std::string name_;
  GlContext& context_;
  Scene& scene_;
  Viewport viewport_;
  double pixel_scale_ = 1.0;
  std::uint64_t revision_ = 0;
  StepData data_;  ///< what the scene's frame refers to, which the model may have let go of
  bool has_frame_ = false, eye_placed_ = false;
  ViewSettings arranged_;
  Rgb arranged_paper_;
  double arranged_scale_ = 0.0;
  std::string problem_;
  Picker picker_;
  std::optional<Picked> hovered_;
  Eigen::Vector2d hovered_at_ = Eigen::Vector2d::Constant(-1.0);
  bool measuring_ = false;
  std::vector<Eigen::Vector3d> measured_;  ///< none, one end, or both
  Eigen::Vector2d pressed_at_ = Eigen::Vector2d::Zero();
  ViewInsets insets_;
  std::uint64_t insets_revision_ = 0;  ///< differs whenever what they show does
};

}  // namespace vantage
