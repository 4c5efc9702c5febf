#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/geometry/check.h"
#include "core/geometry/triangle_mesh.h"

/// Helpers shared by the shapes.
namespace vantage::solid_parts {

inline constexpr double kMaxSize_m = 1000.0;
inline constexpr double kMinSize_m = 1e-4;

/// Refuses a length that is no size of a solid.
inline void requireSize(std::string_view field, double value) {
  requireInRange(field, value, kMinSize_m, kMaxSize_m);
}

/// Corners of a regular polygon that stays within 0.1 mm of a circle.
inline int circleSides(double radius_m) {
  constexpr double chord_m = 1e-4;
  const double ratio = std::min(1.0, chord_m / std::max(radius_m, 1e-9));
  const int sides = static_cast<int>(std::ceil(std::numbers::pi / std::acos(1.0 - ratio)));
  return std::clamp(sides, 12, 256);
}

/// Distance of a point to a segment, any dimension.
template <class V>
double distanceToSegment(const V& p, const V& a, const V& b) {
  const V ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

/// Keeps the points of a polyline that hold it within `tolerance` (Douglas-Peucker).
template <class V>
std::vector<V> simplified(const std::vector<V>& line, double tolerance) {
  std::vector<char> keep(line.size(), 0);
  keep.front() = keep.back() = 1;
  std::vector<std::pair<std::size_t, std::size_t>> stack = {{0, line.size() - 1}};
  while (!stack.empty()) {
    const auto [first, last] = stack.back();
    stack.pop_back();
    double worst = tolerance;
    std::size_t split = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double d = distanceToSegment(line[i], line[first], line[last]);
      if (d <= worst) continue;
      worst = d;
      split = i;
    }
    if (split == 0) continue;
    keep[split] = 1;
    stack.push_back({first, split});
    stack.push_back({split, last});
  }
  std::vector<V> result;
  for (std::size_t i = 0; i < line.size(); ++i)
    if (keep[i]) result.push_back(line[i]);
  return result;
}

/// Samples one span of a centripetal Catmull-Rom curve (Barry-Goldman), from p1 (excluded) to p2.
template <class V>
void sampleSpan(const V& p0, const V& p1, const V& p2, const V& p3, std::vector<V>& out) {
  const double t1 = std::sqrt((p1 - p0).norm()), t2 = t1 + std::sqrt((p2 - p1).norm()),
               t3 = t2 + std::sqrt((p3 - p2).norm());
  constexpr int samples = 24;
  for (int s = 1; s <= samples; ++s) {
    const double t = t1 + (t2 - t1) * s / samples;
    const V a1 = (t1 - t) / t1 * p0 + t / t1 * p1;
    const V a2 = (t2 - t) / (t2 - t1) * p1 + (t - t1) / (t2 - t1) * p2;
    const V a3 = (t3 - t) / (t3 - t2) * p2 + (t - t2) / (t3 - t2) * p3;
    const V b1 = (t2 - t) / t2 * a1 + t / t2 * a2;
    const V b2 = (t3 - t) / (t3 - t1) * a2 + (t - t1) / (t3 - t1) * a3;
    out.push_back((t2 - t) / (t2 - t1) * b1 + (t - t1) / (t2 - t1) * b2);
  }
}

/// Smooth curve through points that differ from their neighbours; ends are mirrored.
template <class V>
std::vector<V> smoothRun(const std::vector<V>& points) {
  if (points.size() < 3) return points;
  std::vector<V> curve = {points.front()};
  const std::size_t n = points.size();
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const V before = i > 0 ? points[i - 1] : V(2 * points[0] - points[1]);
    const V after = i + 2 < n ? points[i + 2] : V(2 * points[n - 1] - points[n - 2]);
    sampleSpan<V>(before, points[i], points[i + 1], after, curve);
  }
  return curve;
}

/// Smooth curve through points; a point that stands twice is a corner. Within 0.05 mm of the curve.
template <class V>
std::vector<V> smoothCurve(const std::vector<V>& points) {
  std::vector<V> curve, run;
  const auto flush = [&] {
    const std::vector<V> part = smoothRun(run);
    if (part.empty()) return;
    const std::vector<V> kept = part.size() < 3 ? part : simplified(part, 5e-5);
    curve.insert(curve.end(), kept.begin() + (curve.empty() ? 0 : 1), kept.end());
  };
  for (const V& p : points) {
    if (!run.empty() && (p - run.back()).norm() < 1e-9) {
      flush();
      run.clear();
    }
    run.push_back(p);
  }
  flush();
  return curve;
}

}  // namespace vantage::solid_parts
