#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/color.h"
#include "viewer/image.h"

namespace vantage {

/// What a colour or mark stands for.
struct LegendEntry {
  enum class Mark {
    Fill,
    Line,
    Dashed,
    Dot,
    Cross,
    Crossed,  ///< the fill with a cross on it
    Striped,  ///< the fill with stripes
    Diamond,  ///< the fill with a diamond on it
    Ringed    ///< the fill with a ring on it
  };
  Mark mark = Mark::Fill;
  Rgb color;
  double opacity = 1.0;
  std::string text;
  bool operator==(const LegendEntry&) const = default;
};

/// A colour scale with its unit.
struct ColorScale {
  ColorMap map = ColorMap::Viridis;
  std::string title;  ///< quantity and unit
  double low = 0.0, high = 1.0;
  bool open_top = false;  ///< values above the upper end have its colour
};

/// A picture beside the scene.
struct Inset {
  std::string title;
  RgbImage image;
  ColorScale scale;
};

/// What stands beside the scene for a layer.
struct LayerNotes {
  std::vector<LegendEntry> legend;
  std::optional<ColorScale> scale;
  std::optional<Inset> inset;
};

}  // namespace vantage
