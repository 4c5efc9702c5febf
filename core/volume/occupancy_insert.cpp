#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "core/volume/occupancy_data.h"

namespace vantage {
namespace {

using octree::kBlock;

constexpr std::size_t kNoHit = std::numeric_limits<std::size_t>::max();
constexpr double kNever = std::numeric_limits<double>::infinity();

/// One axis of a line of sight through a grid, where voxel i covers [i, i+1).
struct Axis {
  double next = kNever;       ///< parameter of the next crossing; never = none is left
  double between = kNever;    ///< parameter between crossings
  int steps = 0;              ///< crossings left inside the grid
  bool leaves = false;        ///< the line leaves the grid along this axis
  std::ptrdiff_t stride = 0;  ///< of the linear index, with the direction's sign
};

struct Sight {
  std::array<Axis, 3> axes;
  std::size_t first = 0;     ///< voxel in which the line begins or enters the grid
  std::size_t end = kNoHit;  ///< voxel in which it ends, if inside
};

/// Cuts the line from `from` to `to` to a grid. \return false if it passes by
bool enter(const GridGeometry& g, const Eigen::Vector3d& from, const Eigen::Vector3d& to, Sight& sight) {
  const Eigen::Vector3d d = to - from;
  double first = 0.0, last = 1.0;
  for (int a = 0; a < 3; ++a) {
    if (d[a] == 0.0 && (from[a] < 0.0 || from[a] >= g.size[a])) return false;
    if (d[a] == 0.0) continue;
    const double t0 = -from[a] / d[a], t1 = (g.size[a] - from[a]) / d[a];
    first = std::max(first, std::min(t0, t1));
    last = std::min(last, std::max(t0, t1));
  }
  if (!(first <= last)) return false;
  const std::array<std::ptrdiff_t, 3> strides = {1, g.size.x(),
                                                 static_cast<std::ptrdiff_t>(g.size.x()) * g.size.y()};
  Eigen::Vector3i begin, end;
  bool ends_inside = true;
  for (int a = 0; a < 3; ++a) {
    Axis& axis = sight.axes[a];
    const double border = g.size[a] - 1.0, goal = std::floor(to[a]);
    begin[a] = static_cast<int>(std::clamp(std::floor(from[a] + first * d[a]), 0.0, border));
    end[a] = static_cast<int>(std::clamp(goal, 0.0, border));
    axis.leaves = goal < 0.0 || goal > border;
    ends_inside = ends_inside && !axis.leaves;
    const int direction = d[a] < 0.0 ? -1 : 1;
    axis.stride = direction * strides[a];
    axis.steps = std::max(0, direction * (end[a] - begin[a]));
    axis.between = std::abs(1.0 / d[a]);
    const bool crosses = axis.steps > 0 || axis.leaves;
    axis.next = crosses ? (begin[a] + (direction > 0 ? 1 : 0) - from[a]) / d[a] : kNever;
  }
  sight.first = g.index(begin);
  sight.end = ends_inside ? g.index(end) : kNoHit;
  return true;
}

/// Sets a bit. Every thread stores the same bits, so the order of the stores does not matter.
void mark(std::uint8_t& byte, std::uint8_t bit) {
  const std::atomic_ref<std::uint8_t> shared(byte);
  const std::uint8_t old = shared.load(std::memory_order_relaxed);
  if (!(old & bit)) shared.store(static_cast<std::uint8_t>(old | bit), std::memory_order_relaxed);
}

/// Marks the voxels that a line passes (Amanatides & Woo 1987), without the one in which it ends.
void pass(Sight sight, std::uint8_t* marks, std::uint8_t bit) {
  auto& [x, y, z] = sight.axes;
  for (std::size_t at = sight.first;;) {
    Axis& axis = x.next <= y.next ? (x.next <= z.next ? x : z) : (y.next <= z.next ? y : z);
    if (axis.steps == 0) {
      if (axis.leaves) mark(marks[at], bit);
      return;
    }
    mark(marks[at], bit);
    at += axis.stride;
    axis.next = --axis.steps > 0 || axis.leaves ? axis.next + axis.between : kNever;
  }
}

void requireImage(const DepthImage& depth, const PinholeCamera& camera, const Pose& T_world_camera) {
  camera.validate();
  const std::size_t pixels = static_cast<std::size_t>(camera.width) * camera.height;
  std::ostringstream text;
  if (depth.width != camera.width || depth.height != camera.height || depth.depth_m.size() != pixels) {
    text << "depth image is " << depth.width << " x " << depth.height << ", its camera " << camera.width
         << " x " << camera.height << "; they must agree";
    throw std::invalid_argument(text.str());
  }
  if (!T_world_camera.matrix().allFinite())
    throw std::invalid_argument("occupancy octree: the camera's pose is not finite");
}

/// Eight marks at once, cut at the border of the grid.
std::uint64_t loadMarks(const std::uint8_t* marks, int count) {
  std::uint64_t word = 0;
  if (count == 8)
    std::memcpy(&word, marks, 8);
  else
    std::memcpy(&word, marks, count);
  return word;
}

/// What a layer of blocks holds after the marking.
struct Layer {
  std::vector<Eigen::Vector3i> blocks;  ///< in which values change
  std::uint64_t hits = 0, misses = 0;
};

}  // namespace

/// Insertion of one scan.
class OccupancyOctree::Scan {
 public:
  Scan(Data& data, const DepthImage& depth, const PinholeCamera& camera, const Pose& T_world_camera)
      : d_(data), depth_(depth), camera_(camera), T_world_camera_(T_world_camera) {}

  OccupancyUpdate insert() {
    markVoxels();
    OccupancyUpdate update;
    update.changed = BrickSet(d_.bricks.total());
    for (const Layer& layer : sweep()) {
      update.hits += layer.hits;
      update.misses += layer.misses;
      for (const Eigen::Vector3i& block : layer.blocks)
        update.updated += d_.rewrite(block, update.changed, [&](float value, std::size_t at) {
          const std::uint8_t marks = d_.marks[at];
          if (!(marks & (Data::kHit | Data::kMissed))) return value;
          const float change = marks & Data::kHit ? d_.hit : d_.miss;
          return std::clamp((std::isnan(value) ? 0.0f : value) + change, d_.low, d_.high);
        });
    }
    return update;
  }

 private:
  /// Free space first, then hits, which win.
  void markVoxels() {
    std::vector<std::size_t> hits(depth_.depth_m.size(), kNoHit);
    const tbb::blocked_range<int> rows(0, depth_.height, 4);
    tbb::parallel_for(rows, [&](const tbb::blocked_range<int>& range) {
      for (int v = range.begin(); v < range.end(); ++v)
        for (int u = 0; u < depth_.width; ++u)
          hits[static_cast<std::size_t>(v) * depth_.width + u] = passPixel(u, v);
    });
    for (const std::size_t at : hits)
      if (at != kNoHit) d_.marks[at] |= Data::kHit;
  }

  /// \return voxel in which the measurement ends, kNoHit if none
  std::size_t passPixel(int u, int v) {
    const float z = depth_.at(u, v);
    if (!DepthImage::valid(z) || z < camera_.min_range_m || z > camera_.max_range_m) return kNoHit;
    Eigen::Vector3d p_camera = camera_.ray(u, v) * z;
    const double range_m = p_camera.norm();
    const bool beyond = range_m > d_.config.insert_range_m;
    if (beyond) p_camera *= d_.config.insert_range_m / range_m;
    Sight sight;
    if (!enter(d_.geometry, inGrid(T_world_camera_.translation()), inGrid(T_world_camera_ * p_camera), sight))
      return kNoHit;
    pass(sight, d_.marks.data(), Data::kMissed);
    return beyond ? kNoHit : sight.end;
  }

  Eigen::Vector3d inGrid(const Eigen::Vector3d& p_world) const {
    return d_.geometry.toGrid(p_world).array() + 0.5;
  }

  /// Counts the marks, takes back those that change nothing and lists the blocks with others.
  std::vector<Layer> sweep() {
    const int first = d_.firstBlock().z(), last = d_.lastBlock().z();
    std::vector<Layer> layers(last - first + 1);
    tbb::parallel_for(0, last - first + 1, [&](int n) { sweepLayer(first + n, layers[n]); });
    return layers;
  }

  void sweepLayer(int block_z, Layer& layer) {
    const Eigen::Vector3i first = d_.firstBlock(), last = d_.lastBlock();
    const GridGeometry& g = d_.geometry;
    const int k0 = std::max(0, block_z * kBlock - d_.first_key.z());
    const int k1 = std::min(g.size.z(), (block_z + 1) * kBlock - d_.first_key.z());
    std::vector<std::uint8_t> changes(last.x() - first.x() + 1);
    for (int block_y = first.y(); block_y <= last.y(); ++block_y) {
      const int j0 = std::max(0, block_y * kBlock - d_.first_key.y());
      const int j1 = std::min(g.size.y(), (block_y + 1) * kBlock - d_.first_key.y());
      std::fill(changes.begin(), changes.end(), std::uint8_t{0});
      for (int k = k0; k < k1; ++k)
        for (int j = j0; j < j1; ++j) sweepRow(d_.marks.data() + g.index(0, j, k), changes, layer);
      for (std::size_t n = 0; n < changes.size(); ++n)
        if (changes[n]) layer.blocks.push_back({first.x() + static_cast<int>(n), block_y, block_z});
    }
  }

  void sweepRow(std::uint8_t* row, std::vector<std::uint8_t>& changes, Layer& layer) {
    constexpr std::uint64_t kEach = 0x0101010101010101;
    const int offset = d_.first_key.x() % kBlock, size = d_.geometry.size.x();
    for (std::size_t n = 0; n < changes.size(); ++n) {
      const int begin = std::max(0, static_cast<int>(n) * kBlock - offset);
      const int count = std::min(size, static_cast<int>(n + 1) * kBlock - offset) - begin;
      const std::uint64_t word = loadMarks(row + begin, count);
      if (!(word & kEach * (Data::kMissed | Data::kHit))) continue;
      const std::uint64_t hit = word >> 2 & kEach, missed = word >> 1 & kEach & ~hit, settled = word & kEach;
      layer.hits += std::popcount(hit);
      layer.misses += std::popcount(missed);
      const std::uint64_t nothing_new = missed & settled;
      if (hit | (missed & ~settled)) changes[n] = 1;
      const std::uint64_t rest = word & ~(nothing_new * Data::kMissed);
      if (count == 8)
        std::memcpy(row + begin, &rest, 8);
      else
        std::memcpy(row + begin, &rest, count);
    }
  }

  Data& d_;
  const DepthImage& depth_;
  const PinholeCamera& camera_;
  const Pose& T_world_camera_;
};

OccupancyUpdate OccupancyOctree::insert(const DepthImage& depth, const PinholeCamera& camera,
                                        const Pose& T_world_camera) {
  requireImage(depth, camera, T_world_camera);
  return Scan(*data_, depth, camera, T_world_camera).insert();
}

}  // namespace vantage
