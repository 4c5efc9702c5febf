#pragma once

#include <cstdint>

namespace vantage::experiments {

/// Scene of B4 (evaluation.md, section 5): an upright bar of 1 m on the ground before a wall. The camera
/// looks at the bar's axis from 1 m, 0.5 m high; 512x424, f = 365; the emitter stands to its left. No noise.
struct BarScene {
  double width_m = 0.08;   ///< edge along the wall
  double depth_m = 0.0;    ///< edge across; 0 = as wide
  double angle_rad = 0.0;  ///< of the camera about the axis; positive = to the left, seen toward the wall
  double wall_m = 1.5;     ///< behind the axis
  bool ground = true;
  bool range_limit = true;  ///< 8 m along the optical axis
  double emitter_offset_m = 0.08;
};

struct BarResult {
  std::uint64_t removed = 0, removed_lit = 0;  ///< by the shadow filter
  std::uint64_t shadowed = 0;                  ///< pixels that the emitter does not light
  /// Share of lit pixels among the removed (false discovery rate); 0 if none was removed.
  double fdr_percent() const {
    return removed == 0 ? 0.0 : 100.0 * static_cast<double>(removed_lit) / static_cast<double>(removed);
  }
  std::uint64_t missed() const { return shadowed - (removed - removed_lit); }
};

BarResult measureBar(const BarScene& scene);

/// FDR in [0, 1] of a thin plate facing the camera at depth z1 before a wall at depth z2, all lengths in
/// metres.
double plateFdr(double width_m, double z1_m, double z2_m, double emitter_offset_m);

}  // namespace vantage::experiments
