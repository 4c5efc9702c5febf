#pragma once

#include <cstdint>
#include <vector>

#include "core/volume/tsdf_fusion_kernel.h"
#include "core/volume/tsdf_volume.h"

namespace vantage::fusion {

/// Smallest and largest measured range in square tiles of an image, of 8 pixels and of every power of two
/// above. Pixels without a measurement count as kNoRange in both.
class RangeTiles {
 public:
  RangeTiles(const std::vector<float>& range_m, int width, int height);

  struct Limits {
    float low, high;
  };
  /// Limits over the inclusive pixel rectangle or a few pixels more; it must lie in the image.
  Limits over(int u0, int v0, int u1, int v1) const;

 private:
  struct Level {
    int width, height;
    std::vector<Limits> tiles;
  };
  std::vector<Level> levels_;
};

/// What a frame can do to a brick.
enum class Sight : std::uint8_t {
  Hidden,  ///< nothing: outside the image, or deeper than the truncation behind everything measured
  Empty,   ///< all of it is projected to measurements farther than the truncation behind it
  Mixed,   ///< neither is certain
};

/// A frame made ready: ranges along the rays, and the affine maps of voxel rows.
class PreparedFrame {
 public:
  /// \throws std::invalid_argument as fuseDepth()
  PreparedFrame(const TsdfVolume& volume, const DepthImage& depth, const PinholeCamera& camera,
                const Pose& T_world_camera, const FusionConfig& config);
  PreparedFrame(const PreparedFrame&) = delete;
  PreparedFrame& operator=(const PreparedFrame&) = delete;

  const Frame& frame() const { return frame_; }
  Row row(int y, int z) const;
  /// Sight of the bricks of a row of bricks with the voxels y in [y0, y1) and z in [z0, z1).
  void lookAt(int y0, int y1, int z0, int z1, int voxels_x, std::vector<Sight>& sights) const;
  /// Needed before lookAt().
  void buildTiles() { tiles_.emplace_back(range_m_, camera_.width, camera_.height); }

 private:
  struct Footprint;
  struct Edges;
  void measureRanges(const DepthImage& depth);
  Footprint column(int x, const Edges& edges) const;
  Sight sight(const Footprint& f, double nearest_m, double farthest_m) const;

  PinholeCamera camera_;
  double truncation_m_;
  double voxel_m_;
  std::vector<float> range_m_;
  std::vector<RangeTiles> tiles_;  ///< none or one
  Frame frame_;
  Eigen::Vector3d corner_;       ///< voxel (0,0,0) in the camera frame, metres
  Eigen::Matrix3d axes_;         ///< steps of one voxel along x, y, z in the camera frame, metres
  Eigen::Vector3d camera_grid_;  ///< camera in continuous voxel coordinates
};

}  // namespace vantage::fusion
