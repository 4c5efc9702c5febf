#include "core/raycasting/hierarchical_caster.h"

#include <algorithm>
#include <array>
#include <memory>

#include "core/raycasting/hierarchical_view.h"

namespace vantage {
namespace casting {
namespace {

constexpr std::uint32_t kPacket = 16;
/// Rays of a level that are cast before their children are, whole packets: what is on its way stays in the
/// cache, and memory small enough to be handed out again warm.
constexpr std::uint32_t kSlice = 64 * kPacket;

/// Memory for the children of a slice.
class RayBuffer {
 public:
  /// Empties it and makes room.
  void reserve(std::uint32_t rays) {
    static_assert(kPacket >= RayFamilies::kMargin);
    list_.count = 0;
    if (rays <= room_) return;
    room_ = rays;
    const std::size_t size = rays + kPacket;
    slope_x_.reset(new float[size]);
    slope_y_.reset(new float[size]);
    start_m_.reset(new float[size]);
    ray_.reset(new std::uint32_t[size]);
    list_ = {slope_x_.get(), slope_y_.get(), start_m_.get(), ray_.get(), 0};
  }

  ChildList& empty() {
    list_.count = 0;
    return list_;
  }

  /// The rays, and zeros up to a whole packet behind them.
  RayList rays() {
    const std::uint32_t end = (list_.count + kPacket - 1) / kPacket * kPacket;
    for (float* field : {list_.slope_x, list_.slope_y, list_.start_m})
      std::fill(field + list_.count, field + end, 0.0f);
    std::fill(list_.ray + list_.count, list_.ray + end, 0u);
    return {list_.slope_x, list_.slope_y, list_.start_m, list_.ray, nullptr, list_.count};
  }

 private:
  std::unique_ptr<float[]> slope_x_, slope_y_, start_m_;
  std::unique_ptr<std::uint32_t[]> ray_;
  ChildList list_;
  std::uint32_t room_ = 0;
};

/// One a level; kept by each thread, since clean memory for every view costs more than to fill it.
using RayBuffers = std::array<RayBuffer, StatePyramid::kMaxCoarseLevels>;
RayBuffers& buffersOfThread() {
  thread_local RayBuffers buffers;
  return buffers;
}

/// Part of a list; `first` is a multiple of kPacket.
RayList sliceOf(const RayList& list, std::uint32_t first) {
  return {list.slope_x + first,
          list.slope_y + first,
          list.start_m ? list.start_m + first : nullptr,
          list.ray + first,
          list.lanes ? list.lanes + first / kPacket : nullptr,
          std::min(list.count - first, kSlice)};
}

/// All rays of a level, from the sensor.
RayList allRays(const RayLevel& level) {
  const RayTiles& tiles = level.tiles;
  return {tiles.slope_x.data(), tiles.slope_y.data(), nullptr,
          tiles.place.data(),   tiles.lanes.data(),   static_cast<std::uint32_t>(tiles.ray.size())};
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

/// Casts lists of rays level by level.
class Descent {
 public:
  Descent(CpuPath path, const HierarchicalView& view, const RayTree& tree, const HierarchicalQuery& query,
          RayCounts& counts)
      : cast_(castListFor(path)), view_(view), tree_(tree), query_(query), counts_(counts) {
    for (int i = 0; i < view.coarse_levels; ++i) buffers_[i].reserve(roomFor(i));
    if (query.distinct_voxels) totals_.hits = &hits_;
  }

  void run() {
    castList(view_.coarse_levels, allRays(tree_.level(view_.coarse_levels)));
    take(totals_, counts_);
    takeVoxels(hits_, counts_);
  }

 private:
  /// Most children of a slice of the next coarser level.
  std::uint32_t roomFor(int level) const {
    return std::min(tree_.level(level).count(), tree_.level(level + 1).families.most_children * kSlice);
  }

  void castList(int level, const RayList& list) {
    if (level == 0) return cast_(view_.bundles[0], list, {}, totals_);
    for (std::uint32_t first = 0; first < list.count; first += kSlice) {
      RayBuffer& buffer = buffers_[level - 1];
      cast_(view_.bundles[level], sliceOf(list, first), refinementOf(level, buffer.empty()), totals_);
      const RayList children = buffer.rays();
      counts_.rays_cast += children.count;
      if (level == 1) counts_.finest_rays_cast += children.count;
      castList(level - 1, children);
    }
  }

  Refinement refinementOf(int level, ChildList& children) const {
    const RayFamilies& fine = tree_.level(level - 1).families;
    return {tree_.level(level).families.family.data(),
            fine.slope_x.data(),
            fine.slope_y.data(),
            view_.step_back_m[level],
            query_.refine_unknown,
            &children};
  }

  CastList cast_;
  const HierarchicalView& view_;
  const RayTree& tree_;
  const HierarchicalQuery& query_;
  RayCounts& counts_;
  RayBuffers& buffers_ = buffersOfThread();  ///< of the levels below the start
  Totals totals_;
  std::vector<Hit> hits_;
};

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

  Descent(path, view, tree, query, counts).run();
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
