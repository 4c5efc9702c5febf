// Why a view was chosen or not, in a sentence or two.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "viewer/captions.h"
#include "viewer/explanation_parts.h"
#include "viewer/view_words.h"

namespace vantage {
namespace {

std::string named(const CandidateRow& row) {
  return "view " + std::to_string(row.id);
}

std::string unreachableText(const CandidateRow& row) {
  return "Rejected: it is good enough, but the robot cannot take it: " +
         std::string(toString(row.reachability)) + ".";
}

std::string takenText(double distance_m, double angle_rad) {
  return "Left out: it is within " + lengthText(distance_m) + " and " +
         rounded(angle_rad * 180.0 / std::numbers::pi, 3) + "° of a view that was taken before.";
}

// Contour planner and its baseline.

std::string segmentOf(const ExplainedView& view, std::uint32_t group) {
  return searchName(view.frame.record, group);
}

std::string pendingReason(const ExplainedView& view) {
  const std::string segment = "its segment, " + segmentOf(view, *view.group) + ",";
  const auto& groups = view.frame.record.search->segments;
  if (groups[*view.group].scored) return "Left out: it is not among the views that were scored.";
  if (view.chosen && view.chosen->group < *view.group)
    return "Not scored: " + segment + " comes after " + segmentOf(view, view.chosen->group) +
           " of the chosen " + named(*view.chosen) + ".";
  return "Undecided: " + segment + " is not scored yet.";
}

/// "35 248 rays"
std::string gained(const ExplainedView& view, const CandidateRow& row) {
  return whole(row.score) + " " + countUnit(view.frame);
}

std::string contourChosen(const ExplainedView& view) {
  const CandidateRow& row = *view.row;
  const ViewSearch& search = *view.frame.record.search;
  const std::string gain =
      "of its views that the robot can take this one gains most, " + gained(view, row) + ".";
  std::string text =
      plannerOf(view.frame) == "standard"
          ? "Chosen: of all views that the robot can take it gains most, " + gained(view, row) + "."
      : row.group == 0
          ? "Chosen: its segment, " + segmentOf(view, row.group) + ", is the most salient one; " + gain
          : "Chosen: its segment, " + segmentOf(view, row.group) + ", is tried after " +
                plural(row.group, "more salient one") + " without a view; " + gain;
  const std::string refused =
      refusals(search.segments[row.group], view.frame.header.contour_config.gain.gain_threshold);
  return refused.empty() ? text : text + " Better ones were skipped: " + refused + ".";
}

std::string sameSegmentReason(const ExplainedView& view) {
  const CandidateRow &row = *view.row, &chosen = *view.chosen;
  const std::string start = "Not chosen: the chosen " + named(chosen) + " of the same segment ";
  if (chosen.score == row.score)
    return start + "gains as much, " + gained(view, row) + "; of equal ones the lower number comes first.";
  return start + "gains more, " + gained(view, chosen) + " against " + whole(row.score) + ".";
}

std::string laterSegmentReason(const ExplainedView& view) {
  const CandidateRow &row = *view.row, &chosen = *view.chosen;
  std::string text = "Not chosen: its segment, " + segmentOf(view, row.group) + ", comes after " +
                     segmentOf(view, chosen.group) + " of the chosen " + named(chosen);
  if (row.score > chosen.score)
    text += ", though it would gain more, " + gained(view, row) + " against " + whole(chosen.score);
  return text + ".";
}

// Hierarchical planner.

std::string utilityChosen(const ExplainedView& view) {
  const CandidateRow& row = *view.row;
  std::string text =
      "Chosen: of the views that passed all tests and that the robot can take it has the highest "
      "utility, " +
      rounded(row.score, 3) + ".";
  if (const std::uint64_t better = view.frame.record.utilities->counts.poses_unreachable; better > 0)
    text += " " + plural(better, "better one") + " cannot be reached.";
  return text;
}

std::string lowerUtilityReason(const ExplainedView& view) {
  const CandidateRow& row = *view.row;
  if (!view.chosen)
    return "Not chosen: none of the views can be reached, or their paths are not planned yet.";
  const CandidateRow& chosen = *view.chosen;
  const std::string start = "Not chosen: the chosen " + named(chosen);
  if (row.score == chosen.score)
    return start + " has the same utility, " + rounded(row.score, 3) +
           "; of equal ones the first comes first.";
  std::string text =
      start + " has the higher utility, " + rounded(chosen.score, 3) + " against " + rounded(row.score, 3);
  const bool sees_more = chosen.surface > row.surface,
             is_nearer = chosen.distance_factor > row.distance_factor;
  if (sees_more && is_nearer) return text + ": it sees more unknown and is nearer.";
  return text + (sees_more ? ": it sees more unknown, though it is not nearer."
                           : ": it is nearer, though it does not see more unknown.");
}

std::string registrationReason(const ExplainedView& view, const HierarchicalPlannerConfig& config) {
  const std::string seen = "Rejected: it sees " + whole(view.row->occupied) + " " + countUnit(view.frame) +
                           " on known surface, too few to register the scan: ";
  if (config.min_overlap <= 0.0)
    return seen + "at least " + whole(config.min_occupied) + " are asked for (h_oc).";
  return seen + "at least " + fixed(config.min_overlap) + " of all that it sees is asked for.";
}

}  // namespace

std::string contourReason(const ExplainedView& view) {
  const GainConfig& config = view.frame.header.contour_config.gain;
  if (!view.row) return pendingReason(view);
  const CandidateRow& row = *view.row;
  switch (row.verdict) {
    case ViewVerdict::Chosen:
      return contourChosen(view);
    case ViewVerdict::Eligible:
      return view.chosen ? sameSegmentReason(view)
                         : "Not chosen yet: it is good enough, but no path was planned so far.";
    case ViewVerdict::LaterSegment:
      return laterSegmentReason(view);
    case ViewVerdict::Unreachable:
      return unreachableText(row);
    case ViewVerdict::TakenBefore:
      return takenText(config.executed_distance_m, config.executed_angle_rad);
    case ViewVerdict::Waiting:
      return "Undecided: it gains " + gained(view, row) +
             ", above the threshold, but a segment that comes before its own is not scored yet.";
    default:
      return "Rejected: it gains " + gained(view, row) + ", the threshold is " +
             whole(config.gain_threshold) + ".";
  }
}

std::string utilityReason(const ExplainedView& view) {
  const auto& octree = view.frame.header.octree;
  const HierarchicalPlannerConfig config = octree ? octree->planner : HierarchicalPlannerConfig();
  const std::string unit = countUnit(view.frame);
  const CandidateRow& row = *view.row;
  switch (row.verdict) {
    case ViewVerdict::Chosen:
      return utilityChosen(view);
    case ViewVerdict::Unreachable:
      return unreachableText(row);
    case ViewVerdict::TakenBefore:
      return takenText(config.executed_distance_m, config.executed_angle_rad);
    case ViewVerdict::NotFree:
      return "Rejected: the position is not free: the robot's cube of " + lengthText(config.body_m) +
             " touches something occupied or unknown there, or the sensor itself would stand in an occupied "
             "voxel.";
    case ViewVerdict::LittleSurface:
      return registrationReason(view, config);
    case ViewVerdict::Stopped:
      return "Not chosen: the planner stopped, since no view sees " + whole(config.stop_gain) + " unknown " +
             unit + " (h_stop); the best sees " + whole(view.frame.record.utilities->best_unknown) + ".";
    case ViewVerdict::BelowThreshold:
      return "Rejected: it sees nothing unknown, its utility is 0.";
    default:
      return lowerUtilityReason(view);
  }
}

}  // namespace vantage
