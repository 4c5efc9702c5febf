#include "core/perception/depth_filters.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "core/geometry/check.h"

namespace vantage {
namespace {

constexpr float kNone = DepthImage::kInvalid;

/// Calls `row(v)` for every row, in parallel.
template <class Row>
void forRows(int height, Row row) {
  tbb::parallel_for(tbb::blocked_range<int>(0, height, 16), [&](const tbb::blocked_range<int>& rows) {
    for (int v = rows.begin(); v < rows.end(); ++v) row(v);
  });
}

/// A depth as it is, or NaN, so that every comparison with it is false. DepthImage::valid() in a form that
/// vectorises.
float orNone(float z) {
  return z > 0.0f && z <= std::numeric_limits<float>::max() ? z : kNone;
}

DepthImage withoutInvalid(const DepthImage& depth) {
  DepthImage clean(depth.width, depth.height);
  std::ranges::transform(depth.depth_m, clean.depth_m.begin(), orNone);
  return clean;
}

std::size_t rowStart(const DepthImage& depth, int v) {
  return static_cast<std::size_t>(v) * depth.width;
}

/// x' / z of a row (eq. 15) as a function of the column that rises away from the emitter's side.
struct ShadowScan {
  float inverse_f, center, sign, offset;
  ShadowScan(const PinholeCamera& camera, const DepthFilterConfig& config)
      : inverse_f(static_cast<float>(1.0 / camera.fx)),
        center(static_cast<float>(camera.cx)),
        sign(config.emitter_side == EmitterSide::Left ? 1.0f : -1.0f),
        offset(static_cast<float>(config.emitter_offset_m)) {}
  float at(int u, float z) const { return sign * (static_cast<float>(u) - center) * inverse_f + offset / z; }
};

/// Points of a row in the camera frame, z and their squared length; NaN where there is none.
struct PointRow {
  std::vector<float> x, y, z, length2;

  void load(const DepthImage& depth, const PinholeCamera& camera, int v) {
    const auto width = static_cast<std::size_t>(depth.width);
    const bool outside = v < 0 || v >= depth.height;
    for (std::vector<float>* part : {&x, &y, &z, &length2})
      outside ? part->assign(width, kNone) : part->resize(width);
    if (outside) return;
    const float* row = depth.depth_m.data() + rowStart(depth, v);
    const auto fx = static_cast<float>(1.0 / camera.fx), cx = static_cast<float>(camera.cx);
    const auto ray_y = static_cast<float>((v - camera.cy) / camera.fy);
    for (std::size_t u = 0; u < width; ++u) {
      z[u] = orNone(row[u]);
      x[u] = (static_cast<float>(u) - cx) * fx * z[u];
      y[u] = ray_y * z[u];
      length2[u] = x[u] * x[u] + y[u] * y[u] + z[u] * z[u];
    }
  }
};

/// Eq. (19), squared, for the pixels `at + i` of a row and `other_at + i` of theirs. NaN marks nothing.
void markGrazing(const PointRow& row, std::size_t at, const PointRow& other, std::size_t other_at,
                 std::size_t count, float cos2, std::uint8_t* mask) {
  const float *px = row.x.data() + at, *py = row.y.data() + at, *pz = row.z.data() + at,
              *pp = row.length2.data() + at;
  const float *qx = other.x.data() + other_at, *qy = other.y.data() + other_at,
              *qz = other.z.data() + other_at;
  for (std::size_t i = 0; i < count; ++i) {
    const float dx = qx[i] - px[i], dy = qy[i] - py[i], dz = qz[i] - pz[i];
    const float along = dx * px[i] + dy * py[i] + dz * pz[i];
    const float length2 = dx * dx + dy * dy + dz * dz;
    mask[at + i] |= along * along > cos2 * length2 * pp[i] ? depth_mask::kVeil : std::uint8_t{0};
  }
}

/// Nearest and farthest valid depth of a pixel's 3x3 neighbours, itself included.
std::pair<float, float> sidesAround(const DepthImage& depth, int u, int v) {
  float near = std::numeric_limits<float>::infinity(), far = 0.0f;
  for (int y = std::max(v - 1, 0); y <= std::min(v + 1, depth.height - 1); ++y)
    for (int x = std::max(u - 1, 0); x <= std::min(u + 1, depth.width - 1); ++x) {
      const float z = depth.at(x, y);
      if (!DepthImage::valid(z)) continue;
      near = std::min(near, z);
      far = std::max(far, z);
    }
  return {near, far};
}

}  // namespace

void DepthFilterConfig::validate() const {
  requireInRange("filter.bilateral_diameter_px", bilateral_diameter_px, 1, 31);
  requireInRange("filter.bilateral_sigma_px", bilateral_sigma_px, 0.1, 20.0);
  requireInRange("filter.bilateral_sigma_m", bilateral_sigma_m, 0.001, 1.0);
  requireInRange("filter.emitter_offset_m", emitter_offset_m, 0.001, 1.0);
  requireInRange("filter.veil_angle_rad", veil_angle_rad, 0.001, 1.5);
  requireInRange("filter.edge_step_share", edge_step_share, 0.001, 1.0);
  requireInRange("filter.edge_side_share", edge_side_share, 0.0, 0.5);
}

DepthFilterConfig paperDepthFilters() {
  DepthFilterConfig config;
  config.bilateral = config.shadow = config.veil = true;
  return config;
}

DepthImage bilateralFiltered(const DepthImage& depth, const DepthFilterConfig& config) {
  if (depth.empty()) return depth;
  DepthImage smooth = withoutInvalid(depth);
  float nearest = std::numeric_limits<float>::infinity();
  for (const float z : smooth.depth_m) nearest = std::fmin(nearest, z);
  if (std::isinf(nearest)) return smooth;
  // Far outside the weights, so that no valid pixel takes anything of it.
  const float stand_in = nearest - 20.0f * static_cast<float>(config.bilateral_sigma_m);
  DepthImage filled = smooth;
  for (float& z : filled.depth_m)
    if (std::isnan(z)) z = stand_in;
  const cv::Mat from(filled.height, filled.width, CV_32F, filled.depth_m.data());
  cv::Mat to(smooth.height, smooth.width, CV_32F);
  cv::bilateralFilter(from, to, config.bilateral_diameter_px, config.bilateral_sigma_m,
                      config.bilateral_sigma_px);
  const auto* value = to.ptr<float>();
  for (float& z : smooth.depth_m) {
    if (!std::isnan(z)) z = *value;
    ++value;
  }
  return smooth;
}

void markShadow(const DepthImage& depth, const PinholeCamera& camera, const DepthFilterConfig& config,
                std::span<std::uint8_t> mask) {
  const ShadowScan scan(camera, config);
  const bool from_left = config.emitter_side == EmitterSide::Left;
  forRows(depth.height, [&](int v) {
    const std::size_t row = rowStart(depth, v);
    float most = -std::numeric_limits<float>::infinity();
    for (int i = 0; i < depth.width; ++i) {
      const int u = from_left ? i : depth.width - 1 - i;
      const float z = depth.depth_m[row + u];
      if (!DepthImage::valid(z)) continue;
      const float slope = scan.at(u, z);  // Eq. (18); atan is monotonic
      if (slope <= most)
        mask[row + u] |= depth_mask::kShadow;
      else
        most = slope;
    }
  });
}

void markVeil(const DepthImage& depth, const PinholeCamera& camera, const DepthFilterConfig& config,
              std::span<std::uint8_t> mask) {
  const auto width = static_cast<std::size_t>(depth.width);
  const auto cos2 = static_cast<float>(std::pow(std::cos(config.veil_angle_rad), 2));
  tbb::parallel_for(tbb::blocked_range<int>(0, depth.height, 16), [&](const tbb::blocked_range<int>& rows) {
    PointRow above, row, below;
    above.load(depth, camera, rows.begin() - 1);
    row.load(depth, camera, rows.begin());
    for (int v = rows.begin(); v < rows.end(); ++v) {
      below.load(depth, camera, v + 1);
      std::uint8_t* out = mask.data() + rowStart(depth, v);
      markGrazing(row, 0, row, 1, width - 1, cos2, out);
      markGrazing(row, 1, row, 0, width - 1, cos2, out);
      markGrazing(row, 0, above, 0, width, cos2, out);
      markGrazing(row, 0, below, 0, width, cos2, out);
      std::swap(above, row);
      std::swap(row, below);
    }
  });
}

void markEdges(const DepthImage& depth, const DepthFilterConfig& config, std::span<std::uint8_t> mask) {
  const auto least = static_cast<float>(config.edge_step_share),
             side = static_cast<float>(config.edge_side_share);
  forRows(depth.height, [&](int v) {
    for (int u = 0; u < depth.width; ++u) {
      const float z = depth.at(u, v);
      if (!DepthImage::valid(z)) continue;
      const auto [near, far] = sidesAround(depth, u, v);
      const float step = far - near;
      if (step > least * z && z - near > side * step && far - z > side * step)
        mask[rowStart(depth, v) + u] |= depth_mask::kEdge;
    }
  });
}

FilteredDepth filterDepth(const DepthImage& depth, const PinholeCamera& camera,
                          const DepthFilterConfig& config) {
  config.validate();
  if (depth.empty()) return {depth, {}};
  camera.validate();
  if (depth.width != camera.width || depth.height != camera.height)
    throw std::invalid_argument("depth filters: the image has " + std::to_string(depth.width) + "x" +
                                std::to_string(depth.height) + " pixels, its camera " +
                                std::to_string(camera.width) + "x" + std::to_string(camera.height));
  FilteredDepth result{config.bilateral ? bilateralFiltered(depth, config) : depth, {}};
  result.mask.assign(depth.depth_m.size(), 0);
  if (config.shadow) markShadow(result.depth, camera, config, result.mask);
  if (config.veil) markVeil(result.depth, camera, config, result.mask);
  if (config.edge_aware) markEdges(result.depth, config, result.mask);
  for (std::size_t i = 0; i < result.mask.size(); ++i) {
    if (std::isnan(orNone(depth.depth_m[i]))) result.mask[i] = depth_mask::kInvalid;
    if (result.mask[i] != 0) result.depth.depth_m[i] = kNone;
  }
  return result;
}

MaskCounts countMask(std::span<const std::uint8_t> mask) {
  using namespace depth_mask;
  MaskCounts counts;
  for (const std::uint8_t m : mask) {
    const bool shadow = m & kShadow, veil = m & kVeil;
    (m == 0           ? counts.kept
     : m & kInvalid   ? counts.invalid
     : shadow && veil ? counts.both
     : shadow         ? counts.shadow
     : veil           ? counts.veil
                      : counts.edge)++;
  }
  return counts;
}

}  // namespace vantage
