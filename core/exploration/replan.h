#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/exploration/explorer.h"
#include "core/exploration/stage_set.h"

namespace vantage {

/// Stages whose products change from one configuration to the other, with their dependents; empty if ranking
/// again is enough (searchAgain(), rescoreSegments()). For planView().
StageSet stagesToRedo(const ContourPlannerConfig& have, const ContourPlannerConfig& want);
/// The same for planUtility() and rankAgain(). The caller makes pyramid and ray tree for `want`.
StageSet stagesToRedo(const HierarchicalPlannerConfig& have, const HierarchicalPlannerConfig& want);

/// The first of them; empty if ranking again is enough.
std::optional<Stage> firstStageToRedo(const ContourPlannerConfig& have, const ContourPlannerConfig& want);
std::optional<Stage> firstStageToRedo(const HierarchicalPlannerConfig& have,
                                      const HierarchicalPlannerConfig& want);

/// What decides whether a view of a recorded step can be taken when the robot itself is not there. What it
/// refers to must outlive the functions made from it.
struct StepReach {
  const MotionPlanner& planner;  ///< has seen the map that the step planned in
  const ExplorationConfig&
      exploration;  ///< seed, enforce_reachability, and how near frames must serve a view
  int step = 1;
  std::optional<RobotState> start;  ///< where the robot is; empty: it only has to fit, no path is asked for
  /// Replay in which views must be served: poses whose frames are left. Empty: no view needs a frame.
  std::optional<std::vector<ScanPose>> left;
};

/// The verdict that the step's exploration would give, path included. Where obstacles are only reported (see
/// judged()), the true plan of the last pose asked for is kept in `reported`, which must outlive the
/// function.
ReachPose stepReach(StepReach reach, MotionPlan& reported);

/// What a recorded step found out about positions of the sensor, whatever it looked at.
class PositionVerdicts {
 public:
  PositionVerdicts() = default;
  /// \param rolls views.rolls of the step
  PositionVerdicts(const StepRecord& record, int rolls);
  /// Empty if the step never asked, or only the wall clock or a missing frame answered.
  std::optional<Reachability> of(const Eigen::Vector3d& position_m) const;

 private:
  void add(const Eigen::Vector3d& position_m, Reachability verdict);
  std::map<std::array<double, 3>, Reachability> verdicts_;
};

/// A guess for use while a slider moves: no path is planned. Verdicts of the step are taken over, elsewhere
/// the sensor only has to fit; check the chosen view by stepReach() afterwards. Plans have no waypoints.
ReachPose quickReach(StepReach reach, PositionVerdicts known);

}  // namespace vantage
