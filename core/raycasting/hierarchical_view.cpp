#include "core/raycasting/hierarchical_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "core/geometry/check.h"

namespace vantage::casting {
namespace {

/// Nodes that a box intersects by more than rounding (D-A8); low > high if there are none.
void nodesWithin(const GridGeometry& g, const Box& box, Region& region) {
  constexpr double kTouch = 1e-6;  // nodes
  for (int a = 0; a < 3; ++a) {
    const double corner = g.origin_m[a] - g.voxel_size_m / 2, end = g.size[a];
    const double low = (box.min()[a] - corner) / g.voxel_size_m + kTouch;
    const double high = (box.max()[a] - corner) / g.voxel_size_m - kTouch;
    region.low[a] = static_cast<int>(std::clamp(std::floor(low), 0.0, end));
    region.high[a] = static_cast<int>(std::clamp(std::ceil(high) - 1, -1.0, end - 1));
  }
}

}  // namespace

bool makeLevelBundle(const StateGrid& grid, int level, const RaySensor& sensor, const Pose& T_world_camera,
                     const HierarchicalQuery& query, Bundle& bundle) {
  if (!makeBundle(grid, T_world_camera, sensor.min_range_m, sensor.max_range_m, bundle)) return false;
  VisibilityQuery region;
  region.sphere = query.sphere;
  region.bounds = query.bounds;
  bundle.region = makeRegion(grid.geometry(), region);
  if (level > 0 && query.bounds) nodesWithin(grid.geometry(), *query.bounds, bundle.region);
  return true;
}

bool sensorIsBlocked(const Bundle& b) {
  for (int a = 0; a < 3; ++a)
    if (b.start[a] < 0 || b.start[a] >= b.grid.size[a]) return false;
  const std::size_t row = static_cast<std::size_t>(b.start[2]) * b.grid.size[1] + b.start[1];
  return b.grid.states[row * b.grid.size[0] + b.start[0]] != static_cast<std::uint8_t>(VoxelState::Free);
}

void requireSameResolution(const StateGrid& finest, const RayTree& tree) {
  const double grid = finest.geometry().voxel_size_m, rays = tree.level(0).voxel_size_m;
  if (std::abs(grid - rays) <= 1e-9 * rays) return;
  std::ostringstream text;
  text << "ray casting: the grid has voxels of " << grid << " m, the rays are made for " << rays
       << " m; both must be the same";
  throw std::invalid_argument(text.str());
}

HierarchicalView::HierarchicalView(const StatePyramid& pyramid, const RayTree& tree, int levels,
                                   const Pose& T_world_camera, const HierarchicalQuery& query)
    : coarse_levels(levels) {
  requireInRange("hierarchical ray casting: coarse_levels", levels, 0,
                 std::min(pyramid.coarseLevels(), tree.coarseLevels()));
  requireSameResolution(pyramid.finest(), tree);
  reaches = true;
  for (int i = 0; i <= levels; ++i) {
    reaches =
        reaches && makeLevelBundle(pyramid.level(i), i, tree.sensor(), T_world_camera, query, bundles[i]);
    step_back_m[i] = query.start == ChildStart::Resume ? static_cast<float>(tree.level(i).voxel_size_m)
                                                       : std::numeric_limits<float>::infinity();
  }
  blocked = reaches && sensorIsBlocked(bundles[0]);
}

}  // namespace vantage::casting
