#include <immintrin.h>

#include "core/volume/tsdf_fusion_kernel.h"

namespace vantage::fusion {
namespace {

/// Running mean of 16 voxels, of which `lanes` are observed; `voxels` are the bits as stored.
inline __m512i observe(const Frame& frame, __m512 value, __m512i voxels, __mmask16 lanes) {
  const __m512i weight = _mm512_srli_epi32(voxels, 16);
  const __m512i stored = _mm512_srai_epi32(_mm512_slli_epi32(voxels, 16), 16);
  const __m512 w = _mm512_cvtepi32_ps(weight), n = _mm512_set1_ps(frame.observations);
  const __m512 sum = _mm512_add_ps(_mm512_mul_ps(w, _mm512_cvtepi32_ps(stored)), _mm512_mul_ps(n, value));
  const __m512i mean = _mm512_cvtps_epi32(_mm512_div_ps(sum, _mm512_add_ps(w, n)));
  const __m512i grown = _mm512_min_epi32(_mm512_add_epi32(weight, _mm512_set1_epi32(frame.increment)),
                                         _mm512_set1_epi32(frame.max_weight));
  const __m512i next =
      _mm512_or_si512(_mm512_slli_epi32(grown, 16), _mm512_and_si512(mean, _mm512_set1_epi32(0xffff)));
  return _mm512_mask_mov_epi32(voxels, lanes, next);
}

/// Stores what changed and flags the brick.
inline void put(std::uint32_t* to, __m512i before, __m512i after, std::uint8_t& flag) {
  const __mmask16 changed = _mm512_cmpneq_epi32_mask(before, after);
  if (!changed) return;
  _mm512_mask_storeu_epi32(to, changed, after);
  flag = 1;
}

inline __mmask16 laneMask(int x, int x1) {
  return x1 - x >= 16 ? static_cast<__mmask16>(0xffff) : static_cast<__mmask16>((1u << (x1 - x)) - 1);
}

std::uint32_t projectRow(const Frame& frame, const Row& row, void* row_voxels, int x0, int x1,
                         std::uint8_t* brick_changed) {
  auto* voxels = static_cast<std::uint32_t*>(row_voxels);
  const __m512 ramp = _mm512_setr_ps(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const __m512 zero = _mm512_setzero_ps(), one = _mm512_set1_ps(1.0f), full = _mm512_set1_ps(kFull);
  const __m512 width = _mm512_set1_ps(static_cast<float>(frame.width));
  const __m512 height = _mm512_set1_ps(static_cast<float>(frame.height));
  const auto affine = [](float start, float step, __m512 at) {
    return _mm512_add_ps(_mm512_set1_ps(start), _mm512_mul_ps(at, _mm512_set1_ps(step)));
  };
  std::uint32_t observed = 0;
  for (int x = x0; x < x1; x += 16) {
    const __m512 at = _mm512_add_ps(ramp, _mm512_set1_ps(static_cast<float>(x)));
    const __m512 z = affine(row.z0, row.dz, at);
    const __m512 inverse = _mm512_div_ps(one, z);
    const __m512 u = _mm512_mul_ps(affine(row.u0, row.du, at), inverse);
    const __m512 v = _mm512_mul_ps(affine(row.v0, row.dv, at), inverse);
    __mmask16 lanes = _mm512_mask_cmp_ps_mask(laneMask(x, x1), z, zero, _CMP_GT_OQ);
    lanes = _mm512_mask_cmp_ps_mask(lanes, u, zero, _CMP_GE_OQ);
    lanes = _mm512_mask_cmp_ps_mask(lanes, v, zero, _CMP_GE_OQ);
    lanes = _mm512_mask_cmp_ps_mask(lanes, u, width, _CMP_LT_OQ);
    lanes = _mm512_mask_cmp_ps_mask(lanes, v, height, _CMP_LT_OQ);
    if (!lanes) continue;
    _mm_prefetch(reinterpret_cast<const char*>(voxels + x + frame.row_pitch), _MM_HINT_T0);
    const __m512i pixel = _mm512_add_epi32(
        _mm512_mullo_epi32(_mm512_cvttps_epi32(v), _mm512_set1_epi32(frame.width)), _mm512_cvttps_epi32(u));
    const __m512 measured = _mm512_mask_i32gather_ps(zero, lanes, pixel, frame.range_m, 4);
    const __m512 along =
        _mm512_mul_ps(_mm512_sub_ps(at, _mm512_set1_ps(frame.camera_x)), _mm512_set1_ps(frame.voxel_m));
    const __m512 distance =
        _mm512_sqrt_ps(_mm512_add_ps(_mm512_mul_ps(along, along), _mm512_set1_ps(row.across2_m2)));
    const __m512 units = _mm512_mul_ps(_mm512_sub_ps(measured, distance), _mm512_set1_ps(frame.units_per_m));
    lanes = _mm512_mask_cmp_ps_mask(lanes, units, _mm512_set1_ps(-kFull), _CMP_GE_OQ);
    if (!lanes) continue;
    observed += static_cast<std::uint32_t>(__builtin_popcount(lanes));
    const __m512i before = _mm512_maskz_loadu_epi32(laneMask(x, x1), voxels + x);
    put(voxels + x, before, observe(frame, _mm512_min_ps(units, full), before, lanes), brick_changed[x >> 4]);
  }
  return observed;
}

std::uint32_t emptyRow(const Frame& frame, const Row&, void* row_voxels, int x0, int x1,
                       std::uint8_t* brick_changed) {
  auto* voxels = static_cast<std::uint32_t*>(row_voxels);
  const __m512 full = _mm512_set1_ps(kFull);
  for (int x = x0; x < x1; x += 16) {
    const __mmask16 lanes = laneMask(x, x1);
    const __m512i before = _mm512_maskz_loadu_epi32(lanes, voxels + x);
    put(voxels + x, before, observe(frame, full, before, lanes), brick_changed[x >> 4]);
  }
  return static_cast<std::uint32_t>(x1 - x0);
}

}  // namespace

Kernels avx512Kernels() {
  return {projectRow, emptyRow};
}

}  // namespace vantage::fusion
