#pragma once

#include <span>

#include "core/planners/hierarchical_planner.h"

namespace vantage {

/// True if a pose is near one that was taken, and such are left out.
bool takenBefore(const Pose& pose, std::span<const Pose> executed, const HierarchicalPlannerConfig& config);

/// The part of the cascade that needs no rays: reg -> sur * dist (eq. 1-5), from `unknown` and `occupied`.
/// \param box_unknown un_o
void judgeView(ViewUtility& view, const HierarchicalPlannerConfig& config, const Pose& current,
               std::uint64_t box_unknown);

/// Ranking, counts and step 5 of Algorithm 1 for views that the cascade has judged, given in `search.views`;
/// box_unknown and box_occupied are kept. `chosen->gain_voxels` is left 0. \throws Cancelled
void selectUtility(UtilitySearch& search, const HierarchicalPlannerConfig& config, const ReachPose& reach,
                   const RunControl& control);

}  // namespace vantage
