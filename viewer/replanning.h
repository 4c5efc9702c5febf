#pragma once

#include <memory>
#include <optional>

#include "core/exploration/plan_view.h"
#include "core/exploration/planner_kind.h"
#include "core/exploration/replan.h"
#include "core/planners/search_again.h"
#include "io/config_file.h"
#include "viewer/step_data.h"

namespace vantage {

/// What trying parameters on a recorded step needs beside its record. Immutable, shared between threads.
struct WhatIfContext {
  Settings settings;                      ///< of the run
  Exclusions exclusions;                  ///< what its earlier steps left out
  std::shared_ptr<MotionPlanner> motion;  ///< has seen the step's map
  RobotState start;                       ///< before it moves to the view
  PositionVerdicts verdicts;              ///< what the step found out about positions
  PlannerKind planner = PlannerKind::Contour;
};

/// \throws InputError if the run's configuration cannot be read, std::invalid_argument if a collision cell is
/// smaller than a voxel.
std::shared_ptr<const WhatIfContext> makeWhatIfContext(const StepData& data, Exclusions exclusions);

/// Planner of a recorded step.
PlannerKind plannerOfStep(const StepData& data);

/// Settings of the step's own planner.
ContourPlannerConfig contourConfigOf(const Settings& settings, PlannerKind planner);
HierarchicalPlannerConfig hierarchicalConfigOf(const Settings& settings, PlannerKind planner);

/// Products of a step's planning stages and the settings that they were made with.
struct PlannedStep {
  StepData data;
  Settings settings;
};

/// Stages that other settings need to be done again; empty: ranking again is enough.
StageSet stagesToRedo(const PlannedStep& have, const Settings& want, PlannerKind planner);

/// Does them. \throws Cancelled; std::invalid_argument for settings out of range
PlannedStep replan(const PlannedStep& base, const WhatIfContext& context, const Settings& wanted,
                   const RunControl& control);

/// How it is decided whether a view can be taken.
enum class ReachCheck {
  Quick,  ///< the sensor fits there; what the step asked for is taken over
  Full,   ///< a path is planned, as the run would
};

/// A step as it would be decided under other settings.
struct Reranked {
  StepData data;
  /// Index of a group of contour points that must be scored before anything can be said; no view is chosen
  /// then.
  std::optional<std::uint32_t> pending;
};

/// Ranks the step's views again without casting a ray. \param groups of the step; null for planners on the
/// octree. With ReachCheck::Full the chosen view's gain_voxels are counted too.
/// \pre stagesToRedo() is empty \throws Cancelled
Reranked rerank(const PlannedStep& base, const ScoredGroups* groups, const WhatIfContext& context,
                const Settings& wanted, ReachCheck check, const RunControl& control = {});

/// Scores a group of the step that was not needed so far. \throws Cancelled
std::shared_ptr<const ScoredGroup> scoreGroupOf(const PlannedStep& base, const ScoredGroups& groups,
                                                const WhatIfContext& context, const SegmentSearch& group,
                                                const RunControl& control);

/// The data with the scores of every group that is scored by now, for tables; decision and counts stay.
StepData withAllScores(const StepData& data, const PlannedStep& base, const ScoredGroups& groups,
                       const WhatIfContext& context, const Settings& wanted);

}  // namespace vantage
