#include "core/perception/other_label_distance.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace vantage {

namespace {

constexpr std::uint32_t kLeafPoints = 8;
constexpr std::uint32_t kMixed = 0xffffffffu;
constexpr std::uint32_t kEmpty = 0xfffffffeu;

struct Item {
  std::uint64_t code = 0;   ///< Morton order
  std::uint32_t index = 0;  ///< in the caller's arrays
};

/// Spreads the lowest 21 bits to every third bit.
std::uint64_t spread(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  return (v | v << 2) & 0x1249249249249249ULL;
}

/// Box of a subtree and its label, if all its points have the same.
struct Node {
  std::array<float, 3> low{INFINITY, INFINITY, INFINITY};
  std::array<float, 3> high{-INFINITY, -INFINITY, -INFINITY};
  std::uint32_t label = kEmpty;

  void add(const Node& other) {
    if (other.label == kEmpty) return;
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], other.low[a]);
      high[a] = std::max(high[a], other.high[a]);
    }
    label = label == kEmpty || label == other.label ? other.label : kMixed;
  }
};

struct Point {
  float x, y, z;
  std::uint32_t label;
};

float squared(const Point& p, const Point& q) {
  const float dx = p.x - q.x, dy = p.y - q.y, dz = p.z - q.z;
  return dx * dx + dy * dy + dz * dz;
}

/// Complete binary tree over points in Morton order. A query skips subtrees that are wholly of its own label,
/// so the inside of a large segment costs no more than its rim.
class LabelTree {
 public:
  LabelTree(const std::vector<Eigen::Vector3f>& points, const std::vector<std::uint32_t>& labels) {
    sortPoints(points);
    points_.resize(items_.size());
    tbb::parallel_for(std::size_t{0}, items_.size(), [&](std::size_t k) {
      const Eigen::Vector3f& p = points[items_[k].index];
      points_[k] = {p.x(), p.y(), p.z(), labels[items_[k].index]};
    });
    build();
  }

  std::uint32_t leaves() const { return first_leaf_; }

  /// Distances of the points of one leaf, written to the slots of the caller's order.
  void measureLeaf(std::uint32_t leaf, float max_distance, std::vector<float>& out) const {
    const auto [begin, end] = leafRange(leaf);
    float previous = max_distance;
    for (std::uint32_t k = begin; k < end; ++k) {
      const Point& p = points_[k];
      float bound = max_distance;
      if (k > begin && p.label == points_[k - 1].label) {
        // Its neighbour's nearest is at most this far; a hint for pruning, so rounded up.
        bound = std::min(bound, (previous + std::sqrt(squared(p, points_[k - 1]))) * 1.0001f + 1e-6f);
      }
      const float limit = bound * bound, nearest = nearestOther(p, limit);
      previous = nearest < limit ? std::sqrt(nearest) : max_distance;
      out[items_[k].index] = previous;
    }
  }

 private:
  void sortPoints(const std::vector<Eigen::Vector3f>& points) {
    Eigen::Vector3f low = Eigen::Vector3f::Constant(INFINITY), high = -low;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (!points[i].allFinite()) continue;
      items_.push_back({0, i});
      low = low.cwiseMin(points[i]);
      high = high.cwiseMax(points[i]);
    }
    if (items_.empty()) return;
    const double scale = 2097151.0 / std::max(1e-6, (high - low).cast<double>().maxCoeff());
    tbb::parallel_for(std::size_t{0}, items_.size(), [&](std::size_t k) {
      const Eigen::Vector3d g = scale * (points[items_[k].index] - low).cast<double>();
      items_[k].code = spread(static_cast<std::uint64_t>(g.x())) |
                       spread(static_cast<std::uint64_t>(g.y())) << 1 |
                       spread(static_cast<std::uint64_t>(g.z())) << 2;
    });
    tbb::parallel_sort(items_.begin(), items_.end(), [](const Item& a, const Item& b) {
      return a.code != b.code ? a.code < b.code : a.index < b.index;
    });
  }

  void build() {
    const auto count = static_cast<std::uint32_t>(points_.size());
    first_leaf_ = std::bit_ceil(std::max(1u, (count + kLeafPoints - 1) / kLeafPoints));
    nodes_.resize(2 * static_cast<std::size_t>(first_leaf_));
    tbb::parallel_for(0u, first_leaf_, [&](std::uint32_t leaf) {
      const auto [begin, end] = leafRange(leaf);
      for (std::uint32_t k = begin; k < end; ++k) {
        const Point& p = points_[k];
        nodes_[first_leaf_ + leaf].add({{p.x, p.y, p.z}, {p.x, p.y, p.z}, p.label});
      }
    });
    for (std::uint32_t node = first_leaf_ - 1; node >= 1; --node) {
      nodes_[node].add(nodes_[2 * node]);
      nodes_[node].add(nodes_[2 * node + 1]);
    }
  }

  std::pair<std::uint32_t, std::uint32_t> leafRange(std::uint32_t leaf) const {
    const auto count = static_cast<std::uint32_t>(points_.size());
    return {std::min(count, leaf * kLeafPoints), std::min(count, (leaf + 1) * kLeafPoints)};
  }

  /// Squared distance to a box, infinite if nothing in it has another label. Rounded as squared() rounds, so
  /// it never exceeds that of a point inside.
  static float squaredToOther(const Point& p, const Node& node) {
    if (node.label == p.label || node.label == kEmpty) return INFINITY;
    const float dx = std::max({node.low[0] - p.x, 0.0f, p.x - node.high[0]});
    const float dy = std::max({node.low[1] - p.y, 0.0f, p.y - node.high[1]});
    const float dz = std::max({node.low[2] - p.z, 0.0f, p.z - node.high[2]});
    return dx * dx + dy * dy + dz * dz;
  }

  float nearestOther(const Point& p, float best) const {
    struct Entry {
      std::uint32_t node;
      float squared;
    };
    std::array<Entry, 64> stack;
    int depth = 0;
    stack[depth++] = {1, squaredToOther(p, nodes_[1])};
    while (depth > 0) {
      const Entry entry = stack[--depth];
      if (!(entry.squared < best)) continue;
      if (entry.node >= first_leaf_) {
        best = nearestInLeaf(p, entry.node - first_leaf_, best);
        continue;
      }
      const std::uint32_t left = 2 * entry.node, right = left + 1;
      const Entry a{left, squaredToOther(p, nodes_[left])}, b{right, squaredToOther(p, nodes_[right])};
      const bool left_first = a.squared <= b.squared;
      const Entry &near = left_first ? a : b, &far = left_first ? b : a;
      if (far.squared < best) stack[depth++] = far;
      if (near.squared < best) stack[depth++] = near;
    }
    return best;
  }

  float nearestInLeaf(const Point& p, std::uint32_t leaf, float best) const {
    const auto [begin, end] = leafRange(leaf);
    for (std::uint32_t k = begin; k < end; ++k) {
      if (points_[k].label != p.label) best = std::min(best, squared(p, points_[k]));
    }
    return best;
  }

  std::vector<Item> items_;
  std::vector<Point> points_;
  std::vector<Node> nodes_;
  std::uint32_t first_leaf_ = 1;
};

}  // namespace

std::vector<float> otherLabelDistances(const std::vector<Eigen::Vector3f>& points,
                                       const std::vector<std::uint32_t>& labels, float max_distance_m) {
  std::vector<float> distances(points.size(), max_distance_m);
  if (points.empty()) return distances;
  const LabelTree tree(points, labels);
  tbb::parallel_for(0u, tree.leaves(),
                    [&](std::uint32_t leaf) { tree.measureLeaf(leaf, max_distance_m, distances); });
  return distances;
}

}  // namespace vantage
