#include <immintrin.h>

#include "core/raycasting/cast_list.h"

namespace vantage::casting {
namespace {

/// 16 rays at a time.
struct Avx512 {
  static constexpr int kWidth = 16;
  using F = __m512;
  using I = __m512i;
  using M = __mmask16;

  static F all(float x) { return _mm512_set1_ps(x); }
  static I all(int x) { return _mm512_set1_epi32(x); }
  static M none() { return 0; }
  static M lanes(unsigned bits) { return static_cast<M>(bits); }
  static unsigned bits(M m) { return m; }
  static bool any(M m) { return m != 0; }
  static M both(M a, M b) { return _kand_mask16(a, b); }
  static M either(M a, M b) { return _kor_mask16(a, b); }
  static M differ(M a, M b) { return _kxor_mask16(a, b); }
  static M inverse(M a) { return _knot_mask16(a); }

  static F load(const float* from) { return _mm512_loadu_ps(from); }
  static I load(const std::uint32_t* from) { return _mm512_loadu_si512(from); }
  static I load(const std::int32_t* from) { return _mm512_loadu_si512(from); }
  static void store(float* to, F x) { _mm512_storeu_ps(to, x); }
  static void store(std::int32_t* to, I x) { _mm512_storeu_si512(to, x); }
  /// The lanes of a mask first, in their order.
  static F pack(M m, F x) { return _mm512_maskz_compress_ps(m, x); }
  static I pack(M m, I x) { return _mm512_maskz_compress_epi32(m, x); }
  static F toFloat(I x) { return _mm512_cvtepi32_ps(x); }
  static I truncate(F x) { return _mm512_cvttps_epi32(x); }
  static I floor(F x) { return _mm512_cvt_roundps_epi32(x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); }
  static F sqrt(F x) { return _mm512_sqrt_ps(x); }

  static F add(F a, F b) { return _mm512_add_ps(a, b); }
  static I add(I a, I b) { return _mm512_add_epi32(a, b); }
  static F sub(F a, F b) { return _mm512_sub_ps(a, b); }
  static I sub(I a, I b) { return _mm512_sub_epi32(a, b); }
  static F mul(F a, F b) { return _mm512_mul_ps(a, b); }
  static I mul(I a, I b) { return _mm512_mullo_epi32(a, b); }
  static F div(F a, F b) { return _mm512_div_ps(a, b); }
  static F min(F a, F b) { return _mm512_min_ps(a, b); }
  static I min(I a, I b) { return _mm512_min_epi32(a, b); }
  static I max(I a, I b) { return _mm512_max_epi32(a, b); }
  static F abs(F a) { return _mm512_abs_ps(a); }
  static I abs(I a) { return _mm512_abs_epi32(a); }
  static M less(F a, F b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
  static M less(I a, I b) { return _mm512_cmplt_epi32_mask(a, b); }
  static M equal(F a, F b) { return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
  static M equal(I a, I b) { return _mm512_cmpeq_epi32_mask(a, b); }
  static F select(M m, F yes, F no) { return _mm512_mask_mov_ps(no, m, yes); }
  static I select(M m, I yes, I no) { return _mm512_mask_mov_epi32(no, m, yes); }
  static std::uint64_t sum(I x) { return static_cast<std::uint64_t>(_mm512_reduce_add_epi32(x)); }
  /// Reads four bytes at each index; StateGrid::kReadMargin makes that legal.
  static I gather(const std::uint8_t* from, I at, M where) {
    const I words = _mm512_mask_i32gather_epi32(_mm512_setzero_si512(), where, at, from, 1);
    return _mm512_and_si512(words, _mm512_set1_epi32(0xff));
  }
};

}  // namespace

void castRowAvx512(const Bundle& bundle, const TileRow& row, Totals& totals) {
  castRow<Avx512, 2>(bundle, row, totals);
}

void castListAvx512(const Bundle& bundle, const RayList& list, const Refinement& refinement, Totals& totals) {
  castList<Avx512, 2>(bundle, list, refinement, totals);
}

}  // namespace vantage::casting
