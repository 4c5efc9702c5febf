#include "tests/support/octree_caster.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/raycasting/plain_caster.h"

namespace vantage::testing {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

class OctreeTracer {
 public:
  OctreeTracer(const OccupancyOctree& map, const RayTree& tree, const Pose& T_world_camera,
               const HierarchicalQuery& query)
      : map_(map), tree_(tree), pose_(T_world_camera), query_(query), first_(firstVoxelOf(map.geometry())) {}

  RayCounts trace(int start) {
    const GridGeometry& finest = map_.geometry();
    const Vector3i own = finest.voxelAt(pose_.translation());
    if (finest.contains(own) && map_.label(own, 0) != VoxelState::Free) {  // D-A12
      counts_.sensor_blocked = true;
      return counts_;
    }
    counts_.rays = tree_.level(0).count();
    for (std::uint32_t j = 0; j < tree_.level(start).rows.count(); ++j)
      for (std::uint32_t k = 0; k < tree_.level(start).columns.count(); ++k) cast(start, j, k, 0.0f);
    counts_.unknown_voxels = unknown_.size();
    counts_.occupied_voxels = occupied_.size();
    return counts_;
  }

 private:
  int shifted(int axis, int level) const { return first_[axis] >> level; }
  int offset(int axis, int level) const { return first_[axis] - (shifted(axis, level) << level); }

  /// Nodes of a level that cover the grid.
  GridGeometry geometry(int level) const {
    const GridGeometry& finest = map_.geometry();
    GridGeometry g;
    g.voxel_size_m = std::ldexp(finest.voxel_size_m, level);
    for (int a = 0; a < 3; ++a) {
      g.size[a] = ((offset(a, level) + finest.size[a] - 1) >> level) + 1;
      g.origin_m[a] = finest.origin_m[a] - finest.voxel_size_m * offset(a, level) +
                      (g.voxel_size_m - finest.voxel_size_m) / 2;
    }
    return g;
  }

  VoxelState label(int level, const Vector3i& node) const {
    Vector3i voxel;
    for (int a = 0; a < 3; ++a) voxel[a] = std::max(0, (node[a] << level) - offset(a, level));
    return map_.label(voxel, level);
  }

  bool counts(int level, const GridGeometry& g, const Vector3i& node) const {
    const Vector3d center = g.center(node);
    if (query_.sphere && (center - query_.sphere->center).norm() > query_.sphere->radius) return false;
    if (!query_.bounds) return true;
    if (level == 0) return query_.bounds->contains(center);
    const Vector3d half = Vector3d::Constant(g.voxel_size_m * (0.5 - 1e-6));  // touching is not intersecting
    return query_.bounds->intersects(Box(center - half, center + half));
  }

  casting::PlainRay<float> ray(int level, std::uint32_t index, const GridGeometry& g, float& length) const {
    const float x = tree_.level(level).slope_x[index], y = tree_.level(level).slope_y[index];
    length = std::sqrt(x * x + y * y + 1.0f);
    const Vector3d origin = g.toGrid(pose_.translation()) + Vector3d::Constant(0.5);
    const Eigen::Matrix3d axes = pose_.linear() / g.voxel_size_m;
    casting::PlainRay<float> r{};
    for (int a = 0; a < 3; ++a) {
      r.origin[a] = static_cast<float>(origin[a]);
      r.direction[a] = static_cast<float>(axes(a, 2)) + x * static_cast<float>(axes(a, 0)) +
                       y * static_cast<float>(axes(a, 1));
    }
    r.end = static_cast<float>(tree_.sensor().max_range_m) / length;
    return r;
  }

  void cast(int level, std::uint32_t row, std::uint32_t column, float start_m) {
    const RayLevel& rays = tree_.level(level);
    const GridGeometry g = geometry(level);
    ++counts_.rays_cast;
    counts_.finest_rays_cast += level == 0;
    float length = 1.0f;
    casting::PlainRay<float> r = ray(level, rays.index(row, column), g, length);
    r.start = start_m / length;
    const int size[3] = {g.size.x(), g.size.y(), g.size.z()};
    const auto end = casting::walkPlainly(size, r, [&](int i, int j, int k) {
      return label(level, {i, j, k}) != VoxelState::Free;
    });
    counts_.visited += end.visited;
    if (!end.hit) return;
    const Vector3i node(end.voxel[0], end.voxel[1], end.voxel[2]);
    const float back = query_.start == ChildStart::Restart ? INFINITY : static_cast<float>(g.voxel_size_m);
    if (level > 0 && node == g.voxelAt(pose_.translation()))  // D-A12
      return refine(level, row, column, end.t * length - back);
    if (end.t < static_cast<float>(tree_.sensor().min_range_m) / length) return;  // D-A22
    const bool unknown = label(level, node) == VoxelState::Unknown;
    if (!counts(level, g, node)) {  // D-A8, D-A9
      counts_.unknown_scene += unknown ? rays.leaves(row, column) : 0;
      return;
    }
    if (level > 0 && (!unknown || query_.refine_unknown))
      return refine(level, row, column, end.t * length - back);
    (unknown ? counts_.unknown : counts_.occupied) += rays.leaves(row, column);
    if (level == 0 && query_.distinct_voxels) (unknown ? unknown_ : occupied_).insert(g.index(node));
  }

  // D-A11.
  void refine(int level, std::uint32_t row, std::uint32_t column, float start_m) {
    const RayLevel& rays = tree_.level(level);
    for (std::uint32_t j = rays.rows.first_child[row]; j < rays.rows.first_child[row + 1]; ++j)
      for (std::uint32_t k = rays.columns.first_child[column]; k < rays.columns.first_child[column + 1]; ++k)
        cast(level - 1, j, k, std::max(0.0f, start_m));
  }

  const OccupancyOctree& map_;
  const RayTree& tree_;
  const Pose& pose_;
  const HierarchicalQuery& query_;
  const Vector3i first_;
  RayCounts counts_;
  std::set<std::size_t> unknown_, occupied_;
};

}  // namespace

RayCounts castThroughOctree(const OccupancyOctree& map, const RayTree& tree, int coarse_levels,
                            const Pose& T_world_camera, const HierarchicalQuery& query) {
  return OctreeTracer(map, tree, T_world_camera, query).trace(coarse_levels);
}

}  // namespace vantage::testing
