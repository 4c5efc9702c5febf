#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "core/planners/contour_planner.h"

namespace vantage {

/// Where a selection takes the scores of a group from: fills it as scoreSegment() does and adds the work to
/// the counts. False: nobody knows them yet, and the selection ends there.
using GroupScores = std::function<bool(SegmentSearch& group, SearchCounts& counts)>;

/// A search that may have met a group without scores.
struct ViewSelection {
  ViewSearch search;
  std::optional<std::uint32_t> pending;  ///< index into search.segments; nothing is chosen then
};

/// Lines 6-17 of Algorithm 1 whatever the scores come from: groups by decreasing saliency, their poses by
/// decreasing gain, the first one above the threshold that can be reached. `chosen->gain_voxels` is left 0.
/// \throws as searchView()
ViewSelection selectView(const ViewSearchInput& input, const ContourPlannerConfig& config,
                         const GroupScores& scores, const ReachPose& reach, const RunControl& control);

}  // namespace vantage
