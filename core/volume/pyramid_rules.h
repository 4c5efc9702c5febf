#pragma once

#include <span>

#include "core/volume/occupancy_octree.h"
#include "core/volume/state_grid.h"

namespace vantage::pyramid {

/// Two neighbouring levels of a pyramid.
struct LevelPair {
  const StateGrid& finer;
  StateGrid& coarser;
  /// 0 or 1 per axis: position of the finer level's first node within its parent.
  Eigen::Vector3i phase;
};

/// What a refresh found: bit 0 set if a node became free or stopped being it, not 0 if any label changed.
using Difference = std::uint8_t;

/// D-A5: a node is occupied if anything in it is, free if all of it is, else unknown. Refreshes the nodes of
/// a box from the finer level.
Difference refreshByMax(const LevelPair& levels, const BrickRange& box);

/// Mean probabilities of a level's nodes, over the voxels of the grid alone.
struct MeanLevels {
  Eigen::Vector3i grid;    ///< finest voxels
  Eigen::Vector3i offset;  ///< of the coarser level, see StatePyramid::offset()
  int coarse_level;
  std::span<const float> finer;
  std::span<float> coarser;
};

/// The label of the mean probability instead.
Difference refreshByMean(const LevelPair& levels, const MeanLevels& means, const OccupancyConfig& config,
                         const BrickRange& box);

/// Bricks of a level with a node whose children lie in flagged bricks of the finer level.
std::vector<std::uint8_t> parentBricks(const LevelPair& levels, std::span<const std::uint8_t> flags);

}  // namespace vantage::pyramid
