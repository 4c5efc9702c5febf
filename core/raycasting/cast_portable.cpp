#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/raycasting/cast_list.h"

namespace vantage::casting {
namespace {

/// One ray at a time.
struct Single {
  static constexpr int kWidth = 1;
  using F = float;
  using I = std::int32_t;
  using M = bool;

  static F all(float x) { return x; }
  static I all(int x) { return x; }
  static M none() { return false; }
  static M lanes(unsigned bits) { return (bits & 1) != 0; }
  static unsigned bits(M m) { return m ? 1u : 0u; }
  static bool any(M m) { return m; }
  static M both(M a, M b) { return a && b; }
  static M either(M a, M b) { return a || b; }
  static M differ(M a, M b) { return a != b; }
  static M inverse(M a) { return !a; }

  static F load(const float* from) { return *from; }
  static I load(const std::uint32_t* from) { return static_cast<I>(*from); }
  static I load(const std::int32_t* from) { return *from; }
  static void store(float* to, F x) { *to = x; }
  static void store(std::int32_t* to, I x) { *to = x; }
  template <class T>
  static T pack(M, T x) {
    return x;
  }
  static F toFloat(I x) { return static_cast<float>(x); }
  static I truncate(F x) { return static_cast<I>(x); }
  static I floor(F x) { return static_cast<I>(std::floor(x)); }
  static F sqrt(F x) { return std::sqrt(x); }

  template <class T>
  static T add(T a, T b) {
    return a + b;
  }
  template <class T>
  static T sub(T a, T b) {
    return a - b;
  }
  template <class T>
  static T mul(T a, T b) {
    return a * b;
  }
  static F div(F a, F b) { return a / b; }
  template <class T>
  static T min(T a, T b) {
    return std::min(a, b);
  }
  template <class T>
  static T max(T a, T b) {
    return std::max(a, b);
  }
  template <class T>
  static T abs(T a) {
    return std::abs(a);
  }
  template <class T>
  static M less(T a, T b) {
    return a < b;
  }
  template <class T>
  static M equal(T a, T b) {
    return a == b;
  }
  template <class T>
  static T select(M m, T yes, T no) {
    return m ? yes : no;
  }
  static std::uint64_t sum(I x) { return static_cast<std::uint64_t>(x); }
  static I gather(const std::uint8_t* from, I at, M where) { return where ? from[at] : 0; }
};

}  // namespace

void castRowPortable(const Bundle& bundle, const TileRow& row, Totals& totals) {
  castRow<Single, 1>(bundle, row, totals);
}

void castListPortable(const Bundle& bundle, const RayList& list, const Refinement& refinement,
                      Totals& totals) {
  castList<Single, 1>(bundle, list, refinement, totals);
}

}  // namespace vantage::casting
