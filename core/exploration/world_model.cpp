#include "core/exploration/world_model.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/geometry/check.h"

namespace vantage {
namespace {

/// A copy of each changed brick, ascending.
template <class Brick, class Read>
std::shared_ptr<const std::vector<Brick>> copyBricks(const BrickSet& changed, const Read& read) {
  const std::vector<std::uint32_t> list = changed.list();
  auto bricks = std::make_shared<std::vector<Brick>>(list.size());
  tbb::parallel_for(std::size_t{0}, list.size(), [&](std::size_t n) {
    (*bricks)[n].brick = list[n];
    read((*bricks)[n]);
  });
  return bricks;
}

}  // namespace

void OctreeMapConfig::validate() const {
  requireInRange("octree.voxel_size_m", voxel_size_m, 1e-3, 1.0);
  occupancy.validate();
}

WorldModel::WorldModel(const WorldConfig& config) : config_(config) {
  if (config.keep_volume) {
    volume_.emplace(config.volume);
    states_ = StateGrid(config.volume);
    volume_changed_ = BrickSet(volume_->bricks().total());
  }
  if (config.keep_octree) {
    const double edge = config.octree.voxel_size_m;
    octree_.emplace(OccupancyOctree::gridAround(config.volume.bounds(), edge), config.object_box,
                    config.octree.outside, config.octree.occupancy);
    pyramid_ = StatePyramid(*octree_, config.coarse_levels);
    octree_changed_ = BrickSet(octree_->bricks().total());
    std::ranges::fill(octree_changed_.flags(), std::uint8_t{1});
  }
}

void WorldModel::fuse(const DepthImage& depth, const Pose& T_world_camera, const PinholeCamera& camera,
                      const SensorBubble& bubble) {
  const Eigen::Vector3d eye = T_world_camera.translation();
  if (volume_) {
    if (bubble.volume_m > 0.0) volume_changed_.merge(clearSphere(*volume_, eye, bubble.volume_m));
    volume_changed_.merge(fuseDepth(*volume_, depth, camera, T_world_camera, config_.fusion).changed);
  }
  if (octree_) {
    if (bubble.octree_m > 0.0 && config_.octree.outside == VoxelState::Unknown)
      octree_changed_.merge(octree_->clearSphere(eye, bubble.octree_m));
    octree_changed_.merge(octree_->insert(depth, camera, T_world_camera).changed);
  }
}

void WorldModel::clearOctree(const Eigen::Vector3d& center_world, double radius_m) {
  if (octree_) octree_changed_.merge(octree_->clearSphere(center_world, radius_m));
}

void WorldModel::occupyOctree(const Box& box, const std::function<bool(const Eigen::Vector3d&)>& inside) {
  if (!octree_) return;
  const GridGeometry& grid = octree_->geometry();
  const Box part = box.intersection(grid.bounds());
  if (part.isEmpty()) return;
  const auto known = static_cast<float>(logOddsOf(octree_->config().clamp_max));
  const Eigen::Vector3i low = grid.voxelAt(part.min()).cwiseMax(0);
  const Eigen::Vector3i high = grid.voxelAt(part.max()).cwiseMin(grid.size - Eigen::Vector3i::Ones());
  for (int k = low.z(); k <= high.z(); ++k)
    for (int j = low.y(); j <= high.y(); ++j)
      for (int i = low.x(); i <= high.x(); ++i) {
        const Eigen::Vector3d center = grid.center({i, j, k});
        if (!part.contains(center) || octree_->objectBox().contains(center) || !inside(center)) continue;
        octree_->set({i, j, k}, known);
        octree_changed_.insert(octree_->bricks().brickOf({i, j, k}));
      }
}

MapChanges WorldModel::finishScan() {
  MapChanges changes;
  if (volume_) {
    states_.update(*volume_, volume_changed_);
    changes.volume =
        copyBricks<TsdfBrick>(volume_changed_, [&](TsdfBrick& b) { b.voxels = volume_->brick(b.brick); });
    volume_changed_ = BrickSet(volume_changed_.total());
  }
  if (octree_) {
    pyramid_.update(*octree_, octree_changed_);
    changes.octree = copyBricks<OctreeBrick>(octree_changed_, [&](OctreeBrick& b) {
      const BrickRange range = octree_->bricks().range(b.brick);
      b.log_odds.resize(static_cast<std::size_t>((range.end - range.begin).prod()));
      octree_->readBrick(b.brick, b.log_odds);
    });
    octree_changed_ = BrickSet(octree_changed_.total());
  }
  return changes;
}

}  // namespace vantage
