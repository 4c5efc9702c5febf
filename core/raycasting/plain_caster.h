#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "core/raycasting/cast_kernel.h"

namespace vantage::casting {

/// A ray in grid coordinates, where voxel i covers [i, i+1); Real = float walks exactly like the kernels.
template <class Real>
struct PlainRay {
  Real origin[3], direction[3];
  Real end;        ///< largest parameter of an entry that still counts
  Real start = 0;  ///< walks from the voxel in which the ray is here: all crossings up to it are done
};

/// Where a plain walk ended.
template <class Real>
struct PlainHit {
  bool hit = false;
  int voxel[3] = {};
  Real t = 0;                 ///< parameter of the entry into the voxel, at least the start's
  std::uint64_t visited = 0;  ///< voxels of the grid, the hit included
};

/// Plane by plane to the voxel in which the ray is at its start.
template <class Real>
void walkToStart(const PlainRay<Real>& ray, const int (&step)[3], const Real (&inverse)[3], int (&at)[3]) {
  for (int a = 0; a < 3; ++a) {
    const int first = at[a];
    const auto crossed = [&](int plane) {
      return (static_cast<Real>(plane) - ray.origin[a]) * inverse[a] <= ray.start;
    };
    const Real direction = inverse[a] == Real(kNever) ? Real(0) : ray.direction[a];
    at[a] = static_cast<int>(std::floor(ray.origin[a] + direction * ray.start));
    if ((at[a] - first) * step[a] < 0) at[a] = first;
    // The plane in front, and the one behind.
    while (crossed(step[a] > 0 ? at[a] + 1 : at[a])) at[a] += step[a];
    while (at[a] != first && !crossed(step[a] > 0 ? at[a] : at[a] + 1)) at[a] -= step[a];
  }
}

template <class Real, class Stops>
bool stopsAt(Stops& stops, const int (&at)[3], Real t) {
  if constexpr (std::is_invocable_v<Stops&, int, int, int, Real>)
    return stops(at[0], at[1], at[2], t);
  else
    return stops(at[0], at[1], at[2]);
}

/// Voxel by voxel along a ray until `stops(i, j, k)` is true inside the grid, the ray ends, or it can no
/// longer meet the grid. Crossings are taken in the order of (T, axis). `stops` may take the parameter of the
/// entry into the voxel as well.
template <class Real, class Stops>
PlainHit<Real> walkPlainly(const int (&size)[3], const PlainRay<Real>& ray, Stops stops) {
  int at[3], step[3];
  Real inverse[3];
  for (int a = 0; a < 3; ++a) {
    const bool flat = ray.direction[a] < kFlat && ray.direction[a] > -kFlat;
    const Real floor = std::floor(ray.origin[a]);
    at[a] = static_cast<int>(floor);
    step[a] = !flat && ray.direction[a] < 0 ? -1 : 1;
    inverse[a] = flat ? Real(kNever) : Real(1) / ray.direction[a];
  }
  const auto inside = [&](int a) { return at[a] >= 0 && at[a] < size[a]; };
  const auto leaving = [&](int a) { return step[a] > 0 ? at[a] >= size[a] : at[a] < 0; };
  PlainHit<Real> result;
  if (ray.start > 0) {
    if (ray.start > ray.end) return result;
    walkToStart(ray, step, inverse, at);
    result.t = ray.start;
  }
  for (;;) {
    if (leaving(0) || leaving(1) || leaving(2)) return result;
    if (inside(0) && inside(1) && inside(2)) {
      ++result.visited;
      if (stopsAt(stops, at, result.t)) {
        result.hit = true;
        for (int a = 0; a < 3; ++a) result.voxel[a] = at[a];
        return result;
      }
    }
    int axis = 0;
    Real next = 0;
    for (int a = 0; a < 3; ++a) {
      const Real plane = static_cast<Real>(step[a] > 0 ? at[a] + 1 : at[a]);
      const Real when = (plane - ray.origin[a]) * inverse[a];
      if (a == 0 || when < next) {
        axis = a;
        next = when;
      }
    }
    if (next > ray.end) return result;
    at[axis] += step[axis];
    result.t = next;
  }
}

}  // namespace vantage::casting
