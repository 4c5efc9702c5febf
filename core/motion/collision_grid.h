#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/volume/state_grid.h"

namespace vantage {

/// Coarse obstacle map for motion: a cell is free only if all its voxels are free (D-B26); unknown and
/// everything outside the mapped volume is an obstacle (spec section 10).
class CollisionGrid {
 public:
  CollisionGrid() = default;
  /// Cells of `cell_m` (at least one voxel) from the lower corner of the mapped volume; a voxel belongs to
  /// the cell that holds its centre. A last layer that would reach beyond the volume is left out, i.e. an
  /// obstacle. \param body_radius_m ball for which component() answers, metres, >= 0. \throws
  /// std::invalid_argument if a cell is smaller than a voxel or the radius is negative.
  CollisionGrid(const StateGrid& states, double cell_m, double body_radius_m = 0.0);

  const GridGeometry& geometry() const { return geometry_; }
  bool freeCell(const Eigen::Vector3i& cell) const {
    return geometry_.contains(cell) && free_[geometry_.index(cell)] != 0;
  }
  /// True if every cell that the interior of a ball overlaps is free; radius 0 asks for the cell of its
  /// centre.
  bool freeBall(const Eigen::Vector3d& center_world, double radius_m) const;
  /// True if the ball swept along a straight segment touches free cells only, checked every `step_m`.
  bool freeSegment(const Eigen::Vector3d& from_world, const Eigen::Vector3d& to_world, double radius_m,
                   double step_m) const;
  /// Component, 1.., of the cell that holds a point; 0 where the centre of a ball of the body radius can't
  /// be. Connects cells by face, edge or corner, and takes a cell in if the ball may fit somewhere in it. So
  /// this errs on the side of connecting: between points of different components there is no path, whatever a
  /// planner tries.
  std::uint32_t component(const Eigen::Vector3d& p_world) const;
  std::uint32_t componentCount() const { return components_; }

 private:
  void labelComponents(double body_radius_m);

  GridGeometry geometry_;
  std::vector<std::uint8_t> free_;
  std::vector<std::uint32_t> component_;
  std::uint32_t components_ = 0;
};

}  // namespace vantage
