#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/grid_geometry.h"
#include "core/volume/bricks.h"
#include "core/volume/bulk_memory.h"
#include "core/volume/voxel_state.h"

namespace vantage {

class TsdfVolume;

/// The one answer to "is this voxel unknown, free or occupied?" that ray casters, collision checks and the
/// viewer read. Derived from a map and updated by the bricks that changed; one byte a voxel for the state,
/// and one for the free radius.
class StateGrid {
 public:
  StateGrid() = default;
  /// Everything unknown. \throws std::invalid_argument for a size below 1, std::runtime_error if it does not
  /// fit in memory.
  explicit StateGrid(const GridGeometry& geometry);

  const GridGeometry& geometry() const { return geometry_; }

  VoxelState at(int i, int j, int k) const {
    return static_cast<VoxelState>(states_[geometry_.index(i, j, k)]);
  }
  VoxelState at(const Eigen::Vector3i& v) const { return at(v.x(), v.y(), v.z()); }
  std::span<const std::uint8_t> states() const { return {states_.data(), geometry_.count()}; }

  /// Chebyshev radius in voxels of the free cube around a voxel, capped at kMaxRadius: every voxel nearer
  /// than the radius, in all axes, is free; 0 = the voxel itself is not. Space outside the grid counts as
  /// free (rays leave it there). Rays jump by it; results never depend on it. kReadMargin bytes beyond the
  /// span may be read, so that four bytes can be fetched at any voxel.
  std::span<const std::uint8_t> freeRadius() const { return {free_radius_.data(), geometry_.count()}; }
  static constexpr int kReadMargin = 64;
  static constexpr int kMaxRadius = 15;

  /// Takes over the bricks that changed in the map, then the free radius near them.
  void update(const TsdfVolume& volume, const BrickSet& changed);
  /// Sets one voxel (tests, other maps); call rebuildFreeRadius() after the last.
  void set(const Eigen::Vector3i& v, VoxelState state) {
    states_[geometry_.index(v)] = static_cast<std::uint8_t>(state);
  }
  void rebuildFreeRadius();
  /// States for whoever derives them from another map; afterwards call rebuildFreeRadiusNear().
  std::span<std::uint8_t> editStates() { return {states_.data(), geometry_.count()}; }
  /// \param moved one flag a brick (BrickLayout) in which a voxel may have become free or stopped being it
  void rebuildFreeRadiusNear(std::span<const std::uint8_t> moved);

  /// Number of voxels of a state whose centre lies in `box`.
  std::uint64_t count(VoxelState state, const Box& box) const;

 private:
  GridGeometry geometry_;
  BulkVector<std::uint8_t> states_;       // kReadMargin more than voxels
  BulkVector<std::uint8_t> free_radius_;  // the same
};

/// State grid of a whole volume.
StateGrid makeStateGrid(const TsdfVolume& volume);

}  // namespace vantage
