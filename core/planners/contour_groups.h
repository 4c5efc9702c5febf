#pragma once

#include <vector>

#include "core/planners/contour_planner.h"

namespace vantage {

/// The groups that the search tries one after the other, not scored yet: one per segment with contour points,
/// by decreasing saliency (lines 6 and 8), then the points without a segment (D-B13); for the baseline a
/// single one. Disappointing points are left out (D-B33). Empty if no contour points remain.
std::vector<SegmentSearch> contourGroups(const ViewSearchInput& input, const ContourPlannerConfig& config);

/// Bounding sphere of a group without the margin: that of its segment (D-B19), or of its contour points about
/// the centre of their box if it has none (D-B13). \pre not the baseline
Sphere boundingSphere(const ViewSearchInput& input, const SegmentSearch& search);

/// The region in which a group's unknown counts (D-B9, D-B16).
VisibilityQuery regionQuery(const ViewSearchInput& input, const ContourPlannerConfig& config,
                            const SegmentSearch& search);

/// Marks the poses near one that was executed (D-B15). \pre the rolls of a position follow each other
void markExecuted(const ViewSearchInput& input, const ContourPlannerConfig& config,
                  std::vector<PoseScore>& scores);

/// Orders scores by decreasing gain, ties to the lowest id. \pre they ascend by id, and their gains are what
/// they count times one factor
void rankByGain(std::vector<PoseScore>& scores);

/// Positions of a group's poses, ascending; indices into input.positions.
std::vector<std::uint32_t> positionsOf(const ViewSearchInput& input, const SegmentSearch& search);

}  // namespace vantage
