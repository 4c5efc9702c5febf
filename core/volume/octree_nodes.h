#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>

#include "core/volume/occupancy_octree.h"

namespace octomap {
class OcTreeNode;
}

namespace vantage::octree {

inline constexpr int kDepth = OccupancyOctree::kDepth;  ///< of the finest voxels
inline constexpr int kKeys = 1 << kDepth;  ///< finest voxels per axis; the world's origin is at kKeys / 2
inline constexpr int kBlock = 8;           ///< edge of the blocks in which nodes are rewritten, voxels
inline constexpr int kBlockVoxels = kBlock * kBlock * kBlock;

/// Half-open box of finest voxels, by OctoMap's keys.
struct KeyBox {
  Eigen::Vector3i begin = Eigen::Vector3i::Zero(), end = Eigen::Vector3i::Zero();
  bool empty() const { return (begin.array() >= end.array()).any(); }
  KeyBox cut(const KeyBox& o) const { return {begin.cwiseMax(o.begin), end.cwiseMin(o.end)}; }
  bool holds(const KeyBox& o) const {
    return (begin.array() <= o.begin.array()).all() && (end.array() >= o.end.array()).all();
  }
  double voxels() const { return empty() ? 0.0 : (end - begin).cast<double>().prod(); }
};

/// Log-odds of a block in the order of the tree's children, in which every node of it is one run. NaN = not
/// stored.
using Block = std::array<float, kBlockVoxels>;

/// Voxel n of a block.
inline Eigen::Vector3i blockVoxel(int n) {
  const auto every_third = [](int b) { return (b & 1) | (b >> 2 & 2) | (b >> 4 & 4); };
  return {every_third(n), every_third(n >> 1), every_third(n >> 2)};
}

/// An OctoMap tree seen as boxes of voxels. Leaves are pruned within blocks and where whole boxes are filled;
/// the values of inner nodes are brought up to date when the tree is written, and mean nothing until then.
/// Const calls may run at the same time.
class OctreeNodes {
 public:
  explicit OctreeNodes(double voxel_size_m);
  ~OctreeNodes();
  OctreeNodes(OctreeNodes&&) noexcept;
  OctreeNodes& operator=(OctreeNodes&&) noexcept;

  std::optional<float> at(const Eigen::Vector3i& key) const;
  /// Values of a box, x fastest; NaN where nothing is stored.
  void read(const KeyBox& box, std::span<float> log_odds) const;
  /// Values of the block whose first key is kBlock times `block`; NaN where nothing is stored.
  void readBlock(const Eigen::Vector3i& block, Block& log_odds) const;
  /// Replaces a block; the quiet NaN of std::numeric_limits removes.
  void writeBlock(const Eigen::Vector3i& block, const Block& log_odds);
  /// Gives every voxel of a box one value. \pre it is not NaN
  void fill(const KeyBox& box, float log_odds);
  /// Removes everything inside.
  void remove(const KeyBox& box);
  /// Removes everything outside.
  void cut(const KeyBox& box);
  /// Every leaf that meets the box: the part of it inside, and its log-odds.
  void visit(const KeyBox& box, const std::function<void(const KeyBox&, float)>& visit) const;

  /// Max rule over the voxels of `box` (D-A5, D-A6); Unknown if it is empty.
  VoxelState labelByMax(const KeyBox& box, const OccupancyBand& band) const;
  /// Sum of the probabilities of the voxels of `box`, 0.5 for those that are not stored.
  double probabilitySum(const KeyBox& box) const;

  std::size_t nodes() const;
  std::size_t memoryBytes() const;

  /// Data of OctoMap's formats, without headers. Updates inner nodes and prunes first.
  /// \return nodes written
  std::size_t writeProbabilities(std::ostream& out) const;
  /// Leaves in the unknown band are left out.
  std::size_t writeLabels(std::ostream& out, const OccupancyBand& band) const;
  /// \pre the stream holds a well-formed tree, this one is empty
  void readProbabilities(std::istream& in);
  void readLabels(std::istream& in, float free, float occupied);

 private:
  class Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace vantage::octree
