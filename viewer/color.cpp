#include "viewer/color.h"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

// Nine support points of the published tables; linear between them.
constexpr std::array<Rgb, 9> kViridis = {rgb(68, 1, 84),    rgb(71, 45, 123),  rgb(59, 82, 139),
                                         rgb(44, 114, 142), rgb(33, 145, 140), rgb(40, 174, 128),
                                         rgb(94, 201, 98),  rgb(173, 220, 48), rgb(253, 231, 37)};
constexpr std::array<Rgb, 9> kCividis = {rgb(0, 34, 78),     rgb(27, 54, 109),   rgb(66, 78, 108),
                                         rgb(96, 102, 110),  rgb(125, 124, 120), rgb(155, 148, 118),
                                         rgb(187, 173, 108), rgb(220, 200, 87),  rgb(254, 232, 56)};

}  // namespace

std::array<std::uint8_t, 3> Rgb::bytes() const {
  const auto byte = [](double v) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0, 1.0) * 255.0));
  };
  return {byte(r), byte(g), byte(b)};
}

Rgb colorAt(ColorMap map, double t) {
  const auto& table = map == ColorMap::Viridis ? kViridis : kCividis;
  const double at = std::clamp(std::isfinite(t) ? t : 0.0, 0.0, 1.0) * (table.size() - 1);
  const std::size_t low = std::min(static_cast<std::size_t>(at), table.size() - 2);
  const double f = at - static_cast<double>(low);
  const Rgb& a = table[low];
  const Rgb& b = table[low + 1];
  return {a.r + f * (b.r - a.r), a.g + f * (b.g - a.g), a.b + f * (b.b - a.b)};
}

}  // namespace vantage
