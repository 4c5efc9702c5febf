#pragma once

// What one row of voxels needs to fuse a frame, and the kernels that do it. No Eigen here: the vector
// versions are compiled with instruction sets of their own. All kernels do the same single-precision
// operations in the same order, without contraction, so that they agree bit for bit.

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace vantage::fusion {

/// Range of a pixel without measurement: its voxels lie behind any surface and are skipped.
inline constexpr float kNoRange = -1e30f;
inline constexpr float kFull = 32767.0f;  ///< stored value of +1

/// One frame as all rows see it.
struct Frame {
  const float* range_m = nullptr;  ///< measured range along each pixel's ray, metres, or kNoRange
  int width = 0, height = 0;
  float units_per_m = 0;  ///< stored units of a metre of signed distance: kFull / truncation
  float voxel_m = 0;
  float camera_x = 0;  ///< x of the camera in continuous voxel coordinates
  float observations = 1;
  int increment = 1;  ///< the same as an integer
  int max_weight = 128;
  std::ptrdiff_t row_pitch = 0;  ///< voxels from a row to the next, which is fetched ahead
};

/// One row along x: homogeneous pixel coordinates (+1/2, so that truncation finds the nearest pixel) are
/// affine in x, and so is the distance to the camera along the row.
struct Row {
  float u0, du, v0, dv, z0, dz;
  float across2_m2;  ///< squared distance of the camera from the line of the row
};

/// Voxel as stored: value in the low, weight in the high half.
struct Voxel {
  std::int16_t value;
  std::uint16_t weight;
};

/// Counts voxels observed in [x0, x1) of a row; sets the flag of every 16 voxels in which something changed.
using RowKernel = std::uint32_t (*)(const Frame&, const Row&, void* row_voxels, int x0, int x1,
                                    std::uint8_t* brick_changed);

/// `project` fuses the frame; `empty` is the same for voxels known to be farther than the truncation in front
/// of every measurement that they could be projected to.
struct Kernels {
  RowKernel project;
  RowKernel empty;
};

Kernels portableKernels();
#ifdef VANTAGE_X86_KERNELS
Kernels avx2Kernels();
Kernels avx512Kernels();
#endif

namespace {

/// Running mean of D-B29's section 3, with `value` in stored units; true if the voxel changed.
[[maybe_unused]] inline bool observe(const Frame& frame, float value, Voxel& voxel) {
  const float weight = static_cast<float>(voxel.weight);
  const float sum = weight * static_cast<float>(voxel.value) + frame.observations * value;
  const float mean = sum / (weight + frame.observations);
  const float rounded = mean + 12582912.0f;  // 1.5 * 2^23: nearest integer, ties to even, in the low bits
  const auto bits = static_cast<std::int16_t>(std::bit_cast<std::uint32_t>(rounded) & 0xffffu);
  const int grown = voxel.weight + frame.increment;
  const Voxel next{bits, static_cast<std::uint16_t>(grown < frame.max_weight ? grown : frame.max_weight)};
  const bool changed = next.value != voxel.value || next.weight != voxel.weight;
  voxel = next;
  return changed;
}

/// Signed distance of voxel x of a row in stored units, at most kFull; false if the frame does not observe
/// it.
[[maybe_unused]] inline bool measure(const Frame& frame, const Row& row, int x, float& value) {
  const float at = static_cast<float>(x);
  const float z = row.z0 + at * row.dz;
  if (!(z > 0.0f)) return false;
  const float inverse = 1.0f / z;
  const float u = (row.u0 + at * row.du) * inverse, v = (row.v0 + at * row.dv) * inverse;
  if (!(u >= 0.0f && u < static_cast<float>(frame.width))) return false;
  if (!(v >= 0.0f && v < static_cast<float>(frame.height))) return false;
  const float measured = frame.range_m[static_cast<int>(v) * frame.width + static_cast<int>(u)];
  const float along = (at - frame.camera_x) * frame.voxel_m;
  const float distance = std::sqrt(along * along + row.across2_m2);
  const float units = (measured - distance) * frame.units_per_m;
  if (!(units >= -kFull)) return false;
  value = units < kFull ? units : kFull;
  return true;
}

}  // namespace
}  // namespace vantage::fusion
