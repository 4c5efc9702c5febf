#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/pose.h"
#include "core/raycasting/ray_tree.h"
#include "core/raycasting/uniform_caster.h"
#include "core/volume/state_pyramid.h"

namespace vantage {

/// Where the rays of a refined ray begin (D-A11).
enum class ChildStart : std::uint8_t {
  Resume,  ///< at max(0, t_hit(parent) - l_parent)
  Restart  ///< at the sensor
};

/// Which hits count and how rays are refined.
struct HierarchicalQuery {
  std::optional<Box> bounds;     ///< the object's box; finest voxels are in it by their centre, nodes if they
                                 ///< intersect it (D-A8). Empty = everything counts
  std::optional<Sphere> sphere;  ///< only voxels and nodes whose centre lies inside count
  ChildStart start = ChildStart::Resume;
  bool refine_unknown = false;   ///< unknown nodes are refined like occupied ones (D-A4)
  bool distinct_voxels = false;  ///< also count each voxel hit at the finest level once
};

/// Ray or voxel work and hits of one view.
struct RayCounts {
  std::uint64_t unknown = 0;        ///< finest rays below rays that end on unknown inside the box (lf)
  std::uint64_t occupied = 0;       ///< finest rays that end on occupied inside the box
  std::uint64_t unknown_scene = 0;  ///< finest rays below rays that end on unknown outside it (D-A9)
  std::uint64_t rays = 0;           ///< rays of the whole bundle at the finest level
  std::uint64_t rays_cast = 0;      ///< rays cast at all levels
  std::uint64_t finest_rays_cast = 0;
  std::uint64_t visited = 0;          ///< nodes that a plain walk of the rays cast visits, the hits included
  std::uint64_t unknown_voxels = 0;   ///< distinct voxels, if asked for
  std::uint64_t occupied_voxels = 0;  ///< distinct voxels, if asked for
  bool sensor_blocked =
      false;  ///< the sensor's own finest voxel is not free: invalid view, counts are 0 (D-A12)
  bool operator==(const RayCounts&) const = default;
};

/// What became of a ray, for pictures.
enum class RayFate : std::uint8_t {
  Missed,          ///< out of range or out of the map
  Outside,         ///< ended outside the box
  OutsideUnknown,  ///< the same, on unknown (D-A9)
  TooNear,         ///< ended before the minimum range (D-A22), a coarse one outside the box
  Refined,         ///< its children were cast
  Unknown,         ///< counted as unknown
  Occupied,        ///< counted as occupied
};

/// One cast ray.
struct TracedRay {
  std::uint8_t level = 0;  ///< 0 = finest
  RayFate fate = RayFate::Missed;
  std::uint32_t ray = 0;                           ///< RayLevel::index()
  float start_m = 0.0f;                            ///< along the ray
  float end_m = 0.0f;                              ///< entry into the node it ended on, else its length
  Eigen::Vector3i node = Eigen::Vector3i::Zero();  ///< in StatePyramid::level(level); -1 if it hit nothing
};

/// Hierarchical ray tracing (Algorithm 2, Vasquez-Gomez et al. 2013) of one view; `coarse_levels` 0 casts all
/// finest rays. Levels are cast one after the other, which changes no count. A hit in the node that holds the
/// sensor is refined (D-A12), and so is one in a node of the box that begins nearer than the minimum range
/// and may reach beyond it (D-A22). A ray that passes coarse nodes is lost with all below it (D-A13), one
/// that ends on a coarse unknown node counts for all of them (D-A14). \pre the pyramid and the tree have at
/// least `coarse_levels` levels and the same voxel size. \throws std::invalid_argument otherwise.
RayCounts castHierarchical(const StatePyramid& pyramid, const RayTree& tree, int coarse_levels,
                           const Pose& T_world_camera, const HierarchicalQuery& query);

/// The same, and every ray in the order in which it was cast.
RayCounts traceHierarchical(const StatePyramid& pyramid, const RayTree& tree, int coarse_levels,
                            const Pose& T_world_camera, const HierarchicalQuery& query,
                            std::vector<TracedRay>& rays);

/// Uniform ray tracing: every finest ray from the sensor to its first voxel, by the kernels of castUniform().
/// Equals castHierarchical() with coarse_levels 0.
RayCounts castUniformRays(const StateGrid& grid, const RayTree& tree, const Pose& T_world_camera,
                          const HierarchicalQuery& query);

/// castHierarchical() by the plain walk, one ray after the other as Algorithm 2 is written: the reference of
/// tests and benchmarks.
RayCounts castHierarchicalReference(const StatePyramid& pyramid, const RayTree& tree, int coarse_levels,
                                    const Pose& T_world_camera, const HierarchicalQuery& query);

}  // namespace vantage
