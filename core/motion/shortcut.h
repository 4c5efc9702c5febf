#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace vantage {

/// Euclidean length of a chain of points or configurations; 0 for fewer than two.
template <class Vector>
double lengthOf(const std::vector<Vector>& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  return length;
}

/// The same path with a vertex at least every `spacing`.
template <class Vector>
std::vector<Vector> densified(const std::vector<Vector>& path, double spacing) {
  std::vector<Vector> dense = {path.front()};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Vector step = path[i] - path[i - 1];
    const int parts = std::max(1, static_cast<int>(std::ceil(step.norm() / spacing)));
    for (int p = 1; p < parts; ++p) dense.push_back(path[i - 1] + step * (static_cast<double>(p) / parts));
    dense.push_back(path[i]);
  }
  return dense;
}

/// From each vertex straight to the farthest one that can be seen.
template <class Vector, class SegmentFree>
std::vector<Vector> farthestVisible(const std::vector<Vector>& path, const SegmentFree& segment_free) {
  std::vector<Vector> kept = {path.front()};
  for (std::size_t at = 0; at + 1 < path.size();) {
    std::size_t next = path.size() - 1;
    while (next > at + 1 && !segment_free(path[at], path[next])) --next;
    kept.push_back(path[next]);
    at = next;
  }
  return kept;
}

/// A shorter path of free segments with the same ends. `path` is not empty, its segments are free.
/// `segment_free(a, b)` tells for any two; `spacing` is that of the vertices that may be joined.
template <class Vector, class SegmentFree>
std::vector<Vector> shortened(std::vector<Vector> path, const SegmentFree& segment_free, double spacing) {
  constexpr double kWorthwhile = 1e-3;
  for (int round = 0; round < 3; ++round) {
    const double before = lengthOf(path);
    // From both ends: the greedy choice favours the one it starts from.
    for (int direction = 0; direction < 2; ++direction) {
      std::reverse(path.begin(), path.end());
      path = farthestVisible(densified(path, spacing), segment_free);
    }
    if (lengthOf(path) > before - kWorthwhile) break;
  }
  return path;
}

}  // namespace vantage
