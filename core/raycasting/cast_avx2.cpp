#include <immintrin.h>

#include <array>

#include "core/raycasting/cast_list.h"

namespace vantage::casting {
namespace {

/// Mask of 8 lanes, all bits of a lane alike; a type of its own so that it can't be taken for integers.
struct Mask8 {
  __m256i m;
};

/// Byte n of entry m is the n-th lane of mask m.
constexpr std::array<std::uint64_t, 256> makeLanesFirst() {
  std::array<std::uint64_t, 256> table{};
  for (unsigned mask = 0; mask < 256; ++mask)
    for (unsigned lane = 0, n = 0; lane < 8; ++lane)
      if (mask >> lane & 1) table[mask] |= std::uint64_t{lane} << (8 * n++);
  return table;
}
constexpr std::array<std::uint64_t, 256> kLanesFirst = makeLanesFirst();

/// 8 rays at a time.
struct Avx2 {
  static constexpr int kWidth = 8;
  using F = __m256;
  using I = __m256i;
  using M = Mask8;

  static F all(float x) { return _mm256_set1_ps(x); }
  static I all(int x) { return _mm256_set1_epi32(x); }
  static M none() { return {_mm256_setzero_si256()}; }
  static M lanes(unsigned bits) {
    const I bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    return {_mm256_cmpeq_epi32(_mm256_and_si256(all(static_cast<int>(bits)), bit), bit)};
  }
  static unsigned bits(M m) { return static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(m.m))); }
  static bool any(M m) { return bits(m) != 0; }
  static M both(M a, M b) { return {_mm256_and_si256(a.m, b.m)}; }
  static M either(M a, M b) { return {_mm256_or_si256(a.m, b.m)}; }
  static M differ(M a, M b) { return {_mm256_xor_si256(a.m, b.m)}; }
  static M inverse(M a) { return {_mm256_xor_si256(a.m, all(-1))}; }

  static F load(const float* from) { return _mm256_loadu_ps(from); }
  static I load(const std::uint32_t* from) { return _mm256_loadu_si256(reinterpret_cast<const I*>(from)); }
  static I load(const std::int32_t* from) { return _mm256_loadu_si256(reinterpret_cast<const I*>(from)); }
  static void store(float* to, F x) { _mm256_storeu_ps(to, x); }
  static void store(std::int32_t* to, I x) { _mm256_storeu_si256(reinterpret_cast<I*>(to), x); }
  /// The lanes of a mask first, in their order.
  static I pack(M m, I x) {
    const __m128i bytes = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(&kLanesFirst[bits(m)]));
    return _mm256_permutevar8x32_epi32(x, _mm256_cvtepu8_epi32(bytes));
  }
  static F pack(M m, F x) { return _mm256_castsi256_ps(pack(m, _mm256_castps_si256(x))); }
  static F toFloat(I x) { return _mm256_cvtepi32_ps(x); }
  static I truncate(F x) { return _mm256_cvttps_epi32(x); }
  static I floor(F x) { return _mm256_cvttps_epi32(_mm256_floor_ps(x)); }
  static F sqrt(F x) { return _mm256_sqrt_ps(x); }

  static F add(F a, F b) { return _mm256_add_ps(a, b); }
  static I add(I a, I b) { return _mm256_add_epi32(a, b); }
  static F sub(F a, F b) { return _mm256_sub_ps(a, b); }
  static I sub(I a, I b) { return _mm256_sub_epi32(a, b); }
  static F mul(F a, F b) { return _mm256_mul_ps(a, b); }
  static I mul(I a, I b) { return _mm256_mullo_epi32(a, b); }
  static F div(F a, F b) { return _mm256_div_ps(a, b); }
  static F min(F a, F b) { return _mm256_min_ps(a, b); }
  static I min(I a, I b) { return _mm256_min_epi32(a, b); }
  static I max(I a, I b) { return _mm256_max_epi32(a, b); }
  static F abs(F a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
  static I abs(I a) { return _mm256_abs_epi32(a); }
  static M less(F a, F b) { return {_mm256_castps_si256(_mm256_cmp_ps(a, b, _CMP_LT_OQ))}; }
  static M less(I a, I b) { return {_mm256_cmpgt_epi32(b, a)}; }
  static M equal(F a, F b) { return {_mm256_castps_si256(_mm256_cmp_ps(a, b, _CMP_EQ_OQ))}; }
  static M equal(I a, I b) { return {_mm256_cmpeq_epi32(a, b)}; }
  static F select(M m, F yes, F no) { return _mm256_blendv_ps(no, yes, _mm256_castsi256_ps(m.m)); }
  static I select(M m, I yes, I no) { return _mm256_blendv_epi8(no, yes, m.m); }
  static std::uint64_t sum(I x) {
    alignas(32) std::int32_t lane[8];
    _mm256_store_si256(reinterpret_cast<I*>(lane), x);
    std::uint64_t total = 0;
    for (const std::int32_t n : lane) total += static_cast<std::uint64_t>(n);
    return total;
  }
  /// Reads four bytes at each index; StateGrid::kReadMargin makes that legal.
  static I gather(const std::uint8_t* from, I at, M where) {
    const I words = _mm256_mask_i32gather_epi32(_mm256_setzero_si256(), reinterpret_cast<const int*>(from),
                                                at, where.m, 1);
    return _mm256_and_si256(words, all(0xff));
  }
};

}  // namespace

void castRowAvx2(const Bundle& bundle, const TileRow& row, Totals& totals) {
  castRow<Avx2, 2>(bundle, row, totals);
}

void castListAvx2(const Bundle& bundle, const RayList& list, const Refinement& refinement, Totals& totals) {
  castList<Avx2, 2>(bundle, list, refinement, totals);
}

}  // namespace vantage::casting
