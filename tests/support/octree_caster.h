#pragma once

#include <memory>

#include "core/raycasting/hierarchical_caster.h"
#include "core/volume/occupancy_octree.h"

namespace vantage::testing {

/// Hierarchical ray tracing (Algorithm 2) over an octomap::OcTree, as OctoMap itself reads it from the map's
/// `.ot` stream: labels of nodes come from OctoMap's search for each of their voxels and from the rules as
/// the specification states them. No state grid, no free radius, no lists; the reference for
/// castHierarchical() over a pyramid of the same map, all counts. Does the same single-precision steps along
/// a ray. Casts may run at the same time.
class OctreeCaster {
 public:
  explicit OctreeCaster(const OccupancyOctree& map);
  ~OctreeCaster();
  RayCounts cast(const RayTree& tree, int coarse_levels, const Pose& T_world_camera,
                 const HierarchicalQuery& query) const;

 private:
  class Labels;
  class Tracer;
  std::unique_ptr<Labels> labels_;
};

}  // namespace vantage::testing
