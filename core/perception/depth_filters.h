#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/depth_image.h"

namespace vantage {

/// Where the emitter of the depth camera stands, seen along the optical axis (D-B20).
enum class EmitterSide { Left, Right };

/// Depth pre-processing (Monica & Aleotti 2017, section on depth pre-processing). All filters are off unless
/// switched on.
struct DepthFilterConfig {
  /// Smoothing that keeps steps; the others look at its result.
  bool bilateral = false;
  int bilateral_diameter_px = 5;    ///< window, pixels, 1..31
  double bilateral_sigma_px = 1.5;  ///< weight by distance in the image, pixels, 0.1..20
  double bilateral_sigma_m = 0.03;  ///< weight by difference of depth, metres, 0.001..1
  /// Removes what the emitter may not light (Algorithm 2).
  bool shadow = false;
  double emitter_offset_m = 0.08;  ///< Delta, camera to emitter, metres, 0.001..1
  EmitterSide emitter_side = EmitterSide::Left;
  /// Removes surfaces that are seen at a grazing angle, as between the two sides of a step (eq. 19).
  bool veil = false;
  double veil_angle_rad = 0.17453292519943295;  ///< Theta_max, radians, 0.001..1.5; 10 deg
  /// Stand-in for the driver's edge-aware filter, which is not published: removes a pixel that hangs between
  /// the near and the far side of a step within its 3x3 neighbours.
  bool edge_aware = false;
  double edge_step_share = 0.02;  ///< smallest step, share of the pixel's depth, 0.001..1
  double edge_side_share = 0.1;   ///< nearer to a side than this share of the step belongs to it, 0..0.5

  bool any() const { return bilateral || shadow || veil || edge_aware; }
  bool operator==(const DepthFilterConfig&) const = default;
  /// \throws OutOfRange naming field, value and range.
  void validate() const;
};

/// The paper's order: bilateral, then shadow and veil on its result (D-B22).
DepthFilterConfig paperDepthFilters();

/// Why a pixel has no depth after the filters; several may hold. 0 = it has one.
namespace depth_mask {
constexpr std::uint8_t kShadow = 1, kVeil = 2, kInvalid = 4, kEdge = 8;
}

/// Result of filterDepth().
struct FilteredDepth {
  DepthImage depth;                ///< removed pixels are invalid
  std::vector<std::uint8_t> mask;  ///< depth_mask bits, one byte a pixel, row-major
};

/// Applies the filters that are switched on. Pixels that were invalid (not finite, or not above 0) neither
/// count as neighbours nor change anything (D-B21). The same result for any number of threads; an empty image
/// gives an empty result. \throws std::invalid_argument if the image has another size than the camera, or as
/// validate() of config and camera.
FilteredDepth filterDepth(const DepthImage& depth, const PinholeCamera& camera,
                          const DepthFilterConfig& config);

// The filters one by one; those that remove pixels set their bit in `mask`, of as many bytes as the image has
// pixels.

/// Bilateral filter; invalid pixels stay invalid and have no weight.
DepthImage bilateralFiltered(const DepthImage& depth, const DepthFilterConfig& config);
/// Algorithm 2, eq. (18): row by row, scanning away from the emitter's side, whatever does not raise the
/// running maximum of x'/z. A necessary condition for shadow only: lit pixels can be removed.
void markShadow(const DepthImage& depth, const PinholeCamera& camera, const DepthFilterConfig& config,
                std::span<std::uint8_t> mask);
/// Eq. (19) with the four neighbours.
void markVeil(const DepthImage& depth, const PinholeCamera& camera, const DepthFilterConfig& config,
              std::span<std::uint8_t> mask);
void markEdges(const DepthImage& depth, const DepthFilterConfig& config, std::span<std::uint8_t> mask);

/// Pixels of a mask by reason; a pixel that shadow and veil remove counts as `both` alone.
struct MaskCounts {
  std::uint64_t kept = 0, shadow = 0, veil = 0, both = 0, edge = 0, invalid = 0;
  std::uint64_t removed() const { return shadow + veil + both + edge; }
  bool operator==(const MaskCounts&) const = default;
};
MaskCounts countMask(std::span<const std::uint8_t> mask);

}  // namespace vantage
