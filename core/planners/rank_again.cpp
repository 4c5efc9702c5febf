#include "core/planners/rank_again.h"

#include "core/planners/utility_selection.h"

namespace vantage {
namespace {

/// Every view near an executed one under `a` is so under `b`.
bool leavesOutNoMore(const HierarchicalPlannerConfig& a, const HierarchicalPlannerConfig& b) {
  return !a.exclude_executed || (b.exclude_executed && a.executed_distance_m <= b.executed_distance_m &&
                                 a.executed_angle_rad <= b.executed_angle_rad);
}

/// A candidate of which nothing is known but its pose.
ViewUtility asCandidate(const ViewUtility& recorded, ViewRejection rejection) {
  ViewUtility view;
  view.id = recorded.id;
  view.frame = recorded.frame;
  view.T_world_camera = recorded.T_world_camera;
  view.rejection = rejection;
  return view;
}

ViewUtility judgedAgain(const ViewUtility& recorded, const HierarchicalPlannerConfig& wanted,
                        const Pose& current, std::span<const Pose> executed, std::uint64_t box_unknown) {
  if (recorded.rejection == ViewRejection::Executed || takenBefore(recorded.T_world_camera, executed, wanted))
    return asCandidate(recorded, ViewRejection::Executed);
  ViewUtility view = recorded;
  view.reachability = Reachability::NotChecked;
  if (recorded.rejection != ViewRejection::Position) judgeView(view, wanted, current, box_unknown);
  return view;
}

}  // namespace

bool canRankAgain(const HierarchicalPlannerConfig& recorded, const HierarchicalPlannerConfig& wanted) {
  HierarchicalPlannerConfig same = wanted;
  same.min_occupied = recorded.min_occupied;
  same.min_overlap = recorded.min_overlap;
  same.stop_gain = recorded.stop_gain;
  same.rotation_weight_m_per_rad = recorded.rotation_weight_m_per_rad;
  same.exclude_executed = recorded.exclude_executed;
  same.executed_distance_m = recorded.executed_distance_m;
  same.executed_angle_rad = recorded.executed_angle_rad;
  return same == recorded && leavesOutNoMore(recorded, wanted);
}

UtilitySearch rankAgain(const UtilitySearch& recorded, const HierarchicalPlannerConfig& wanted,
                        const Pose& current, std::span<const Pose> executed, const ReachPose& reach,
                        const RunControl& control) {
  wanted.validate();
  UtilitySearch search;
  search.box_unknown = recorded.box_unknown;
  search.box_occupied = recorded.box_occupied;
  search.views.reserve(recorded.views.size());
  for (const ViewUtility& view : recorded.views)
    search.views.push_back(judgedAgain(view, wanted, current, executed, search.box_unknown));
  selectUtility(search, wanted, reach, control);
  return search;
}

}  // namespace vantage
