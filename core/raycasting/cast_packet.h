#pragma once

// The jumping walk, written once for any number of lanes. `L` offers vectors of floats (F), of 32-bit
// integers (I) and masks (M) and their arithmetic; everything here has internal linkage because each
// translation unit compiles it for another instruction set.

#include <cstdint>

#include "core/raycasting/cast_kernel.h"

namespace vantage::casting {
namespace {

/// Rays of a packet: geometry, where they end, and where they are.
template <class L>
struct Packet {
  using F = typename L::F;
  using I = typename L::I;
  using M = typename L::M;

  F d[3], inverse[3];
  M forward[3];
  F length;  ///< of a metre of depth
  F near_t, end_t;
  I end_axis;  ///< axis through whose border the ray leaves the grid, 3 = it ends at the maximum range
  I at[3];     ///< current voxel
  I first[3];  ///< first voxel inside the grid
  F t;         ///< entry into the current voxel
  M live, hit, entered;
  F slope_x, slope_y;
  I ray;  ///< place in family order, if the packet is one of a list
};

/// True where plane `plane` of `axis` is crossed before or at the event (t, event_axis).
template <class L>
typename L::M crossed(const Bundle& b, const Packet<L>& p, int axis, typename L::I plane, typename L::F t,
                      typename L::I event_axis) {
  const auto when = L::mul(L::sub(L::toFloat(plane), L::all(b.origin[axis])), p.inverse[axis]);
  return L::either(L::less(when, t), L::both(L::equal(when, t), L::less(L::all(axis), event_axis)));
}

/// Index along `axis` after the event (t, event_axis), exactly; `guess` may be off by one.
template <class L>
typename L::I corrected(const Bundle& b, const Packet<L>& p, int axis, typename L::I guess, typename L::F t,
                        typename L::I event_axis) {
  const auto one = L::all(1);
  const auto low = crossed<L>(b, p, axis, guess, t, event_axis);
  const auto high = crossed<L>(b, p, axis, L::add(guess, one), t, event_axis);
  // Forward: plane i is crossed and i+1 is not. Backward: plane i+1 is crossed and i is not.
  const auto down = L::differ(p.forward[axis], low);
  const auto up = L::inverse(L::differ(p.forward[axis], high));
  guess = L::select(down, L::sub(guess, one), L::select(up, L::add(guess, one), guess));
  return L::select(p.forward[axis], L::max(guess, p.at[axis]), L::min(guess, p.at[axis]));
}

template <class L>
typename L::F position(const Bundle& b, const Packet<L>& p, int axis, typename L::F t) {
  return L::add(L::all(b.origin[axis]), L::mul(p.d[axis], t));
}

template <class L>
void aim(const Bundle& b, const float* slope_x, const float* slope_y, Packet<L>& p) {
  const auto x = L::load(slope_x), y = L::load(slope_y);
  p.slope_x = x;
  p.slope_y = y;
  const auto length = L::sqrt(L::add(L::add(L::mul(x, x), L::mul(y, y)), L::all(1.0f)));
  p.length = length;
  p.near_t = L::div(L::all(b.min_range_m), length);
  p.end_t = L::all(3e38f);
  p.end_axis = L::all(3);
  for (int a = 0; a < 3; ++a) {
    const auto d = L::add(L::add(L::all(b.axis[2][a]), L::mul(x, L::all(b.axis[0][a]))),
                          L::mul(y, L::all(b.axis[1][a])));
    const auto flat = L::less(L::abs(d), L::all(kFlat));
    p.d[a] = L::select(flat, L::all(0.0f), d);
    p.inverse[a] = L::select(flat, L::all(kNever), L::div(L::all(1.0f), L::select(flat, L::all(1.0f), d)));
    p.forward[a] = L::inverse(L::less(p.d[a], L::all(0.0f)));
    const auto border = L::select(p.forward[a], L::all(static_cast<float>(b.grid.size[a])), L::all(0.0f));
    const auto when = L::mul(L::sub(border, L::all(b.origin[a])), p.inverse[a]);
    const auto sooner = L::less(when, p.end_t);
    p.end_t = L::select(sooner, when, p.end_t);
    p.end_axis = L::select(sooner, L::all(a), p.end_axis);
    p.at[a] = L::all(b.start[a]);
  }
  const auto range_t = L::div(L::all(b.max_range_m), length);
  const auto shorter = L::less(range_t, p.end_t);
  p.end_t = L::select(shorter, range_t, p.end_t);
  p.end_axis = L::select(shorter, L::all(3), p.end_axis);
}

/// Takes rays from an origin outside to their first voxel inside; p.entered tells which have one.
template <class L>
void enter(const Bundle& b, Packet<L>& p) {
  auto t = L::all(-1.0f);
  auto axis = L::all(-1);
  auto away = L::none();
  for (int a = 0; a < 3; ++a) {
    if (b.start[a] >= 0 && b.start[a] < b.grid.size[a]) continue;
    const auto toward = b.start[a] < 0 ? p.forward[a] : L::inverse(p.forward[a]);
    away = L::either(away, L::inverse(toward));
    const float border = b.start[a] < 0 ? 0.0f : static_cast<float>(b.grid.size[a]);
    const auto when = L::mul(L::all(border - b.origin[a]), p.inverse[a]);
    const auto later = L::inverse(L::less(when, t));
    t = L::select(later, when, t);
    axis = L::select(later, L::all(a), axis);
  }
  const auto before_end =
      L::either(L::less(t, p.end_t), L::both(L::equal(t, p.end_t), L::less(axis, p.end_axis)));
  p.entered = L::both(p.entered, L::both(before_end, L::inverse(away)));
  t = L::select(p.entered, t, L::all(0.0f));
  for (int a = 0; a < 3; ++a) {
    const auto guess = L::floor(position<L>(b, p, a, t));
    const auto through = L::all(b.start[a] < 0 ? 0 : b.grid.size[a] - 1);
    const auto index = L::select(L::equal(axis, L::all(a)), through, corrected<L>(b, p, a, guess, t, axis));
    p.at[a] = L::select(p.entered, index, L::all(0));
  }
  p.t = t;
}

template <class L>
void start(const Bundle& b, const float* slope_x, const float* slope_y, unsigned lanes, Packet<L>& p) {
  aim<L>(b, slope_x, slope_y, p);
  p.entered = L::lanes(lanes);
  p.t = L::all(0.0f);
  p.hit = L::none();
  const auto outside = [&](int a) { return b.start[a] < 0 || b.start[a] >= b.grid.size[a]; };
  if (outside(0) || outside(1) || outside(2)) enter<L>(b, p);
  for (int a = 0; a < 3; ++a) p.first[a] = p.at[a];
  p.live = p.entered;
}

template <class L>
typename L::F centerDistance2(const Bundle& b, const Packet<L>& p) {
  const auto x = L::sub(L::toFloat(p.at[0]), L::all(b.region.center[0]));
  const auto y = L::sub(L::toFloat(p.at[1]), L::all(b.region.center[1]));
  const auto z = L::sub(L::toFloat(p.at[2]), L::all(b.region.center[2]));
  return L::add(L::add(L::mul(x, x), L::mul(y, y)), L::mul(z, z));
}

template <class L>
typename L::M inBounds(const Bundle& b, const Packet<L>& p) {
  auto outside = L::none();
  for (int a = 0; a < 3; ++a)
    outside = L::either(outside, L::either(L::less(p.at[a], L::all(b.region.low[a])),
                                           L::less(L::all(b.region.high[a]), p.at[a])));
  return L::inverse(outside);
}

template <class L>
typename L::M inSphere(const Bundle& b, typename L::F distance2) {
  return L::inverse(L::less(L::all(b.region.radius2), distance2));
}

template <class L>
typename L::I linear(const Bundle& b, const Packet<L>& p) {
  return L::add(p.at[0],
                L::mul(L::all(b.grid.size[0]), L::add(p.at[1], L::mul(L::all(b.grid.size[1]), p.at[2]))));
}

/// Rays that stand on voxels outside the region and go through those that are unknown.
template <class L>
typename L::M goThrough(const Bundle& b, const Packet<L>& p, typename L::I voxel, typename L::M standing) {
  const auto counts = L::both(inBounds<L>(b, p), inSphere<L>(b, centerDistance2<L>(b, p)));
  const auto unknown = L::equal(L::gather(b.grid.states, voxel, standing), L::all(0));
  return L::both(standing, L::both(unknown, L::inverse(counts)));
}

/// Ends the rays that stand on a voxel that stops them; returns the radius by which the others may jump.
template <class L>
typename L::I stop(const Bundle& b, Packet<L>& p, typename L::I voxel, typename L::I radius) {
  auto standing = L::both(p.live, L::equal(radius, L::all(0)));
  if (b.transparent && L::any(standing)) {
    const auto through = goThrough<L>(b, p, voxel, standing);
    radius = L::select(through, L::all(1), radius);
    standing = L::both(standing, L::inverse(through));
  }
  p.hit = L::either(p.hit, standing);
  p.live = L::both(p.live, L::inverse(standing));
  return radius;
}

/// Moves each live ray out of the free cube around its voxel.
template <class L>
void jump(const Bundle& b, Packet<L>& p, typename L::I radius) {
  typename L::I face[3];
  typename L::F when[3];
  const auto back = L::sub(L::all(1), radius);
  for (int a = 0; a < 3; ++a) {
    face[a] = L::add(p.at[a], L::select(p.forward[a], radius, back));
    when[a] = L::mul(L::sub(L::toFloat(face[a]), L::all(b.origin[a])), p.inverse[a]);
  }
  const auto t = L::min(when[0], L::min(when[1], when[2]));
  typename L::M through[3];
  through[0] = L::equal(when[0], t);
  through[1] = L::both(L::inverse(through[0]), L::equal(when[1], t));
  through[2] = L::inverse(L::either(through[0], through[1]));

  const auto axisOfEvent = [&] {
    return L::select(through[0], L::all(0), L::select(through[1], L::all(1), L::all(2)));
  };
  if (const auto late = L::both(p.live, L::inverse(L::less(t, p.end_t))); L::any(late)) {
    const auto before = L::both(L::equal(t, p.end_t), L::less(axisOfEvent(), p.end_axis));
    p.live = L::both(p.live, L::inverse(L::both(late, L::inverse(before))));
    if (!L::any(p.live)) return;
  }

  typename L::I guess[3];
  auto doubtful = L::none();
  for (int a = 0; a < 3; ++a) {
    const auto where = position<L>(b, p, a, t);
    guess[a] = L::truncate(where);
    const auto part = L::sub(where, L::toFloat(guess[a]));
    const auto close = L::either(L::less(part, L::all(b.doubt)), L::less(L::all(1.0f - b.doubt), part));
    doubtful = L::either(doubtful, L::both(close, L::inverse(through[a])));
  }
  if (L::any(L::both(p.live, doubtful))) {
    const auto axis = axisOfEvent();
    for (int a = 0; a < 3; ++a) guess[a] = corrected<L>(b, p, a, guess[a], t, axis);
  }
  for (int a = 0; a < 3; ++a) {
    const auto beyond = L::select(p.forward[a], face[a], L::sub(face[a], L::all(1)));
    p.at[a] = L::select(p.live, L::select(through[a], beyond, guess[a]), p.at[a]);
  }
  p.t = L::select(p.live, t, p.t);
}

/// Rays without a hit: to the last voxel that a plain walk visits.
template <class L>
void finish(const Bundle& b, Packet<L>& p) {
  const auto missed = L::both(p.entered, L::inverse(p.hit));
  if (!L::any(missed)) return;
  for (int a = 0; a < 3; ++a) {
    const auto guess = L::floor(position<L>(b, p, a, p.end_t));
    const auto border = L::select(p.forward[a], L::all(b.grid.size[a] - 1), L::all(0));
    const auto last =
        L::select(L::equal(p.end_axis, L::all(a)), border, corrected<L>(b, p, a, guess, p.end_t, p.end_axis));
    p.at[a] = L::select(missed, last, p.at[a]);
  }
}

/// Voxels that plain walks of the rays visit.
template <class L>
std::uint64_t visits(const Packet<L>& p) {
  auto steps = L::all(1);
  for (int a = 0; a < 3; ++a) steps = L::add(steps, L::abs(L::sub(p.at[a], p.first[a])));
  return L::sum(L::select(p.entered, steps, L::all(0)));
}

/// Hits on unknown voxels.
template <class L>
typename L::M unknownHits(const Bundle& b, const Packet<L>& p) {
  return L::both(p.hit, L::equal(L::gather(b.grid.states, linear<L>(b, p), p.hit), L::all(0)));
}

/// Counts the hits of a packet.
template <class L>
void collect(const Bundle& b, Packet<L>& p, Totals& totals) {
  finish<L>(b, p);
  totals.visited += visits<L>(p);

  const auto counted = L::both(L::both(p.hit, L::inverse(L::less(p.t, p.near_t))), inBounds<L>(b, p));
  const auto distance2 = centerDistance2<L>(b, p);
  const auto inside = L::both(counted, inSphere<L>(b, distance2));
  const auto unknown = unknownHits<L>(b, p);
  const auto far_unknown = L::both(unknown, L::inverse(L::less(p.t, p.near_t)));
  const auto seen = L::bits(L::both(inside, unknown));
  const auto all = L::bits(inside);
  totals.unknown += __builtin_popcount(seen);
  totals.unknown_outside += __builtin_popcount(L::bits(far_unknown)) - __builtin_popcount(seen);
  totals.occupied += __builtin_popcount(all) - __builtin_popcount(seen);
  if (!totals.hits) return;

  std::int32_t voxel[L::kWidth];
  float distance[L::kWidth];
  L::store(voxel, linear<L>(b, p));
  L::store(distance, distance2);
  const unsigned unknown_bits = L::bits(unknown);
  for (unsigned left = L::bits(counted); left; left &= left - 1) {
    const int k = __builtin_ctz(left);
    totals.hits->push_back({voxel[k], distance[k], ((unknown_bits >> k) & 1) != 0, ((all >> k) & 1) != 0});
  }
}

/// Packets of a row of tiles, one after the other.
template <class L>
class TilePackets {
 public:
  TilePackets(const Bundle& bundle, const TileRow& row, Totals& totals)
      : bundle_(bundle), row_(row), totals_(totals) {}

  /// Starts the next packet that has rays; false if none is left.
  bool next(Packet<L>& p) {
    constexpr unsigned kMask = (1u << L::kWidth) - 1;
    while (tile_ < row_.tiles) {
      const int tile = tile_, part = part_;
      part_ = (part_ + L::kWidth) % 16;
      if (part_ == 0) ++tile_;
      const unsigned lanes = (row_.lanes[tile] >> part) & kMask;
      if (!lanes) continue;
      start<L>(bundle_, row_.slope_x + 16 * tile + part, row_.slope_y + row_.stride_y * tile + part, lanes,
               p);
      return true;
    }
    return false;
  }
  void thin(Packet<L>&) {}
  void take(Packet<L>& p) { collect<L>(bundle_, p, totals_); }

 private:
  const Bundle& bundle_;
  const TileRow& row_;
  Totals& totals_;
  int tile_ = 0, part_ = 0;
};

/// Casts packets with `kPackets` on their way at a time: while one waits for memory the others go on.
template <class L, int kPackets, class Packets>
void castPackets(const Bundle& b, Packets& source) {
  Packet<L> packets[kPackets];
  int flying = 0;
  while (flying < kPackets && source.next(packets[flying])) ++flying;
  while (flying > 0) {
    for (int n = 0; n < flying; ++n) {
      Packet<L>& p = packets[n];
      if (L::any(p.live)) {
        const auto voxel = linear<L>(b, p);
        const auto radius = stop<L>(b, p, voxel, L::gather(b.grid.radius, voxel, p.live));
        jump<L>(b, p, radius);
        source.thin(p);
        continue;
      }
      source.take(p);
      if (source.next(p)) continue;
      if (n != flying - 1) p = packets[flying - 1];
      --flying;
    }
  }
}

template <class L, int kPackets>
void castRow(const Bundle& b, const TileRow& row, Totals& totals) {
  TilePackets<L> source(b, row, totals);
  castPackets<L, kPackets>(b, source);
}

}  // namespace
}  // namespace vantage::casting
