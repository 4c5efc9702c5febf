#pragma once

#include <memory>
#include <string>

#include "viewer/panels/panel.h"
#include "viewer/viewport.h"

namespace vantage {

/// Where the 3-D view is in the window, its own units.
struct ViewArea {
  std::string name;  ///< of its widgets
  float left = 0.0f, top = 0.0f, right = 0.0f, bottom = 0.0f;
  float width() const { return right - left; }
  float height() const { return bottom - top; }
};

/// Legend of the layers that are shown, in the lower left corner. \param more what else is to be explained
/// \return the width that it takes
float legendOverlay(PanelContext& context, const ViewArea& area, const LayerNotes& more);

/// The sign of a legend entry and its words, at Dear ImGui's cursor. \param width_px of a line; 0: what is
/// left
void drawLegendEntry(const LegendEntry& entry, const Theme& theme, float width_px = 0.0f);

/// A colour scale with its numbers, at Dear ImGui's cursor.
void drawColorScale(const ColorScale& scale, float width, const Theme& theme);

/// Pictures along the right border of the 3-D view: what the explained view is predicted to see, and those
/// that belong to layers (the depth image).
class ViewInsets {
 public:
  ViewInsets();
  ~ViewInsets();

  /// \param room that may be taken from the right border, \param pixel_scale pixels per unit of the window,
  /// \param revision differs whenever the frame of the scene does
  void draw(PanelContext& context, Viewport& viewport, const ViewArea& area, float room, double pixel_scale,
            std::uint64_t revision);
  /// The point of the window is on one of them, as drawn last.
  bool cover(double x, double y) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage
