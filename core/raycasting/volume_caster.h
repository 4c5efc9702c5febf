#pragma once

#include "core/raycasting/uniform_caster.h"

namespace vantage {

/// The ablation of D-B7 that looks through unknown space: each ray goes on until an occupied voxel, the
/// maximum range or the border of the grid ends it. Counts are
/// - `unknown_voxels`: distinct unknown voxels in the region that a ray enters beyond the minimum range,
/// - `unknown`: rays that enter at least one of them,
/// - `occupied`: rays that end on occupied inside the region, beyond the minimum range,
/// - `rays`, and `visited` voxels: rays are followed until they leave the ball of the region; the others stay
///   0.
/// `query.outside` and the histogram are of no account. One voxel at a time, 10 to 100 times slower than
/// castUniform().
VisibilityCounts castThroughUnknown(const StateGrid& grid, const PinholeCamera& camera,
                                    const Pose& T_world_camera, const VisibilityQuery& query);

}  // namespace vantage
