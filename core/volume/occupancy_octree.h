#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>

#include "core/geometry/camera_model.h"
#include "core/geometry/depth_image.h"
#include "core/geometry/grid_geometry.h"
#include "core/geometry/pose.h"
#include "core/volume/bricks.h"
#include "core/volume/voxel_state.h"

namespace vantage {

/// What an inner node stands for (D-A5): with Max it is free if all of it is, occupied if anything in it is,
/// else unknown; with Mean it has the label of the mean probability of its voxels, those not stored at 0.5.
enum class InnerRule : std::uint8_t { Max, Mean };

/// Sensor model and labels of the probabilistic map (section 8 of the hierarchical specification).
struct OccupancyConfig {
  double hit_probability = 0.7;   ///< of a voxel in which a measurement ends, (0.5, 1)
  double miss_probability = 0.4;  ///< of a voxel that a ray passes, (0, 0.5)
  double clamp_min = 0.1192;      ///< probabilities stay in [clamp_min, clamp_max], (0, 0.5)
  double clamp_max = 0.971;       ///< (0.5, 1)
  double unknown_low = 0.48;      ///< unknown band [unknown_low, unknown_high) (D-A7); below it free
  double unknown_high = 0.52;     ///< from here on occupied
  double insert_range_m = 2.8;    ///< measurements beyond clear the way up to here and mark nothing, metres
  InnerRule inner = InnerRule::Max;
  bool operator==(const OccupancyConfig&) const = default;
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// Label of a log-odds value (D-A7).
VoxelState occupancyLabel(double log_odds, const OccupancyConfig& config);
/// 1 / (1 + exp(-L)).
double probabilityOf(double log_odds);
/// ln(p / (1 - p)); minus and plus infinity at 0 and 1, NaN outside [0, 1].
double logOddsOf(double probability);

/// occupancyLabel() prepared for many values.
struct OccupancyBand {
  float free_below = 0.0f;     ///< log-odds
  float occupied_from = 0.0f;  ///< log-odds
  OccupancyBand() = default;
  explicit OccupancyBand(const OccupancyConfig& config);
  VoxelState label(float log_odds) const {
    if (log_odds >= occupied_from) return VoxelState::Occupied;
    return log_odds < free_below ? VoxelState::Free : VoxelState::Unknown;  // NaN, not stored: unknown
  }
};

/// What one scan changed.
struct OccupancyUpdate {
  BrickSet changed;           ///< bricks in which a value changed
  std::uint64_t hits = 0;     ///< voxels in which measurements ended
  std::uint64_t misses = 0;   ///< other voxels that rays passed
  std::uint64_t updated = 0;  ///< voxels whose value changed
};

/// Probabilistic occupancy map: an OctoMap tree cut to a grid of finest voxels. A voxel that is not stored is
/// unknown. The grid's lower corner lies on a multiple of the voxel size.
class OccupancyOctree {
 public:
  /// Finest voxels that cover `box`, rounded outward to multiples of the voxel size.
  static GridGeometry gridAround(const Box& box, double voxel_size_m);

  OccupancyOctree();
  /// Every voxel inside the object's box (its centre is) is unknown, p = 0.5; the others are `outside`:
  /// Unknown (not stored) or Free (at clamp_min) (D-A10).
  /// \throws std::invalid_argument for a geometry whose corner is no multiple of the voxel size, whose size
  /// is below 1, which reaches beyond OctoMap's 2^16 voxels per axis, or a config out of range.
  OccupancyOctree(const GridGeometry& geometry, const Box& object_box, VoxelState outside,
                  const OccupancyConfig& config);
  ~OccupancyOctree();
  OccupancyOctree(OccupancyOctree&&) noexcept;
  OccupancyOctree& operator=(OccupancyOctree&&) noexcept;

  /// Another grid and object's box for the same tree; what lies outside the grid is forgotten. \throws as the
  /// constructor, and std::invalid_argument for another voxel size.
  void recut(const GridGeometry& geometry, const Box& object_box);

  const GridGeometry& geometry() const;
  const BrickLayout& bricks() const;
  const Box& objectBox() const;
  const OccupancyConfig& config() const;
  static constexpr int kDepth = 16;  ///< of the finest voxels; 0 is the root (D-A20)

  /// Log-odds of a finest voxel; empty if it is not stored.
  std::optional<float> logOdds(const Eigen::Vector3i& voxel) const;
  /// Label from the tree itself, node by node: the slow answer that StatePyramid must equal. `voxel` is any
  /// finest voxel in the node, `level` counts coarse levels upward from 0 = finest. Only voxels of the grid
  /// count.
  VoxelState label(const Eigen::Vector3i& voxel, int level) const;
  /// Log-odds of a brick, x fastest within its range; NaN where nothing is stored. Descends once per brick.
  /// \throws std::invalid_argument if there is room for another number of voxels.
  void readBrick(std::uint32_t brick, std::span<float> log_odds) const;
  /// Replaces a brick; NaN removes. \throws std::invalid_argument if the number of voxels differs.
  void setBrick(std::uint32_t brick, std::span<const float> log_odds);
  /// Replaces a finest voxel; NaN removes. \throws std::invalid_argument outside the grid.
  void set(const Eigen::Vector3i& voxel, float log_odds);

  /// Fuses one depth image: each measurement is a ray from the camera; per voxel and image one hit or one
  /// miss, a hit wins. Invalid pixels mark nothing. Deterministic for any number of threads. \throws
  /// std::invalid_argument if the image is not of the camera's size.
  OccupancyUpdate insert(const DepthImage& depth, const PinholeCamera& camera, const Pose& T_world_camera);
  /// Marks voxels as free whose centre lies within `radius_m` of a point and which are unknown: where the
  /// sensor is, there is nothing.
  BrickSet clearSphere(const Eigen::Vector3d& center_world, double radius_m);

  std::size_t nodeCount() const;
  std::size_t memoryBytes() const;

  /// OctoMap's own formats: `.ot` holds probabilities, `.bt` labels alone (unknown voxels are left out).
  enum class Format { Ot, Bt };
  void write(std::ostream& out, Format format) const;
  /// Reads a stream of either format. The grid covers the stored voxels and one more on each side, cut or
  /// extended to `bounds` if given; the object's box is `bounds`, else everything.
  /// \throws std::runtime_error saying what is wrong: another tree type, resolution not positive, truncated,
  /// deeper than 16 levels, empty without bounds, does not fit in memory.
  static OccupancyOctree read(std::istream& in, const std::optional<Box>& bounds,
                              const OccupancyConfig& config);

 private:
  struct Data;
  class Scan;
  std::unique_ptr<Data> data_;
};

}  // namespace vantage
