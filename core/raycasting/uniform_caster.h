#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/pose.h"
#include "core/volume/state_grid.h"

namespace vantage {

/// Ball in world coordinates, metres.
struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

/// What becomes of unknown voxels outside the region of interest (D-B9).
enum class OutsideUnknown { Opaque, Transparent };

/// Which first hits count and how far rays go.
struct VisibilityQuery {
  std::optional<Sphere> sphere;  ///< only voxels whose centre lies inside count
  std::optional<Box> bounds;     ///< only voxels whose centre lies inside count
  OutsideUnknown outside = OutsideUnknown::Opaque;
  bool distinct_voxels = false;  ///< also count each first-hit voxel once
  /// Histogram of first-hit unknown rays by distance to the sphere's centre, filled if a sphere is given and
  /// bins > 0: bin 0 holds distances <= histogram_start_m, bin k those in
  /// (start + (k-1) width, start + k width]. The histogram does not obey the sphere's radius.
  int histogram_bins = 0;
  double histogram_start_m = 0.0;
  double histogram_width_m = 0.01;
};

/// First-hit counts of one ray bundle. Each pixel's ray stops at the first voxel that is occupied or unknown
/// (D-B7); a hit nearer than the minimum range counts nothing but still ends the ray; rays end at the maximum
/// range (ray length) and where they leave the grid, which is empty outside.
struct VisibilityCounts {
  std::uint64_t unknown = 0;          ///< rays that end on unknown inside the region
  std::uint64_t occupied = 0;         ///< rays that end on occupied inside the region
  std::uint64_t rays = 0;             ///< rays of the bundle
  std::uint64_t visited = 0;          ///< voxels a plain walk visits, the hit included
  std::uint64_t unknown_voxels = 0;   ///< distinct first-hit unknown voxels, if asked for
  std::uint64_t occupied_voxels = 0;  ///< distinct first-hit occupied voxels, if asked for
  std::vector<std::uint32_t> histogram;
  bool operator==(const VisibilityCounts&) const = default;
};

/// Casts one ray per pixel of `camera` from `T_world_camera`.
VisibilityCounts castUniform(const StateGrid& grid, const PinholeCamera& camera, const Pose& T_world_camera,
                             const VisibilityQuery& query);

/// The same by the plain voxel walk, without the free radius: the reference for tests and benchmarks.
VisibilityCounts castUniformReference(const StateGrid& grid, const PinholeCamera& camera,
                                      const Pose& T_world_camera, const VisibilityQuery& query);

/// Counts of the poses that share one position and axis and differ by rolls of 90 degrees.
struct QuarterTurnCounts {
  VisibilityCounts upright;     ///< rolls 0 and 180 deg relative to `T_world_camera`
  VisibilityCounts sideways;    ///< rolls 90 and 270 deg
  std::uint64_t rays_cast = 0;  ///< rays of the shared grid, less than the sum of both bundles
  std::uint64_t visited = 0;    ///< voxels a plain walk of those rays visits
};

/// True if rolls by 90 deg share one pixel grid: square pixels, centred principal point, and width and height
/// of equal parity (D-B11).
bool sharesQuarterTurnGrid(const PinholeCamera& camera);

/// One cast for the rolls 0/90/180/270 of a pose; counts equal those of castUniform() on the rolled poses.
/// \pre sharesQuarterTurnGrid(camera)
QuarterTurnCounts castQuarterTurns(const StateGrid& grid, const PinholeCamera& camera,
                                   const Pose& T_world_camera, const VisibilityQuery& query);

/// First non-free voxel along a ray, if any within `max_length_m`.
struct RayHit {
  Eigen::Vector3i voxel;
  double length_m = 0.0;  ///< from the origin to the entry into the voxel
  VoxelState state = VoxelState::Unknown;
};
std::optional<RayHit> castRay(const StateGrid& grid, const Eigen::Vector3d& origin_world,
                              const Eigen::Vector3d& direction_world, double max_length_m);

}  // namespace vantage
