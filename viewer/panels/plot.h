#pragma once

#include <imgui.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "viewer/color.h"
#include "viewer/panels/theme.h"

namespace vantage {

/// Colour for Dear ImGui's draw lists.
inline ImU32 packed(Rgb color, double opacity = 1.0) {
  return ImGui::ColorConvertFloat4ToU32({static_cast<float>(color.r), static_cast<float>(color.g),
                                         static_cast<float>(color.b), static_cast<float>(opacity)});
}

/// Secondary text, in as many lines as it needs.
void faintText(const Theme& theme, const std::string& text);

/// A rectangle of the window in which values are drawn, x to the right and y up.
struct PlotArea {
  ImVec2 low, high;  ///< pixels, top left and bottom right
  double x0 = 0.0, x1 = 1.0, y0 = 0.0, y1 = 1.0;

  ImVec2 at(double x, double y) const {
    const double u = x1 > x0 ? (x - x0) / (x1 - x0) : 0.5, v = y1 > y0 ? (y - y0) / (y1 - y0) : 0.5;
    return {static_cast<float>(low.x + u * (high.x - low.x)),
            static_cast<float>(high.y - v * (high.y - low.y))};
  }
};

/// 41102 -> "41.1 k", 0.25 -> "0.25".
std::string shortNumber(double value);

}  // namespace vantage
