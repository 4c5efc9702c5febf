#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "core/geometry/check.h"
#include "core/volume/tsdf_fusion_kernel.h"
#include "core/volume/tsdf_volume.h"

namespace vantage {

void FusionConfig::validate(double voxel_size_m) const {
  requireInRange("fusion.truncation_m", truncation_m, 2.1 * voxel_size_m * (1 - 1e-12), 1e3);
  requireInRange("fusion.max_weight", max_weight, 1, 60000);
  requireInRange("fusion.observations_per_frame", observations_per_frame, 1, max_weight);
}

namespace {

/// A frame prepared for fusion: ranges along the rays and the affine maps of voxel rows.
class PreparedFrame {
 public:
  PreparedFrame(const TsdfVolume& volume, const DepthImage& depth, const PinholeCamera& camera,
                const Pose& T_world_camera, const FusionConfig& config)
      : camera_(camera) {
    const GridGeometry& g = volume.geometry();
    camera.validate();
    config.validate(g.voxel_size_m);
    requireSize(depth, camera);
    measureRanges(depth);
    const Pose T_camera_world = T_world_camera.inverse();
    corner_ = T_camera_world * g.origin_m;
    axes_ = T_camera_world.linear() * g.voxel_size_m;
    camera_grid_ = g.toGrid(T_world_camera.translation());
    voxel_m_ = g.voxel_size_m;
    frame_.range_m = range_m_.data();
    frame_.width = camera.width;
    frame_.height = camera.height;
    frame_.units_per_m = static_cast<float>(fusion::kFull / config.truncation_m);
    frame_.voxel_m = static_cast<float>(g.voxel_size_m);
    frame_.camera_x = static_cast<float>(camera_grid_.x());
    frame_.observations = static_cast<float>(config.observations_per_frame);
    frame_.increment = config.observations_per_frame;
    frame_.max_weight = config.max_weight;
  }

  const fusion::Frame& frame() const { return frame_; }

  fusion::Row row(int y, int z) const {
    const Eigen::Vector3d c = corner_ + y * axes_.col(1) + z * axes_.col(2), d = axes_.col(0);
    const double cx = camera_.cx + 0.5, cy = camera_.cy + 0.5;
    const double ry = (y - camera_grid_.y()) * voxel_m_, rz = (z - camera_grid_.z()) * voxel_m_;
    return {static_cast<float>(camera_.fx * c.x() + cx * c.z()),
            static_cast<float>(camera_.fx * d.x() + cx * d.z()),
            static_cast<float>(camera_.fy * c.y() + cy * c.z()),
            static_cast<float>(camera_.fy * d.y() + cy * d.z()),
            static_cast<float>(c.z()),
            static_cast<float>(d.z()),
            static_cast<float>(ry * ry + rz * rz)};
  }

 private:
  static void requireSize(const DepthImage& depth, const PinholeCamera& camera) {
    const std::size_t pixels = static_cast<std::size_t>(camera.width) * camera.height;
    if (depth.width == camera.width && depth.height == camera.height && depth.depth_m.size() == pixels)
      return;
    std::ostringstream text;
    text << "depth image is " << depth.width << " x " << depth.height << ", its camera " << camera.width
         << " x " << camera.height << "; they must agree";
    throw std::invalid_argument(text.str());
  }

  void measureRanges(const DepthImage& depth) {
    const auto low = static_cast<float>(camera_.min_range_m), high = static_cast<float>(camera_.max_range_m);
    range_m_.resize(depth.depth_m.size());
    tbb::parallel_for(
        tbb::blocked_range<int>(0, camera_.height, 32), [&](const tbb::blocked_range<int>& rows) {
          for (int v = rows.begin(); v < rows.end(); ++v)
            for (int u = 0; u < camera_.width; ++u) {
              const float z = depth.at(u, v);
              const auto x = static_cast<float>((u - camera_.cx) / camera_.fx);
              const auto y = static_cast<float>((v - camera_.cy) / camera_.fy);
              const bool valid = z >= low && z <= high && z > 0.0f;
              const float length = z * std::sqrt(x * x + y * y + 1.0f);
              range_m_[static_cast<std::size_t>(v) * camera_.width + u] = valid ? length : fusion::kNoRange;
            }
        });
  }

  PinholeCamera camera_;
  std::vector<float> range_m_;
  fusion::Frame frame_;
  Eigen::Vector3d corner_;  ///< voxel (0,0,0) in the camera frame, metres
  Eigen::Matrix3d axes_;    ///< steps of one voxel along x, y, z in the camera frame, metres
  Eigen::Vector3d camera_grid_;
  double voxel_m_ = 0;
};

}  // namespace

FusionResult fuseDepth(TsdfVolume& volume, const DepthImage& depth, const PinholeCamera& camera,
                       const Pose& T_world_camera, const FusionConfig& config) {
  const PreparedFrame prepared(volume, depth, camera, T_world_camera, config);
  const BrickLayout& bricks = volume.bricks();
  const fusion::Kernels kernels = fusion::portableKernels();
  FusionResult result;
  result.changed = BrickSet(bricks.total());
  const int rows = bricks.count.y() * bricks.count.z();
  std::vector<std::uint64_t> updated(rows, 0);
  tbb::parallel_for(tbb::blocked_range<int>(0, rows), [&](const tbb::blocked_range<int>& range) {
    for (int r = range.begin(); r < range.end(); ++r) {
      const std::uint32_t first = static_cast<std::uint32_t>(r) * bricks.count.x();
      const BrickRange box = bricks.range(first);
      for (int z = box.begin.z(); z < box.end.z(); ++z)
        for (int y = box.begin.y(); y < box.end.y(); ++y)
          updated[r] += kernels.project(prepared.frame(), prepared.row(y, z), &volume.at(0, y, z), 0,
                                        bricks.grid.x(), result.changed.flags().data() + first);
    }
  });
  result.voxels_updated = std::accumulate(updated.begin(), updated.end(), std::uint64_t{0});
  return result;
}

FusionResult fuseDepthReference(TsdfVolume& volume, const DepthImage& depth, const PinholeCamera& camera,
                                const Pose& T_world_camera, const FusionConfig& config) {
  const PreparedFrame prepared(volume, depth, camera, T_world_camera, config);
  const Eigen::Vector3i size = volume.geometry().size;
  FusionResult result;
  result.changed = BrickSet(volume.bricks().total());
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y) {
      const fusion::Row row = prepared.row(y, z);
      for (int x = 0; x < size.x(); ++x) {
        float value = 0.0f;
        if (!fusion::measure(prepared.frame(), row, x, value)) continue;
        TsdfVoxel& voxel = volume.at(x, y, z);
        fusion::Voxel next{voxel.value, voxel.weight};
        if (fusion::observe(prepared.frame(), value, next))
          result.changed.insert(volume.bricks().brickOf({x, y, z}));
        voxel = {next.value, next.weight};
        ++result.voxels_updated;
      }
    }
  return result;
}

}  // namespace vantage
