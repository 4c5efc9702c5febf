#pragma once

#include <span>

#include "viewer/layers/layer_notes.h"
#include "viewer/page.h"

namespace vantage {

/// Part of a page, pixels, y down.
struct PageArea {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
};

/// Writes the legend entries, colour scales and insets of layers one below the other. `unit` scales all sizes
/// (1 = 15 px text). Returns the y below the last.
double drawLegend(Page& page, const PageArea& area, std::span<const LayerNotes* const> contents, double unit);

/// One colour scale with its title and five ticks; returns the y below it.
double drawScale(Page& page, double x, double y, double width, const ColorScale& scale, double unit);

}  // namespace vantage
