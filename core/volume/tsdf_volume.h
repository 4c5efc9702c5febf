#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/depth_image.h"
#include "core/geometry/grid_geometry.h"
#include "core/geometry/pose.h"
#include "core/volume/bricks.h"
#include "core/volume/bulk_memory.h"
#include "core/volume/voxel_state.h"

namespace vantage {

/// One voxel of a truncated signed distance field. `value` / 32767 is the signed distance in units of the
/// truncation, in [-1, 1], positive = empty; `weight` counts observations, 0 = never seen.
struct TsdfVoxel {
  std::int16_t value = 0;
  std::uint16_t weight = 0;

  static constexpr float kScale = 32767.0f;
  float distance() const { return value / kScale; }
  /// Eq. (1), Monica & Aleotti 2017.
  VoxelState state() const {
    if (weight == 0) return VoxelState::Unknown;
    return value <= 0 ? VoxelState::Occupied : VoxelState::Free;
  }
  bool operator==(const TsdfVoxel&) const = default;
};
static_assert(sizeof(TsdfVoxel) == 4);

/// Dense TSDF. Linear memory, x fastest; nothing known at start.
class TsdfVolume {
 public:
  TsdfVolume() = default;
  /// \throws std::invalid_argument for a size below 2 or a voxel size that is not positive,
  ///         std::runtime_error naming the size if the volume does not fit in memory.
  explicit TsdfVolume(const GridGeometry& geometry);

  const GridGeometry& geometry() const { return geometry_; }
  const BrickLayout& bricks() const { return bricks_; }

  const TsdfVoxel& at(int i, int j, int k) const { return voxels_[geometry_.index(i, j, k)]; }
  const TsdfVoxel& at(const Eigen::Vector3i& v) const { return voxels_[geometry_.index(v)]; }
  TsdfVoxel& at(int i, int j, int k) { return voxels_[geometry_.index(i, j, k)]; }
  TsdfVoxel& at(const Eigen::Vector3i& v) { return voxels_[geometry_.index(v)]; }
  std::span<const TsdfVoxel> voxels() const { return voxels_; }
  std::span<TsdfVoxel> voxels() { return voxels_; }

  /// Voxels of a brick, x fastest within its range.
  std::vector<TsdfVoxel> brick(std::uint32_t brick) const;
  /// Replaces a brick. \throws std::invalid_argument if the number of voxels differs.
  void setBrick(std::uint32_t brick, std::span<const TsdfVoxel> voxels);

 private:
  GridGeometry geometry_;
  BrickLayout bricks_;
  BulkVector<TsdfVoxel> voxels_;
};

/// Fusion of depth frames (spec of the contour planner, section 3).
struct FusionConfig {
  double truncation_m = 0.03;      ///< metres, at least 2.1 voxels
  int max_weight = 128;            ///< observations at which the weight saturates, 1..60000
  int observations_per_frame = 1;  ///< what one frame counts for, 1..max_weight; 10 for replayed stops

  /// \throws std::invalid_argument naming field, value and range.
  void validate(double voxel_size_m) const;
};

struct FusionResult {
  BrickSet changed;                  ///< bricks in which a value or weight changed
  std::uint64_t voxels_updated = 0;  ///< voxels observed by this frame
};

/// Fuses one depth frame. A voxel centre is projected into the image (nearest pixel), D is the measured range
/// along that pixel's ray; sdf = D - |voxel - camera|. Invalid pixels update nothing (D-B29); sdf <
/// -truncation is skipped; else the running mean of min(1, sdf / truncation) is updated. Measurements outside
/// the camera's range limits (depth along z) are invalid. Deterministic for any number of threads. \throws
/// std::invalid_argument if the image is not of the camera's size.
FusionResult fuseDepth(TsdfVolume& volume, const DepthImage& depth, const PinholeCamera& camera,
                       const Pose& T_world_camera, const FusionConfig& config);

/// Plain one-voxel-at-a-time version of fuseDepth(), the reference for its tests and benchmarks.
FusionResult fuseDepthReference(TsdfVolume& volume, const DepthImage& depth, const PinholeCamera& camera,
                                const Pose& T_world_camera, const FusionConfig& config);

/// Marks every voxel whose centre lies within `radius_m` of a point as seen empty, weight 10 (D-B28): the
/// start bubble of the sensor, without which every pose is in collision. Voxels already observed keep their
/// state.
BrickSet clearSphere(TsdfVolume& volume, const Eigen::Vector3d& center_world, double radius_m);

}  // namespace vantage
