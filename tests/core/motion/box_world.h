#pragma once

#include "core/volume/state_grid.h"

namespace vantage::test {

/// 2 x 2 x 1 m of free voxels of 2 cm from the lower corner (-1, -1, 0).
inline StateGrid freeWorld() {
  GridGeometry geometry;
  geometry.voxel_size_m = 0.02;
  geometry.origin_m = {-0.99, -0.99, 0.01};
  geometry.size = {100, 100, 50};
  StateGrid grid(geometry);
  for (int k = 0; k < geometry.size.z(); ++k)
    for (int j = 0; j < geometry.size.y(); ++j)
      for (int i = 0; i < geometry.size.x(); ++i) grid.set({i, j, k}, VoxelState::Free);
  return grid;
}

/// Sets the voxels whose centre lies in `box`.
inline void fill(StateGrid& grid, const Box& box, VoxelState state) {
  const GridGeometry& g = grid.geometry();
  for (std::size_t n = 0; n < g.count(); ++n)
    if (box.contains(g.center(g.voxel(n)))) grid.set(g.voxel(n), state);
}

}  // namespace vantage::test
