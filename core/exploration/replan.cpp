#include "core/exploration/replan.h"

#include <utility>

#include "core/exploration/plan_view.h"
#include "core/planners/rank_again.h"
#include "core/planners/search_again.h"

namespace vantage {
namespace {

MotionPlan onlyVerdict(Reachability verdict) {
  MotionPlan plan;
  plan.verdict = verdict;
  return plan;
}

/// False for a replay in which no frame is left near the view.
bool isServed(const StepReach& reach, const Pose& pose) {
  return !reach.left || reach.exploration.serves(*reach.left, pose);
}

}  // namespace

StageSet stagesToRedo(const ContourPlannerConfig& have, const ContourPlannerConfig& want) {
  StageSet stages;
  const bool segments = want.segment_by_segment;
  const bool other_planner = segments != have.segment_by_segment;
  if (!(have.contours == want.contours)) stages.add(Stage::Contours);
  if (have.contours.weight_threshold != want.contours.weight_threshold) stages.add(Stage::Surface);
  if (segments && (other_planner || !(have.segmentation == want.segmentation)))
    stages.add(Stage::Segmentation);
  if (segments && have.saliency.max_distance_m != want.saliency.max_distance_m) stages.add(Stage::Saliency);
  if (other_planner || !(have.views == want.views)) stages.add(Stage::Generation);
  if (!canSearchAgain(have.gain, want.gain, segments)) stages.add(Stage::Evaluation);
  return stages.withDependents();
}

StageSet stagesToRedo(const HierarchicalPlannerConfig& have, const HierarchicalPlannerConfig& want) {
  StageSet stages;
  if (have.generator != want.generator || have.icosphere_subdivisions != want.icosphere_subdivisions ||
      have.sphere_radius_m != want.sphere_radius_m || have.workspace_views != want.workspace_views)
    stages.add(Stage::Generation);
  if (!canRankAgain(have, want)) stages.add(Stage::Evaluation);
  return stages;
}

std::optional<Stage> firstStageToRedo(const ContourPlannerConfig& have, const ContourPlannerConfig& want) {
  return stagesToRedo(have, want).first();
}

std::optional<Stage> firstStageToRedo(const HierarchicalPlannerConfig& have,
                                      const HierarchicalPlannerConfig& want) {
  return stagesToRedo(have, want).first();
}

ReachPose stepReach(StepReach reach, MotionPlan& reported) {
  return [reach = std::move(reach), &reported, tried = std::uint64_t{0}](const Pose& pose) mutable {
    if (!isServed(reach, pose)) return onlyVerdict(Reachability::NoFrame);
    const ExplorationConfig& config = reach.exploration;
    MotionPlan plan;
    if (reach.start)
      plan = reach.planner.plan(*reach.start, pose, pathSeed(config.seed, reach.step, tried++));
    else
      plan.verdict = reach.planner.check(pose);
    return judged(std::move(plan), config.enforce_reachability, reported);
  };
}

PositionVerdicts::PositionVerdicts(const StepRecord& record, int rolls) {
  if (record.search && record.positions)
    for (const SegmentSearch& group : record.search->segments)
      for (const PoseScore& score : group.scores)
        if (const std::uint32_t n = score.id / static_cast<std::uint32_t>(rolls);
            n < record.positions->size())
          add((*record.positions)[n].T_world_camera.translation(), score.reachability);
  if (record.utilities)
    for (const ViewUtility& view : record.utilities->views)
      add(view.T_world_camera.translation(), view.reachability);
}

void PositionVerdicts::add(const Eigen::Vector3d& p, Reachability verdict) {
  const bool of_position = verdict != Reachability::NotChecked && verdict != Reachability::TimedOut &&
                           verdict != Reachability::NoFrame;
  if (of_position) verdicts_[{p.x(), p.y(), p.z()}] = verdict;
}

std::optional<Reachability> PositionVerdicts::of(const Eigen::Vector3d& p) const {
  const auto found = verdicts_.find({p.x(), p.y(), p.z()});
  return found == verdicts_.end() ? std::nullopt : std::optional(found->second);
}

ReachPose quickReach(StepReach reach, PositionVerdicts known) {
  return [reach = std::move(reach), known = std::move(known)](const Pose& pose) {
    if (!isServed(reach, pose)) return onlyVerdict(Reachability::NoFrame);
    const std::optional<Reachability> recorded = known.of(pose.translation());
    MotionPlan ignored;
    return judged(onlyVerdict(recorded ? *recorded : reach.planner.check(pose)),
                  reach.exploration.enforce_reachability, ignored);
  };
}

}  // namespace vantage
