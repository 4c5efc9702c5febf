#pragma once

#include <utility>
#include <vector>

#include "core/perception/depth_filters.h"
#include "viewer/color.h"
#include "viewer/image.h"
#include "viewer/layers/layer_notes.h"

namespace vantage {

/// Range of the nearest three quarters of the valid depths, metres, rounded outward to decimetres, so that a
/// far wall doesn't take the whole scale; 0..1 if there are none.
std::pair<double, double> depthRange(const DepthImage& depth);

/// Depth in colours; invalid pixels striped in light grey, so that they can't be mistaken for a depth.
RgbImage depthPicture(const DepthImage& depth, ColorMap map, double low, double high);

/// Colour of a pixel that filters removed; none if it was kept or invalid before. \param mask depth_mask bits
std::optional<Rgb> removedColor(std::uint8_t mask);

/// depthPicture() of what was measured, with the pixels that filters removed in their filter's colour.
RgbImage filteredPicture(const DepthImage& measured, std::span<const std::uint8_t> mask, ColorMap map,
                         double low, double high);

/// What the colours of filteredPicture() mean, with the number of pixels; only those that occur.
std::vector<LegendEntry> removedLegend(const MaskCounts& counts);

}  // namespace vantage
