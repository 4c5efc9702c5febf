#pragma once

#include <cstdint>
#include <limits>

#include "core/volume/bulk_memory.h"
#include "core/volume/occupancy_octree.h"
#include "core/volume/octree_nodes.h"

namespace vantage {

/// State of an OccupancyOctree. `marks` belongs to insert(); its first bit is kept true between scans.
struct OccupancyOctree::Data {
  enum Mark : std::uint8_t {
    kSettled = 1,  ///< the value is clamp_min: a miss changes nothing
    kMissed = 2,   ///< a ray of this scan passed the voxel
    kHit = 4,      ///< a measurement of this scan ended in it
  };

  Data(const GridGeometry& geometry, const Box& object_box, const OccupancyConfig& config);

  octree::KeyBox keys() const { return {first_key, first_key + geometry.size}; }
  Eigen::Vector3i firstBlock() const { return first_key / octree::kBlock; }
  Eigen::Vector3i lastBlock() const {
    return (first_key + geometry.size - Eigen::Vector3i::Ones()) / octree::kBlock;
  }
  /// Of the voxels of the grid in the tree's coordinates.
  octree::KeyBox keysOf(const Eigen::Vector3i& begin, const Eigen::Vector3i& end) const {
    return {first_key + begin, first_key + end};
  }
  std::uint8_t settled(float log_odds) const {
    return log_odds <= low ? std::uint8_t{kSettled} : std::uint8_t{0};
  }
  /// Derives the marks from the tree.
  void settle();
  /// One value for a box of the grid; NaN = not stored.
  void fill(const octree::KeyBox& box, float log_odds);
  void setMarks(const octree::KeyBox& box, std::uint8_t value);

  /// Replaces the values of a block's voxels in the grid by `next(value, linear index)`; NaN = not stored.
  /// \return voxels that changed
  template <class Next>
  std::uint64_t rewrite(const Eigen::Vector3i& block, BrickSet& changed, const Next& next);
  /// The same for every block that a box of the grid meets.
  template <class Next>
  void rewriteBlocksOf(const octree::KeyBox& box, BrickSet& changed, const Next& next);

  GridGeometry geometry;
  BrickLayout bricks;
  Box object_box;
  OccupancyConfig config;
  OccupancyBand band;
  float hit = 0, miss = 0, low = 0, high = 0;  ///< log-odds of the config
  Eigen::Vector3i first_key = Eigen::Vector3i::Zero();
  octree::OctreeNodes nodes;
  BulkVector<std::uint8_t> marks;
};

template <class Next>
std::uint64_t OccupancyOctree::Data::rewrite(const Eigen::Vector3i& block, BrickSet& changed,
                                             const Next& next) {
  octree::Block values;
  nodes.readBlock(block, values);
  const Eigen::Vector3i corner = block * octree::kBlock - first_key;
  std::uint64_t count = 0;
  for (int n = 0; n < octree::kBlockVoxels; ++n) {
    const Eigen::Vector3i voxel = corner + octree::blockVoxel(n);
    if (!geometry.contains(voxel)) continue;
    const std::size_t at = geometry.index(voxel);
    float value = next(values[n], at);
    if (value != value) value = std::numeric_limits<float>::quiet_NaN();  // one NaN, so that runs are equal
    marks[at] = settled(value);
    if (value == values[n] || (value != value && values[n] != values[n])) continue;
    values[n] = value;
    changed.insert(bricks.brickOf(voxel));
    ++count;
  }
  if (count > 0) nodes.writeBlock(block, values);
  return count;
}

template <class Next>
void OccupancyOctree::Data::rewriteBlocksOf(const octree::KeyBox& box, BrickSet& changed, const Next& next) {
  const Eigen::Vector3i first = box.begin / octree::kBlock;
  const Eigen::Vector3i last = (box.end - Eigen::Vector3i::Ones()) / octree::kBlock;
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x) rewrite({x, y, z}, changed, next);
}

}  // namespace vantage
