#include "tests/support/octree_caster.h"

#include <octomap/OcTree.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

#include "core/raycasting/plain_caster.h"

namespace vantage::testing {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Labels of nodes by OctoMap's search; each is looked up once.
class OctreeCaster::Labels {
 public:
  explicit Labels(const OccupancyOctree& map)
      : finest_(map.geometry()), config_(map.config()), first_(firstVoxelOf(map.geometry())) {
    std::stringstream stream;
    map.write(stream, OccupancyOctree::Format::Ot);
    std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(stream));
    tree_.reset(dynamic_cast<octomap::OcTree*>(read.get()));
    if (!tree_) throw std::runtime_error("octree caster: OctoMap does not read the map");
    read.release();
    for (int level = 0; level <= StatePyramid::kMaxCoarseLevels; ++level) {
      grids_.push_back(geometryOf(level));
      known_.emplace_back(grids_.back().count(), kNotYet);
    }
  }

  /// Nodes of a level that cover the grid.
  const GridGeometry& grid(int level) const { return grids_[level]; }

  VoxelState at(int level, const Vector3i& node) const {
    // Threads may look up the same label; they store the same.
    const std::atomic_ref<std::uint8_t> known(known_[level][grids_[level].index(node)]);
    std::uint8_t label = known.load(std::memory_order_relaxed);
    if (label == kNotYet) {
      label = static_cast<std::uint8_t>(level == 0 ? labelOf(logOdds(node)) : labelOfNode(level, node));
      known.store(label, std::memory_order_relaxed);
    }
    return static_cast<VoxelState>(label);
  }

 private:
  static constexpr std::uint8_t kNotYet = 255;

  int shifted(int axis, int level) const { return first_[axis] >> level; }
  int offset(int axis, int level) const { return first_[axis] - (shifted(axis, level) << level); }

  GridGeometry geometryOf(int level) const {
    GridGeometry g;
    g.voxel_size_m = std::ldexp(finest_.voxel_size_m, level);
    for (int a = 0; a < 3; ++a) {
      g.size[a] = ((offset(a, level) + finest_.size[a] - 1) >> level) + 1;
      g.origin_m[a] = finest_.origin_m[a] - finest_.voxel_size_m * offset(a, level) +
                      (g.voxel_size_m - finest_.voxel_size_m) / 2;
    }
    return g;
  }

  /// NaN if nothing is stored.
  double logOdds(const Vector3i& voxel) const {
    const Vector3d p = finest_.center(voxel);
    const octomap::OcTreeNode* node = tree_->search(p.x(), p.y(), p.z());
    return node ? node->getLogOdds() : std::nan("");
  }

  /// D-A7.
  VoxelState labelOf(double log_odds) const {
    if (std::isnan(log_odds)) return VoxelState::Unknown;
    const double p = 1.0 / (1.0 + std::exp(-log_odds));
    if (p >= config_.unknown_high) return VoxelState::Occupied;
    return p < config_.unknown_low ? VoxelState::Free : VoxelState::Unknown;
  }

  /// D-A5 and D-A6 over the node's voxels in the grid.
  VoxelState labelOfNode(int level, const Vector3i& node) const {
    const Vector3i corner =
        node * (1 << level) - Vector3i(offset(0, level), offset(1, level), offset(2, level));
    const Vector3i from = corner.cwiseMax(0);
    const Vector3i to = (corner + Vector3i::Constant(1 << level)).cwiseMin(finest_.size);
    int voxels = 0, free = 0, occupied = 0;
    double sum = 0.0;
    for (int k = from.z(); k < to.z(); ++k)
      for (int j = from.y(); j < to.y(); ++j)
        for (int i = from.x(); i < to.x(); ++i, ++voxels) {
          if (config_.inner == InnerRule::Mean) {
            const double log_odds = logOdds({i, j, k});
            sum += std::isnan(log_odds) ? 0.5 : 1.0 / (1.0 + std::exp(-log_odds));
            continue;
          }
          const VoxelState state = at(0, {i, j, k});
          free += state == VoxelState::Free;
          occupied += state == VoxelState::Occupied;
        }
    if (config_.inner == InnerRule::Mean) {
      const double p = sum / voxels;
      return labelOf(std::log(p / (1.0 - p)));
    }
    if (occupied > 0) return VoxelState::Occupied;
    return free == voxels ? VoxelState::Free : VoxelState::Unknown;
  }

  GridGeometry finest_;
  OccupancyConfig config_;
  Vector3i first_;
  std::unique_ptr<octomap::OcTree> tree_;
  std::vector<GridGeometry> grids_;
  mutable std::vector<std::vector<std::uint8_t>> known_;
};

class OctreeCaster::Tracer {
 public:
  Tracer(const Labels& labels, const RayTree& tree, const Pose& T_world_camera,
         const HierarchicalQuery& query)
      : labels_(labels), tree_(tree), pose_(T_world_camera), query_(query) {}

  RayCounts trace(int start) {
    const GridGeometry& finest = labels_.grid(0);
    const Vector3i own = finest.voxelAt(pose_.translation());
    if (finest.contains(own) && labels_.at(0, own) != VoxelState::Free) {  // D-A12
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
    const GridGeometry& g = labels_.grid(level);
    ++counts_.rays_cast;
    counts_.finest_rays_cast += level == 0;
    float length = 1.0f;
    casting::PlainRay<float> r = ray(level, rays.index(row, column), g, length);
    r.start = start_m / length;
    const int size[3] = {g.size.x(), g.size.y(), g.size.z()};
    const auto end = casting::walkPlainly(size, r, [&](int i, int j, int k) {
      return labels_.at(level, {i, j, k}) != VoxelState::Free;
    });
    counts_.visited += end.visited;
    if (!end.hit) return;
    const Vector3i node(end.voxel[0], end.voxel[1], end.voxel[2]);
    const float back = query_.start == ChildStart::Restart ? INFINITY : static_cast<float>(g.voxel_size_m);
    if (level > 0 && node == g.voxelAt(pose_.translation()))  // D-A12
      return refine(level, row, column, end.t * length - back);
    const bool near = end.t < static_cast<float>(tree_.sensor().min_range_m) / length;
    const bool unknown = labels_.at(level, node) == VoxelState::Unknown;
    const bool inside = counts(level, g, node);
    if (near && (level == 0 || !inside)) return;  // D-A22
    if (!inside) {                                // D-A8, D-A9
      counts_.unknown_scene += unknown ? rays.leaves(row, column) : 0;
      return;
    }
    if (level > 0 && (!unknown || near || query_.refine_unknown))
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

  const Labels& labels_;
  const RayTree& tree_;
  const Pose& pose_;
  const HierarchicalQuery& query_;
  RayCounts counts_;
  std::set<std::size_t> unknown_, occupied_;
};

OctreeCaster::OctreeCaster(const OccupancyOctree& map) : labels_(std::make_unique<Labels>(map)) {}
OctreeCaster::~OctreeCaster() = default;

RayCounts OctreeCaster::cast(const RayTree& tree, int coarse_levels, const Pose& T_world_camera,
                             const HierarchicalQuery& query) const {
  return Tracer(*labels_, tree, T_world_camera, query).trace(coarse_levels);
}

}  // namespace vantage::testing
