#pragma once

#include "core/raycasting/hierarchical_caster.h"

namespace vantage::testing {

/// Hierarchical ray tracing (Algorithm 2) over the octree itself: every node that a ray visits is looked up
/// in the tree. No state grid, no free radius, no lists; the reference for castHierarchical() over a pyramid
/// of the same map, all counts. Does the same single-precision steps along a ray.
RayCounts castThroughOctree(const OccupancyOctree& map, const RayTree& tree, int coarse_levels,
                            const Pose& T_world_camera, const HierarchicalQuery& query);

}  // namespace vantage::testing
