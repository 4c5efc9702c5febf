#include "viewer/depth_picture.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "viewer/captions.h"

namespace vantage {
namespace {

constexpr Rgb kShadowColor = rgb(220, 60, 20), kVeilColor = rgb(240, 130, 200), kBothColor = rgb(120, 20, 90),
              kEdgeColor = rgb(30, 160, 100);

}  // namespace

std::pair<double, double> depthRange(const DepthImage& depth) {
  std::vector<float> valid;
  std::copy_if(depth.depth_m.begin(), depth.depth_m.end(), std::back_inserter(valid), DepthImage::valid);
  if (valid.empty()) return {0.0, 1.0};
  const double low = std::floor(*std::min_element(valid.begin(), valid.end()) * 10.0) / 10.0;
  const auto middle = valid.begin() + static_cast<std::ptrdiff_t>(valid.size() * 3 / 4);
  std::nth_element(valid.begin(), middle, valid.end());
  return {low, std::max(std::ceil(*middle * 10.0) / 10.0, low + 0.1)};
}

RgbImage depthPicture(const DepthImage& depth, ColorMap map, double low, double high) {
  RgbImage image(depth.width, depth.height);
  for (int v = 0; v < depth.height; ++v) {
    for (int u = 0; u < depth.width; ++u) {
      const float d = depth.at(u, v);
      const bool stripe = (u + v) % 12 < 3;
      image.set(u, v,
                DepthImage::valid(d) ? colorAt(map, (d - low) / (high - low)).bytes()
                                     : (stripe ? rgb(205, 207, 210) : rgb(238, 239, 240)).bytes());
    }
  }
  return image;
}

std::optional<Rgb> removedColor(std::uint8_t mask) {
  using namespace depth_mask;
  if (mask == 0 || mask & kInvalid) return std::nullopt;
  if ((mask & kVeil) && (mask & kShadow)) return kBothColor;
  return mask & kShadow ? kShadowColor : mask & kVeil ? kVeilColor : kEdgeColor;
}

RgbImage filteredPicture(const DepthImage& measured, std::span<const std::uint8_t> mask, ColorMap map,
                         double low, double high) {
  RgbImage image = depthPicture(measured, map, low, high);
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (const auto color = removedColor(mask[i]))
      image.set(static_cast<int>(i) % measured.width, static_cast<int>(i) / measured.width, color->bytes());
  return image;
}

std::vector<LegendEntry> removedLegend(const MaskCounts& counts) {
  std::vector<LegendEntry> legend;
  const auto add = [&](std::uint64_t pixels, Rgb color, const char* what) {
    if (pixels > 0)
      legend.push_back({LegendEntry::Mark::Fill, color, 1.0, grouped(pixels) + " px removed: " + what});
  };
  add(counts.shadow, kShadowColor, "shadow");
  add(counts.veil, kVeilColor, "veil");
  add(counts.both, kBothColor, "shadow and veil");
  add(counts.edge, kEdgeColor, "between two sides of an edge");
  return legend;
}

}  // namespace vantage
