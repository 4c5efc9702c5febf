#include "hardware/sensor_faults.h"

#include <cmath>
#include <optional>

namespace vantage {
namespace {

using namespace kinect_faults;

/// What a pixel reports that the emitter does not light.
float shadowDepth(float background_m, std::optional<float> foreground_m, std::uint64_t bits) {
  const double kind = uniformNumber(bits), amount = uniformNumber(mixedBits(bits));
  const auto share = static_cast<float>(amount);
  if (foreground_m && kind < kMixedShare) return *foreground_m + share * (background_m - *foreground_m);
  const float bias_m = kLeastBias_m + share * (kMostBias_m - kLeastBias_m);
  return background_m + (mixedBits(bits + 1) & 1 ? bias_m : -bias_m);
}

bool differ(float a, float b) {
  return std::isfinite(a) != std::isfinite(b) || std::abs(a - b) > kStep_m;
}

}  // namespace

std::uint64_t mixedBits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

double uniformNumber(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) / 9007199254740992.0;
}

void corruptShadow(std::span<float> row, std::span<const std::uint8_t> lit, bool emitter_left,
                   std::uint64_t row_seed) {
  std::optional<float> foreground_m;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::size_t u = emitter_left ? i : row.size() - 1 - i;
    if (!std::isfinite(row[u])) continue;
    if (lit[u])
      foreground_m = row[u];
    else
      row[u] = shadowDepth(row[u], foreground_m, mixedBits(row_seed ^ u));
  }
}

bool isStep(std::span<const float> row, std::span<const float> above, std::span<const float> below,
            std::size_t u) {
  return std::isfinite(row[u]) &&
         ((u > 0 && differ(row[u], row[u - 1])) || (u + 1 < row.size() && differ(row[u], row[u + 1])) ||
          (!above.empty() && differ(row[u], above[u])) || (!below.empty() && differ(row[u], below[u])));
}

}  // namespace vantage
