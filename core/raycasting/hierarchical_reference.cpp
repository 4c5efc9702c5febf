// Algorithm 2 as it is written: one ray after the other, voxel by voxel.
#include <algorithm>

#include "core/raycasting/hierarchical_caster.h"
#include "core/raycasting/hierarchical_view.h"

namespace vantage {
namespace casting {
namespace {

class PlainTracer {
 public:
  PlainTracer(const StatePyramid& pyramid, const RayTree& tree, int coarse_levels, const Pose& T_world_camera,
              const HierarchicalQuery& query, std::vector<TracedRay>* traced)
      : pyramid_(pyramid),
        tree_(tree),
        query_(query),
        view_(pyramid, tree, coarse_levels, T_world_camera, query),
        traced_(traced) {}

  RayCounts trace() {
    if (view_.blocked) {
      counts_.sensor_blocked = true;
      return counts_;
    }
    const RayLevel& start = tree_.level(view_.coarse_levels);
    counts_.rays = tree_.level(0).count();
    for (std::uint32_t row = 0; row < start.rows.count(); ++row)
      for (std::uint32_t column = 0; column < start.columns.count(); ++column)
        cast(view_.coarse_levels, row, column, 0.0f);
    counts_.unknown_voxels = countDistinct(std::move(unknown_voxels_));
    counts_.occupied_voxels = countDistinct(std::move(occupied_voxels_));
    return counts_;
  }

 private:
  /// D-A3: whether a ray is a leaf is asked of the ray that is cast, not of its parent.
  void cast(int level, std::uint32_t row, std::uint32_t column, float start_m) {
    ++counts_.rays_cast;
    if (level == 0) ++counts_.finest_rays_cast;
    const RayLevel& rays = tree_.level(level);
    const std::uint32_t index = rays.index(row, column);
    TracedRay traced{.level = static_cast<std::uint8_t>(level), .ray = index, .start_m = start_m};
    traced.node.setConstant(-1);
    if (view_.reaches) walk(traced);
    if (traced_) traced_->push_back(traced);
    count(traced.fate, level, rays.leaves(row, column), traced.node);
    if (traced.fate != RayFate::Refined) return;  // D-A13: a child of a ray that passes may have hit
    const float begin = traced.end_m - view_.step_back_m[level];  // D-A11
    const float child_start = begin < 0.0f ? 0.0f : begin;
    for (std::uint32_t r = rays.rows.first_child[row]; r < rays.rows.first_child[row + 1]; ++r)
      for (std::uint32_t c = rays.columns.first_child[column]; c < rays.columns.first_child[column + 1]; ++c)
        cast(level - 1, r, c, child_start);
  }

  void walk(TracedRay& traced) {
    const Bundle& bundle = view_.bundles[traced.level];
    const RayLevel& rays = tree_.level(traced.level);
    const StateGrid& grid = pyramid_.level(traced.level);
    float length = 1.0f;
    PlainRay<float> ray = plainRay(bundle, rays.slope_x[traced.ray], rays.slope_y[traced.ray], length);
    ray.start = traced.start_m / length;
    const PlainHit<float> end = walkPlainly(
        bundle.grid.size, ray, [&](int i, int j, int k) { return grid.at(i, j, k) != VoxelState::Free; });
    counts_.visited += end.visited;
    traced.end_m = end.hit ? end.t * length : bundle.max_range_m;
    if (!end.hit) return;
    traced.fate = judge(traced.level, end.voxel, end.t < bundle.min_range_m / length);
    traced.node = {end.voxel[0], end.voxel[1], end.voxel[2]};
  }

  RayFate judge(int level, const int (&node)[3], bool near) const {
    const Bundle& b = view_.bundles[level];
    const bool own = node[0] == b.start[0] && node[1] == b.start[1] && node[2] == b.start[2];
    if (level > 0 && own) return RayFate::Refined;  // D-A12
    const bool unknown = pyramid_.level(level).at(node[0], node[1], node[2]) == VoxelState::Unknown;
    const bool inside = withinBounds(b.region, node) && squaredDistance(b.region, node) <= b.region.radius2;
    if (near && (level == 0 || !inside)) return RayFate::TooNear;              // D-A22
    if (!inside) return unknown ? RayFate::OutsideUnknown : RayFate::Outside;  // D-A8
    if (level > 0 && (!unknown || near || query_.refine_unknown)) return RayFate::Refined;
    return unknown ? RayFate::Unknown : RayFate::Occupied;
  }

  void count(RayFate fate, int level, std::uint64_t leaves, const Eigen::Vector3i& node) {
    if (fate == RayFate::OutsideUnknown) counts_.unknown_scene += leaves;  // D-A9
    if (fate == RayFate::Unknown) counts_.unknown += leaves;               // D-A14
    if (fate == RayFate::Occupied) counts_.occupied += leaves;
    if (level > 0 || !query_.distinct_voxels) return;
    const auto voxel = [&] { return static_cast<std::int32_t>(pyramid_.finest().geometry().index(node)); };
    if (fate == RayFate::Unknown) unknown_voxels_.push_back(voxel());
    if (fate == RayFate::Occupied) occupied_voxels_.push_back(voxel());
  }

  const StatePyramid& pyramid_;
  const RayTree& tree_;
  const HierarchicalQuery& query_;
  HierarchicalView view_;
  std::vector<TracedRay>* traced_;
  RayCounts counts_;
  std::vector<std::int32_t> unknown_voxels_, occupied_voxels_;
};

}  // namespace
}  // namespace casting

RayCounts castHierarchicalReference(const StatePyramid& pyramid, const RayTree& tree, int coarse_levels,
                                    const Pose& T_world_camera, const HierarchicalQuery& query) {
  return casting::PlainTracer(pyramid, tree, coarse_levels, T_world_camera, query, nullptr).trace();
}

RayCounts traceHierarchical(const StatePyramid& pyramid, const RayTree& tree, int coarse_levels,
                            const Pose& T_world_camera, const HierarchicalQuery& query,
                            std::vector<TracedRay>& rays) {
  rays.clear();
  return casting::PlainTracer(pyramid, tree, coarse_levels, T_world_camera, query, &rays).trace();
}

}  // namespace vantage
