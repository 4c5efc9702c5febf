#pragma once

#include <span>

#include "core/planners/hierarchical_planner.h"

namespace vantage {

/// True if rankAgain() can answer for `wanted` from a search made with `recorded`: they differ at most in
/// min_occupied, min_overlap, stop_gain, the weight of rotations, and in that more views near executed ones
/// are left out. Views that the search itself left out were never cast, so fewer cannot be.
bool canRankAgain(const HierarchicalPlannerConfig& recorded, const HierarchicalPlannerConfig& wanted);

/// What searchUtility() would return for `wanted`, from the rays of a recorded search: the cascade after the
/// rays, the ranking and the choice. The counts are those of the fresh search, though no ray is cast;
/// gain_voxels is 0 until the caller asks countVoxels().
/// \param current,executed as in the recorded search's UtilityInput
/// \pre canRankAgain() \throws std::invalid_argument for a config out of range; Cancelled
UtilitySearch rankAgain(const UtilitySearch& recorded, const HierarchicalPlannerConfig& wanted,
                        const Pose& current, std::span<const Pose> executed, const ReachPose& reach,
                        const RunControl& control = {});

}  // namespace vantage
