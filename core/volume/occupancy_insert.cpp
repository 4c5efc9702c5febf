#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include <algorithm>
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

/// Part of a line of sight inside a grid, in coordinates in which voxel i covers [i, i+1).
struct Sight {
  Eigen::Vector3d from, direction;
  Eigen::Vector3i first, last;  ///< voxels in which the part begins and ends
  bool ends_inside = false;     ///< the line ends in `last`; else it leaves the grid there
};

/// Cuts the line from `from` to `to` to a grid. \return false if it passes by
bool enter(const Eigen::Vector3i& size, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
           Sight& sight) {
  const Eigen::Vector3d d = to - from;
  double t_first = 0.0, t_last = 1.0;
  for (int a = 0; a < 3; ++a) {
    if (d[a] == 0.0 && (from[a] < 0.0 || from[a] >= size[a])) return false;
    if (d[a] == 0.0) continue;
    const double t0 = -from[a] / d[a], t1 = (size[a] - from[a]) / d[a];
    t_first = std::max(t_first, std::min(t0, t1));
    t_last = std::min(t_last, std::max(t0, t1));
  }
  if (!(t_first <= t_last)) return false;
  sight.from = from;
  sight.direction = d;
  sight.ends_inside = true;
  for (int a = 0; a < 3; ++a) {
    const double border = size[a] - 1.0, end = std::floor(to[a]);
    sight.ends_inside = sight.ends_inside && end >= 0.0 && end <= border;
    const auto inside = [&](double t) {
      return static_cast<int>(std::clamp(std::floor(from[a] + t * d[a]), 0.0, border));
    };
    sight.first[a] = inside(t_first);
    sight.last[a] = t_last == 1.0 ? static_cast<int>(std::clamp(end, 0.0, border)) : inside(t_last);
  }
  return true;
}

/// Sets a bit. Every thread stores the same bits, so the order of the stores does not matter.
void mark(std::uint8_t& byte, std::uint8_t bit) {
  const std::atomic_ref<std::uint8_t> shared(byte);
  shared.store(static_cast<std::uint8_t>(shared.load(std::memory_order_relaxed) | bit),
               std::memory_order_relaxed);
}

/// One of the two axes across the main one, along which a line moves by at most one voxel a slab.
struct Cross {
  double from, slope, inverse;
  int low, high;
  std::ptrdiff_t stride;

  Cross(const GridGeometry& g, const Sight& s, int axis, int main)
      : from(s.from[axis]),
        slope(s.direction[axis] / s.direction[main]),
        inverse(1.0 / s.direction[axis]),
        low(std::min(s.first[axis], s.last[axis])),
        high(std::max(s.first[axis], s.last[axis])),
        stride(axis == 0   ? 1
               : axis == 1 ? g.size.x()
                           : static_cast<std::ptrdiff_t>(g.size.x()) * g.size.y()) {}
  /// Voxel at a distance along the main axis, clamped to those between both ends.
  int at(double along) const { return std::clamp(static_cast<int>(from + slope * along), low, high); }
  /// Parameter at which the line goes from one voxel to its neighbour.
  double crossing(int a, int b) const { return (std::max(a, b) - from) * inverse; }
};

/// Marks the voxels that a line passes, without the one in which it ends. Slab by slab along the main axis:
/// in a slab lie the voxels of entry and exit and, where both other axes move, the one between. Voxels that
/// coincide are marked twice, which costs less than to ask.
void pass(const GridGeometry& g, const Sight& s, std::uint8_t* marks, std::uint8_t bit) {
  int main = 0;
  s.direction.cwiseAbs().maxCoeff(&main);
  const Cross u(g, s, (main + 1) % 3, main), v(g, s, (main + 2) % 3, main);
  const int step = s.last[main] < s.first[main] ? -1 : 1;
  const std::ptrdiff_t stride = step * Cross(g, s, main, main).stride;
  int u0 = s.first[(main + 1) % 3], v0 = s.first[(main + 2) % 3];
  std::uint8_t* slab = marks + g.index(s.first) - u0 * u.stride - v0 * v.stride;
  double along = s.first[main] + (step > 0 ? 1 : 0) - s.from[main];  // to the plane at which a slab is left
  for (int n = s.first[main]; n != s.last[main]; n += step, along += step, slab += stride) {
    const int u1 = u.at(along), v1 = v.at(along);
    const bool u_first = u.crossing(u0, u1) <= v.crossing(v0, v1);
    mark(slab[u0 * u.stride + v0 * v.stride], bit);
    mark(slab[(u_first ? u1 : u0) * u.stride + (u_first ? v0 : v1) * v.stride], bit);
    mark(slab[u1 * u.stride + v1 * v.stride], bit);
    u0 = u1;
    v0 = v1;
  }
  const int u1 = s.last[(main + 1) % 3], v1 = s.last[(main + 2) % 3];
  const bool u_first = u.crossing(u0, u1) <= v.crossing(v0, v1);
  std::uint8_t* const last = slab + u1 * u.stride + v1 * v.stride;
  std::uint8_t* const between = slab + (u_first ? u1 : u0) * u.stride + (u_first ? v0 : v1) * v.stride;
  for (std::uint8_t* at : {slab + u0 * u.stride + v0 * v.stride, between, last})
    if (at != last || !s.ends_inside) mark(*at, bit);
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
    // In tiles: rays beside and below each other pass the same cache lines.
    constexpr int kTile = 16;
    const tbb::blocked_range2d<int> tiles(0, depth_.height, kTile, 0, depth_.width, kTile);
    tbb::parallel_for(
        tiles,
        [&](const tbb::blocked_range2d<int>& tile) {
          for (int v = tile.rows().begin(); v < tile.rows().end(); ++v)
            for (int u = tile.cols().begin(); u < tile.cols().end(); ++u)
              hits[static_cast<std::size_t>(v) * depth_.width + u] = passPixel(u, v);
        },
        tbb::simple_partitioner());
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
    if (!enter(d_.geometry.size, inGrid(T_world_camera_.translation()), inGrid(T_world_camera_ * p_camera),
               sight))
      return kNoHit;
    pass(d_.geometry, sight, d_.marks.data(), Data::kMissed);
    return beyond || !sight.ends_inside ? kNoHit : d_.geometry.index(sight.last);
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
