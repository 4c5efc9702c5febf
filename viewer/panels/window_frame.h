#pragma once

#include "viewer/panels/panel.h"

namespace vantage {

/// Where the parts of the window are, in its own units.
struct WindowLayout {
  double width = 0.0, height = 0.0;  ///< of the window
  double menu = 0.0, status = 0.0;   ///< heights
  double left = 0.0, right = 0.0;    ///< widths; 0: not shown
  double timeline = 0.0;             ///< height; 0: not shown
  double viewLeft() const { return left; }
  double viewRight() const { return width - right; }
  double viewBottom() const { return height - status - timeline; }
};

/// The layout that is wanted, as far as the window has room for it.
WindowLayout windowLayout(const Preferences& preferences);

/// Begins a window without a frame that fills a rectangle; to be closed with ImGui::End(). \param flags of
/// Dear ImGui beside those; false if nothing of it can be seen
bool beginPart(const char* name, double left, double top, double right, double bottom, int flags = 0);

void menuBar(PanelContext& context);  ///< all commands by group, recent files, what is open

// The parts around the 3-D view.
/// Layers, what-if. \param takes_keys they move inside it from now on
void leftPart(PanelContext& context, const WindowLayout& layout, bool takes_keys);
void rightPart(PanelContext& context, const WindowLayout& layout);     ///< candidates and explanation, gains
void timelinePart(PanelContext& context, const WindowLayout& layout);  ///< at the lower edge
void statusBar(PanelContext& context, const WindowLayout& layout);     ///< what is being done
/// Handles between the parts; they change the preferences.
void splitters(PanelContext& context, const WindowLayout& layout);

}  // namespace vantage
