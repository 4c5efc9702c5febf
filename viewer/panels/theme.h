#pragma once

#include <string_view>
#include <vector>

#include "viewer/color.h"

namespace vantage {

/// Colours of the window.
enum class ThemeName { Light, Dark, HighContrast };

/// `light`, `dark`, `high-contrast`.
std::string_view nameOf(ThemeName theme);
const std::vector<ThemeName>& themes();

/// What panels and the 3-D view need beyond Dear ImGui's own colours.
struct Theme {
  Rgb paper;   ///< behind the 3-D view
  Rgb panel;   ///< behind widgets
  Rgb ink;     ///< text and lines on both
  Rgb faint;   ///< secondary text, axes
  Rgb accent;  ///< what is selected or active
  Rgb chosen;  ///< the chosen view
  Rgb warning;
  Rgb curve;  ///< plotted curves, in the order of use
  Rgb second_curve;
  Rgb third_curve;
};
const Theme& themeOf(ThemeName name);

/// Gives Dear ImGui's current context the theme's colours and sizes in pixels for a font of the given height.
void applyTheme(ThemeName name, double font_px);

}  // namespace vantage
