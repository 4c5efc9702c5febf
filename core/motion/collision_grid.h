#pragma once

#include <cstdint>
#include <vector>

#include "core/volume/state_grid.h"

namespace vantage {

/// Coarse obstacle map for motion: a cell is free only if all its voxels are free (D-B26); unknown and everything
/// outside the mapped volume is an obstacle (spec section 10).
class CollisionGrid {
 public:
  CollisionGrid() = default;
  /// Cells of `cell_m` (at least one voxel) from the lower corner of the mapped volume; a voxel belongs to the
  /// cell that holds its centre.
  CollisionGrid(const StateGrid& states, double cell_m);

  const GridGeometry& geometry() const { return geometry_; }
  bool freeCell(const Eigen::Vector3i& cell) const {
    return geometry_.contains(cell) && free_[geometry_.index(cell)] != 0;
  }
  /// True if every cell that a ball touches is free.
  bool freeBall(const Eigen::Vector3d& center_world, double radius_m) const;
  /// True if the ball swept along a straight segment touches free cells only, checked every `step_m`.
  bool freeSegment(const Eigen::Vector3d& from_world, const Eigen::Vector3d& to_world, double radius_m,
                   double step_m) const;
  /// Component of face-, edge- or corner-connected free cells, 1..; 0 for obstacles. Points in different components have no
  /// path between them, whatever the planner tries.
  std::uint32_t component(const Eigen::Vector3d& p_world) const;

 private:
  GridGeometry geometry_;
  std::vector<std::uint8_t> free_;
  std::vector<std::uint32_t> component_;
};

}  // namespace vantage
