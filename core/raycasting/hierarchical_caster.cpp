#include "core/raycasting/hierarchical_caster.h"

#include <algorithm>
#include <memory>

#include "core/raycasting/hierarchical_view.h"

namespace vantage {
namespace casting {
namespace {

/// Memory for the rays of one level that are to be cast.
class RayBuffer {
 public:
  explicit RayBuffer(std::uint32_t rays) : size_((rays + kPacket - 1) / kPacket * kPacket + kPacket) {
    slopes_and_starts_.reset(new float[3 * static_cast<std::size_t>(size_)]);
    rays_.reset(new std::uint32_t[size_]);
    children_.slope_x = slopes_and_starts_.get();
    children_.slope_y = children_.slope_x + size_;
    children_.start_m = children_.slope_y + size_;
    children_.ray = rays_.get();
  }

  ChildList& children() { return children_; }

  /// The rays, and whole packets of zeros behind them.
  RayList list() {
    const std::uint32_t end = std::min(size_, (children_.count + kPacket - 1) / kPacket * kPacket);
    for (float* field : {children_.slope_x, children_.slope_y, children_.start_m})
      std::fill(field + children_.count, field + end, 0.0f);
    std::fill(children_.ray + children_.count, children_.ray + end, 0u);
    return {children_.slope_x, children_.slope_y, children_.start_m, children_.ray, nullptr, children_.count};
  }

 private:
  static constexpr std::uint32_t kPacket = 16;
  static_assert(kPacket >= RayLevel::kSlopeMargin);
  std::uint32_t size_;
  std::unique_ptr<float[]> slopes_and_starts_;
  std::unique_ptr<std::uint32_t[]> rays_;
  ChildList children_;
};

/// All rays of a level, from the sensor.
RayList allRays(const RayLevel& level) {
  const RayTiles& tiles = level.tiles;
  return {tiles.slope_x.data(), tiles.slope_y.data(), nullptr,
          tiles.ray.data(),     tiles.lanes.data(),   static_cast<std::uint32_t>(tiles.ray.size())};
}

void take(const Totals& totals, RayCounts& counts) {
  counts.unknown += totals.unknown;
  counts.occupied += totals.occupied;
  counts.unknown_scene += totals.unknown_outside;
  counts.visited += totals.visited;
}

void takeVoxels(const std::vector<Hit>& hits, RayCounts& counts) {
  std::vector<std::int32_t> unknown, occupied;
  for (const Hit& hit : hits)
    if (hit.in_sphere) (hit.unknown ? unknown : occupied).push_back(hit.voxel);
  counts.unknown_voxels = countDistinct(std::move(unknown));
  counts.occupied_voxels = countDistinct(std::move(occupied));
}

RayCounts blockedView() {
  RayCounts counts;
  counts.sensor_blocked = true;
  return counts;
}

Refinement refinementOf(const HierarchicalView& view, const RayTree& tree, int level,
                        const HierarchicalQuery& query, ChildList& children) {
  const RayLevel &coarse = tree.level(level), &fine = tree.level(level - 1);
  return {coarse.families.data(),
          fine.slope_x.data(),
          fine.slope_y.data(),
          fine.columns.count(),
          view.step_back_m[level],
          query.refine_unknown,
          &children};
}

}  // namespace

RayCounts castHierarchicalOn(CpuPath path, const StatePyramid& pyramid, const RayTree& tree,
                             int coarse_levels, const Pose& T_world_camera, const HierarchicalQuery& query) {
  const HierarchicalView view(pyramid, tree, coarse_levels, T_world_camera, query);
  if (view.blocked) return blockedView();
  RayCounts counts;
  counts.rays = tree.level(0).count();
  counts.rays_cast = tree.level(coarse_levels).count();
  if (coarse_levels == 0) counts.finest_rays_cast = counts.rays_cast;
  if (!view.reaches) return counts;

  const CastList cast = castListFor(path);
  Totals totals;
  RayList list = allRays(tree.level(coarse_levels));
  std::unique_ptr<RayBuffer> held;
  for (int i = coarse_levels; i > 0; --i) {
    auto children = std::make_unique<RayBuffer>(tree.level(i - 1).count());
    cast(view.bundles[i], list, refinementOf(view, tree, i, query, children->children()), totals);
    list = children->list();
    counts.rays_cast += list.count;
    if (i == 1) counts.finest_rays_cast = list.count;
    held = std::move(children);
  }
  std::vector<Hit> hits;
  if (query.distinct_voxels) totals.hits = &hits;
  cast(view.bundles[0], list, {}, totals);
  take(totals, counts);
  takeVoxels(hits, counts);
  return counts;
}

RayCounts castUniformRaysOn(CpuPath path, const StateGrid& grid, const RayTree& tree,
                            const Pose& T_world_camera, const HierarchicalQuery& query) {
  requireSameResolution(grid, tree);
  RayCounts counts;
  counts.rays = counts.rays_cast = counts.finest_rays_cast = tree.level(0).count();
  Bundle bundle;
  if (!makeLevelBundle(grid, 0, tree.sensor(), T_world_camera, query, bundle)) return counts;
  if (sensorIsBlocked(bundle)) return blockedView();
  const RayTiles& tiles = tree.level(0).tiles;
  Totals totals;
  std::vector<Hit> hits;
  if (query.distinct_voxels) totals.hits = &hits;
  castRowFor(path)(bundle,
                   {tiles.slope_x.data(), tiles.slope_y.data(), 16, tiles.lanes.data(),
                    static_cast<int>(tiles.lanes.size())},
                   totals);
  take(totals, counts);
  takeVoxels(hits, counts);
  return counts;
}

}  // namespace casting

RayCounts castHierarchical(const StatePyramid& pyramid, const RayTree& tree, int coarse_levels,
                           const Pose& T_world_camera, const HierarchicalQuery& query) {
  return casting::castHierarchicalOn(bestCpuPath(), pyramid, tree, coarse_levels, T_world_camera, query);
}

RayCounts castUniformRays(const StateGrid& grid, const RayTree& tree, const Pose& T_world_camera,
                          const HierarchicalQuery& query) {
  return casting::castUniformRaysOn(bestCpuPath(), grid, tree, T_world_camera, query);
}

}  // namespace vantage
