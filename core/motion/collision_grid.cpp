#include "core/motion/collision_grid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/check.h"

namespace vantage {
namespace {

constexpr double kRounding = 1e-9;  // share of a cell

/// Whole cells from the lower corner of the mapped volume.
GridGeometry cellGeometry(const GridGeometry& voxels, double cell_m) {
  const Box bounds = voxels.bounds();
  GridGeometry cells;
  cells.voxel_size_m = cell_m;
  cells.origin_m = bounds.min() + Eigen::Vector3d::Constant(cell_m / 2);
  for (int axis = 0; axis < 3; ++axis)
    cells.size[axis] = static_cast<int>(std::floor(bounds.sizes()[axis] / cell_m + 1e-6));
  return cells;
}

/// First voxel of each cell along one axis, and one past the last voxel of the last cell.
std::vector<int> firstVoxels(const GridGeometry& voxels, const GridGeometry& cells, int axis) {
  std::vector<int> first(cells.size[axis] + 1);
  const double ratio = cells.voxel_size_m / voxels.voxel_size_m;
  for (int c = 0; c <= cells.size[axis]; ++c) {
    const double lower_edge = c * ratio - 0.5;  // in voxels; a centre on the edge belongs to the upper cell
    first[c] = std::clamp(static_cast<int>(std::ceil(lower_edge - kRounding)), 0, voxels.size[axis]);
  }
  return first;
}

/// Squared distance along one axis between a coordinate and the cell [c, c+1], in cells.
double axisGap(double g, int c) {
  return std::max({0.0, c - g, g - (c + 1)});
}

/// Offsets of the cells that a ball overlaps wherever in cell (0,0,0) its centre is.
std::vector<Eigen::Vector3i> alwaysTouched(double radius_cells) {
  std::vector<Eigen::Vector3i> offsets;
  const int reach = static_cast<int>(std::ceil(radius_cells));
  // The farthest centre is on the opposite side: distance |d| per axis, 0 along an axis without offset.
  for (int z = -reach; z <= reach; ++z)
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x)
        if (x * x + y * y + z * z < radius_cells * radius_cells - kRounding || (x == 0 && y == 0 && z == 0))
          offsets.emplace_back(x, y, z);
  return offsets;
}

std::vector<std::uint8_t> freeCells(const StateGrid& states, const GridGeometry& cells) {
  const GridGeometry& voxels = states.geometry();
  const std::array<std::vector<int>, 3> first = {firstVoxels(voxels, cells, 0), firstVoxels(voxels, cells, 1),
                                                 firstVoxels(voxels, cells, 2)};
  std::vector<std::uint8_t> free(cells.count(), 0);
  constexpr auto kFree = static_cast<std::uint8_t>(VoxelState::Free);
  tbb::parallel_for(0, cells.size.y() * cells.size.z(), [&](int row) {
    const int cy = row % cells.size.y(), cz = row / cells.size.y();
    std::vector<std::uint8_t> obstacle(voxels.size.x(), 0);  // along x, any voxel of the cells' cross-section
    for (int k = first[2][cz]; k < first[2][cz + 1]; ++k)
      for (int j = first[1][cy]; j < first[1][cy + 1]; ++j) {
        const std::uint8_t* state = states.states().data() + voxels.index(0, j, k);
        for (int i = 0; i < voxels.size.x(); ++i) obstacle[i] |= state[i] ^ kFree;
      }
    for (int cx = 0; cx < cells.size.x(); ++cx)
      free[cells.index(cx, cy, cz)] =
          std::all_of(obstacle.begin() + first[0][cx], obstacle.begin() + first[0][cx + 1],
                      [](std::uint8_t o) { return o == 0; });
  });
  return free;
}

}  // namespace

CollisionGrid::CollisionGrid(const StateGrid& states, double cell_m, double body_radius_m) {
  requireInRange("collision cell (m)", cell_m, states.geometry().voxel_size_m, 1e3);
  requireInRange("body radius (m)", body_radius_m, 0.0, 1e3);
  if (states.geometry().count() == 0) return;
  geometry_ = cellGeometry(states.geometry(), cell_m);
  free_ = freeCells(states, geometry_);
  labelComponents(body_radius_m);
}

void CollisionGrid::labelComponents(double body_radius_m) {
  constexpr std::uint32_t kOpen = 0xffffffffu;  // the ball may fit, not yet labelled
  const std::vector<Eigen::Vector3i> body = alwaysTouched(body_radius_m / geometry_.voxel_size_m);
  component_.assign(geometry_.count(), 0);
  tbb::parallel_for(0, geometry_.size.z(), [&](int z) {
    for (int y = 0; y < geometry_.size.y(); ++y)
      for (int x = 0; x < geometry_.size.x(); ++x) {
        const Eigen::Vector3i cell(x, y, z);
        if (freeCell(cell) &&
            std::all_of(body.begin(), body.end(), [&](const auto& o) { return freeCell(cell + o); }))
          component_[geometry_.index(cell)] = kOpen;
      }
  });
  std::vector<std::size_t> front;
  for (std::size_t seed = 0; seed < component_.size(); ++seed) {
    if (component_[seed] != kOpen) continue;
    component_[seed] = ++components_;
    front.push_back(seed);
    while (!front.empty()) {
      const Eigen::Vector3i cell = geometry_.voxel(front.back());
      front.pop_back();
      for (int n = 0; n < 27; ++n) {
        const Eigen::Vector3i next = cell + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        if (!geometry_.contains(next) || component_[geometry_.index(next)] != kOpen) continue;
        component_[geometry_.index(next)] = components_;
        front.push_back(geometry_.index(next));
      }
    }
  }
}

bool CollisionGrid::freeBall(const Eigen::Vector3d& center_world, double radius_m) const {
  if (!freeCell(geometry_.voxelAt(center_world))) return false;
  // Cell c covers [c, c+1] in these coordinates.
  const Eigen::Vector3d g = geometry_.toGrid(center_world) + Eigen::Vector3d::Constant(0.5);
  const double radius = radius_m / geometry_.voxel_size_m;
  const double limit = radius * radius - kRounding;
  const auto low = [&](int axis) { return static_cast<int>(std::floor(g[axis] - radius)); };
  const auto high = [&](int axis) { return static_cast<int>(std::floor(g[axis] + radius)); };
  for (int z = low(2); z <= high(2); ++z) {
    const double dz = axisGap(g.z(), z);
    for (int y = low(1); y <= high(1); ++y) {
      const double dy = axisGap(g.y(), y);
      if (dz * dz + dy * dy >= limit) continue;
      for (int x = low(0); x <= high(0); ++x) {
        const double dx = axisGap(g.x(), x);
        if (dz * dz + dy * dy + dx * dx < limit && !freeCell({x, y, z})) return false;
      }
    }
  }
  return true;
}

bool CollisionGrid::freeSegment(const Eigen::Vector3d& from_world, const Eigen::Vector3d& to_world,
                                double radius_m, double step_m) const {
  const double length = (to_world - from_world).norm();
  const int steps = std::max(1, static_cast<int>(std::ceil(length / step_m)));
  for (int s = 0; s <= steps; ++s)
    if (!freeBall(from_world + (to_world - from_world) * (static_cast<double>(s) / steps), radius_m))
      return false;
  return true;
}

std::uint32_t CollisionGrid::component(const Eigen::Vector3d& p_world) const {
  if (component_.empty()) return 0;
  const Eigen::Vector3i cell = geometry_.voxelAt(p_world);
  return geometry_.contains(cell) ? component_[geometry_.index(cell)] : 0;
}

}  // namespace vantage
