#pragma once

// Lists of rays that start on their way, and what becomes of them on a coarse level; see cast_packet.h.

#include <cstdint>
#include <cstring>

#include "core/raycasting/cast_packet.h"

namespace vantage::casting {
namespace {

/// Takes rays on to where they start: all crossings up to there are done, and no others.
template <class L>
void resume(const Bundle& b, typename L::F start_m, Packet<L>& p) {
  const auto t = L::div(start_m, p.length);
  const auto later = L::both(L::less(L::all(0.0f), t), L::inverse(L::less(t, p.t)));
  p.entered = L::both(p.entered, L::inverse(L::both(later, L::less(p.end_t, t))));
  typename L::I at[3];
  auto doubtful = L::none();
  for (int a = 0; a < 3; ++a) {
    const auto where = position<L>(b, p, a, t);
    at[a] = L::floor(where);
    const auto part = L::sub(where, L::toFloat(at[a]));
    doubtful =
        L::either(doubtful, L::either(L::less(part, L::all(b.doubt)), L::less(L::all(1.0f - b.doubt), part)));
  }
  if (L::any(L::both(L::both(later, p.entered), doubtful)))
    for (int a = 0; a < 3; ++a) at[a] = corrected<L>(b, p, a, at[a], t, L::all(3));
  auto outside = L::none();
  for (int a = 0; a < 3; ++a) {
    p.at[a] = L::select(later, at[a], p.at[a]);
    outside = L::either(outside,
                        L::either(L::less(p.at[a], L::all(0)), L::less(L::all(b.grid.size[a] - 1), p.at[a])));
  }
  p.entered = L::both(p.entered, L::inverse(outside));
  p.t = L::select(later, t, p.t);
  for (int a = 0; a < 3; ++a) p.first[a] = p.at[a];
  p.live = p.entered;
}

/// Sum of the finest rays below some rays of a packet.
inline std::uint64_t leavesOf(const RayFamily* families, const std::int32_t* ray, unsigned lanes) {
  std::uint64_t leaves = 0;
  for (; lanes; lanes &= lanes - 1) leaves += families[ray[__builtin_ctz(lanes)]].leaves;
  return leaves;
}

/// Appends the children of one ray, eight at a time: what is too much is overwritten by the next.
inline void refine(const Refinement& r, const RayFamily& family, float start_m, ChildList& out) {
  constexpr std::uint32_t kAtOnce = 8;
  for (std::uint32_t c = 0; c < family.children; c += kAtOnce) {
    const std::uint32_t from = family.first_child + c, to = out.count + c;
    float starts[kAtOnce];
    std::uint32_t rays[kAtOnce];
    for (std::uint32_t k = 0; k < kAtOnce; ++k) {
      starts[k] = start_m;
      rays[k] = from + k;
    }
    std::memcpy(out.slope_x + to, r.child_slope_x + from, sizeof starts);
    std::memcpy(out.slope_y + to, r.child_slope_y + from, sizeof starts);
    std::memcpy(out.start_m + to, starts, sizeof starts);
    std::memcpy(out.ray + to, rays, sizeof rays);
  }
  out.count += family.children;
}

/// What becomes of the rays of a coarse level: they are refined, or count for all finest rays below them.
template <class L>
void descend(const Bundle& b, Packet<L>& p, const Refinement& r, Totals& totals) {
  finish<L>(b, p);
  totals.visited += visits<L>(p);
  if (!L::any(p.hit)) return;
  auto own = p.hit;  // the node that holds the sensor (D-A12)
  for (int a = 0; a < 3; ++a) own = L::both(own, L::equal(p.at[a], L::all(b.start[a])));
  const auto near = L::less(p.t, p.near_t);
  const auto counts = L::both(inBounds<L>(b, p), inSphere<L>(b, centerDistance2<L>(b, p)));
  const auto closed = L::both(p.hit, L::inverse(own));
  const unsigned unknown = L::bits(unknownHits<L>(b, p));
  const unsigned in = L::bits(L::both(closed, counts)), too_near = L::bits(near);
  const unsigned out = L::bits(closed) & ~in & ~too_near;
  std::int32_t ray[L::kWidth];
  L::store(ray, p.ray);
  totals.unknown_outside += leavesOf(r.families, ray, out & unknown);  // D-A8, D-A9
  unsigned refined = in;
  if (!r.refine_unknown) {
    const unsigned whole = in & unknown & ~too_near;
    totals.unknown += leavesOf(r.families, ray, whole);  // D-A14: also for those that would have passed it
    refined &= ~whole;
  }
  refined |= L::bits(own);
  if (!refined) return;
  float start_m[L::kWidth];
  const auto begin = L::sub(L::mul(p.t, p.length), L::all(r.step_back_m));  // D-A11
  L::store(start_m, L::select(L::less(begin, L::all(0.0f)), L::all(0.0f), begin));
  ChildList children = *r.children;
  for (; refined; refined &= refined - 1) {
    const int k = __builtin_ctz(refined);
    refine(r, r.families[ray[k]], start_m[k], children);
  }
  r.children->count = children.count;
}

/// Rays on their way that were taken out of packets with few of them left, to be packed anew.
template <class L>
class StrayRays {
 public:
  int count() const { return count_; }
  bool isFull() const { return count_ >= L::kWidth; }

  /// Takes the live rays out of a packet. \pre !isFull()
  void take(Packet<L>& p) {
    const auto live = p.live;
    L::store(slope_x_ + count_, L::pack(live, p.slope_x));
    L::store(slope_y_ + count_, L::pack(live, p.slope_y));
    L::store(t_ + count_, L::pack(live, p.t));
    L::store(ray_ + count_, L::pack(live, p.ray));
    for (int a = 0; a < 3; ++a) {
      L::store(at_[a] + count_, L::pack(live, p.at[a]));
      L::store(first_[a] + count_, L::pack(live, p.first[a]));
    }
    count_ += __builtin_popcount(L::bits(live));
    p.entered = L::both(p.entered, L::inverse(live));
    p.live = L::none();
  }

  /// A packet of the last rays taken. \pre count() > 0
  void give(const Bundle& b, Packet<L>& p) {
    const int lanes = isFull() ? L::kWidth : count_;
    count_ -= lanes;
    aim<L>(b, slope_x_ + count_, slope_y_ + count_, p);
    p.t = L::load(t_ + count_);
    p.ray = L::load(ray_ + count_);
    for (int a = 0; a < 3; ++a) {
      p.at[a] = L::load(at_[a] + count_);
      p.first[a] = L::load(first_[a] + count_);
    }
    p.hit = L::none();
    p.entered = p.live = L::lanes((1u << lanes) - 1);
  }

 private:
  static constexpr int kRoom = 2 * L::kWidth;  ///< a whole packet is stored at any count below kWidth
  float slope_x_[kRoom] = {}, slope_y_[kRoom] = {}, t_[kRoom] = {};
  std::int32_t ray_[kRoom] = {}, at_[3][kRoom] = {}, first_[3][kRoom] = {};
  int count_ = 0;
};

/// Packets of a list of rays, one after the other. Rays that outlive most of their packet are packed anew:
/// beside an object some rays hit it at once, and others go on to the wall.
template <class L>
class ListPackets {
 public:
  ListPackets(const Bundle& bundle, const RayList& list, const Refinement& refinement, Totals& totals)
      : bundle_(bundle), list_(list), refinement_(refinement), totals_(totals) {}

  bool next(Packet<L>& p) {
    constexpr unsigned kMask = (1u << L::kWidth) - 1;
    while (first_ < list_.count && !strays_.isFull()) {
      const std::uint32_t first = first_;
      first_ += L::kWidth;
      const std::uint32_t left = list_.count - first;
      unsigned lanes = left < L::kWidth ? (1u << left) - 1 : kMask;
      if (list_.lanes) lanes &= list_.lanes[first / 16] >> (first % 16);
      if (!lanes) continue;
      p.ray = L::load(list_.ray + first);
      start<L>(bundle_, list_.slope_x + first, list_.slope_y + first, lanes, p);
      if (list_.start_m) resume<L>(bundle_, L::load(list_.start_m + first), p);
      return true;
    }
    if (strays_.count() == 0) return false;
    strays_.give(bundle_, p);
    return true;
  }

  /// Called after every step.
  void thin(Packet<L>& p) {
    if constexpr (L::kWidth > 1) {
      const int live = __builtin_popcount(L::bits(p.live));
      if (live > kFew || live == 0 || strays_.isFull()) return;
      if (first_ < list_.count || strays_.count() + live >= L::kWidth) strays_.take(p);
    }
  }

  void take(Packet<L>& p) {
    if (refinement_.families)
      descend<L>(bundle_, p, refinement_, totals_);
    else
      collect<L>(bundle_, p, totals_);
  }

 private:
  static constexpr int kFew = L::kWidth / 2;  ///< rays
  const Bundle& bundle_;
  const RayList& list_;
  const Refinement& refinement_;
  Totals& totals_;
  std::uint32_t first_ = 0;
  StrayRays<L> strays_;
};

template <class L, int kPackets>
void castList(const Bundle& b, const RayList& list, const Refinement& refinement, Totals& totals) {
  ListPackets<L> source(b, list, refinement, totals);
  castPackets<L, kPackets>(b, source);
}

}  // namespace
}  // namespace vantage::casting
