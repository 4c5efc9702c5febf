#include <immintrin.h>

#include "core/volume/tsdf_fusion_kernel.h"

namespace vantage::fusion {
namespace {

inline __m256 both(__m256 a, __m256 b) {
  return _mm256_and_ps(a, b);
}

/// Lanes of the voxels x..x+7 that lie before x1, all bits of a lane alike.
inline __m256 laneMask(int x, int x1) {
  const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  return _mm256_castsi256_ps(_mm256_cmpgt_epi32(_mm256_set1_epi32(x1 - x), lane));
}

/// Running mean of 8 voxels, of which `lanes` are observed; `voxels` are the bits as stored.
inline __m256i observe(const Frame& frame, __m256 value, __m256i voxels, __m256 lanes) {
  const __m256i weight = _mm256_srli_epi32(voxels, 16);
  const __m256i stored = _mm256_srai_epi32(_mm256_slli_epi32(voxels, 16), 16);
  const __m256 w = _mm256_cvtepi32_ps(weight), n = _mm256_set1_ps(frame.observations);
  const __m256 sum = _mm256_add_ps(_mm256_mul_ps(w, _mm256_cvtepi32_ps(stored)), _mm256_mul_ps(n, value));
  const __m256i mean = _mm256_cvtps_epi32(_mm256_div_ps(sum, _mm256_add_ps(w, n)));
  const __m256i grown = _mm256_min_epi32(_mm256_add_epi32(weight, _mm256_set1_epi32(frame.increment)),
                                         _mm256_set1_epi32(frame.max_weight));
  const __m256i next =
      _mm256_or_si256(_mm256_slli_epi32(grown, 16), _mm256_and_si256(mean, _mm256_set1_epi32(0xffff)));
  return _mm256_blendv_epi8(voxels, next, _mm256_castps_si256(lanes));
}

/// Stores what changed and flags the brick.
inline void put(std::uint32_t* to, __m256i before, __m256i after, std::uint8_t& flag) {
  const __m256i same = _mm256_cmpeq_epi32(before, after);
  if (_mm256_movemask_epi8(same) == -1) return;
  const __m256i changed = _mm256_xor_si256(same, _mm256_set1_epi32(-1));
  _mm256_maskstore_epi32(reinterpret_cast<int*>(to), changed, after);
  flag = 1;
}

inline __m256i take(const std::uint32_t* from, __m256 lanes) {
  return _mm256_maskload_epi32(reinterpret_cast<const int*>(from), _mm256_castps_si256(lanes));
}

std::uint32_t projectRow(const Frame& frame, const Row& row, void* row_voxels, int x0, int x1,
                         std::uint8_t* brick_changed) {
  auto* voxels = static_cast<std::uint32_t*>(row_voxels);
  const __m256 ramp = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256 zero = _mm256_setzero_ps(), one = _mm256_set1_ps(1.0f), full = _mm256_set1_ps(kFull);
  const __m256 width = _mm256_set1_ps(static_cast<float>(frame.width));
  const __m256 height = _mm256_set1_ps(static_cast<float>(frame.height));
  const auto affine = [](float start, float step, __m256 at) {
    return _mm256_add_ps(_mm256_set1_ps(start), _mm256_mul_ps(at, _mm256_set1_ps(step)));
  };
  std::uint32_t observed = 0;
  for (int x = x0; x < x1; x += 8) {
    const __m256 at = _mm256_add_ps(ramp, _mm256_set1_ps(static_cast<float>(x)));
    const __m256 z = affine(row.z0, row.dz, at);
    const __m256 inverse = _mm256_div_ps(one, z);
    const __m256 u = _mm256_mul_ps(affine(row.u0, row.du, at), inverse);
    const __m256 v = _mm256_mul_ps(affine(row.v0, row.dv, at), inverse);
    const __m256 valid = laneMask(x, x1);
    __m256 lanes = both(valid, _mm256_cmp_ps(z, zero, _CMP_GT_OQ));
    lanes = both(lanes, both(_mm256_cmp_ps(u, zero, _CMP_GE_OQ), _mm256_cmp_ps(u, width, _CMP_LT_OQ)));
    lanes = both(lanes, both(_mm256_cmp_ps(v, zero, _CMP_GE_OQ), _mm256_cmp_ps(v, height, _CMP_LT_OQ)));
    if (!_mm256_movemask_ps(lanes)) continue;
    const __m256i pixel = _mm256_add_epi32(
        _mm256_mullo_epi32(_mm256_cvttps_epi32(v), _mm256_set1_epi32(frame.width)), _mm256_cvttps_epi32(u));
    const __m256 measured = _mm256_mask_i32gather_ps(zero, frame.range_m, pixel, lanes, 4);
    const __m256 along =
        _mm256_mul_ps(_mm256_sub_ps(at, _mm256_set1_ps(frame.camera_x)), _mm256_set1_ps(frame.voxel_m));
    const __m256 distance =
        _mm256_sqrt_ps(_mm256_add_ps(_mm256_mul_ps(along, along), _mm256_set1_ps(row.across2_m2)));
    const __m256 units = _mm256_mul_ps(_mm256_sub_ps(measured, distance), _mm256_set1_ps(frame.units_per_m));
    lanes = both(lanes, _mm256_cmp_ps(units, _mm256_set1_ps(-kFull), _CMP_GE_OQ));
    const auto bits = static_cast<unsigned>(_mm256_movemask_ps(lanes));
    if (!bits) continue;
    observed += static_cast<std::uint32_t>(__builtin_popcount(bits));
    const __m256i before = take(voxels + x, valid);
    put(voxels + x, before, observe(frame, _mm256_min_ps(units, full), before, lanes), brick_changed[x >> 4]);
  }
  return observed;
}

std::uint32_t emptyRow(const Frame& frame, const Row&, void* row_voxels, int x0, int x1,
                       std::uint8_t* brick_changed) {
  auto* voxels = static_cast<std::uint32_t*>(row_voxels);
  const __m256 full = _mm256_set1_ps(kFull);
  for (int x = x0; x < x1; x += 8) {
    const __m256 lanes = laneMask(x, x1);
    const __m256i before = take(voxels + x, lanes);
    put(voxels + x, before, observe(frame, full, before, lanes), brick_changed[x >> 4]);
  }
  return static_cast<std::uint32_t>(x1 - x0);
}

}  // namespace

Kernels avx2Kernels() {
  return {projectRow, emptyRow};
}

}  // namespace vantage::fusion
