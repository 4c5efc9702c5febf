#pragma once

#include <vector>

#include "core/volume/occupancy_octree.h"
#include "core/volume/state_grid.h"

namespace vantage {

/// Voxel states at the finest resolution and at coarser ones, each with its free radius: what the
/// hierarchical caster reads. Nodes of level i have edges of 2^i finest voxels and lie as those of the
/// octree; at the border of the grid only voxels of the grid count.
class StatePyramid {
 public:
  StatePyramid() = default;
  /// Everything unknown. `first_voxel`: index of voxel (0,0,0) in the infinite grid whose planes pass through
  /// the origin; nodes begin at its multiples of 2^i. \param coarse_levels levels above the finest, 0..8
  StatePyramid(const GridGeometry& finest, const Eigen::Vector3i& first_voxel, int coarse_levels,
               const OccupancyConfig& config = {});
  /// Of a whole map.
  StatePyramid(const OccupancyOctree& map, int coarse_levels);
  /// Of a grid whose free radius is up to date, with the max rule.
  StatePyramid(StateGrid finest, const Eigen::Vector3i& first_voxel, int coarse_levels);

  static constexpr int kMaxCoarseLevels = 8;
  int coarseLevels() const { return static_cast<int>(levels_.size()) - 1; }
  /// Level 0 is the finest. Its geometry covers the grid, with whole nodes.
  const StateGrid& level(int i) const { return levels_[i]; }
  const StateGrid& finest() const { return levels_.front(); }
  /// Finest voxels by which level(0) begins after the first node of a level.
  Eigen::Vector3i offset(int level) const;
  /// Node of a level that holds a finest voxel.
  Eigen::Vector3i node(const Eigen::Vector3i& voxel, int level) const;

  /// Takes over the bricks that changed in the map, their nodes, and the free radius near them.
  /// \throws std::invalid_argument if the map has another grid or config.
  void update(const OccupancyOctree& map, const BrickSet& changed);

 private:
  StatePyramid(StateGrid finest, const Eigen::Vector3i& first_voxel, int coarse_levels,
               const OccupancyConfig& config);
  /// \return how states differ from before, bit by bit
  std::uint8_t takeOver(const OccupancyOctree& map, std::uint32_t brick);
  /// Levels above the finest. \param changed_bricks of the finest; flags other than 0
  void refreshCoarse(std::vector<std::uint8_t> changed_bricks);

  OccupancyConfig config_;
  Eigen::Vector3i first_voxel_ = Eigen::Vector3i::Zero();
  std::vector<StateGrid> levels_;
  std::vector<std::vector<float>> probability_;  ///< per level, with the mean rule alone
};

/// Index of a grid's first voxel in the infinite grid whose planes pass through the origin.
Eigen::Vector3i firstVoxelOf(const GridGeometry& geometry);

}  // namespace vantage
