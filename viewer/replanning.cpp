#include "viewer/replanning.h"

#include <utility>

#include "core/perception/saliency.h"
#include "core/planners/rank_again.h"
#include "io/run_robot.h"

namespace vantage {
namespace {

/// The input of a search, with what it refers to. \pre base and context outlive it
struct SearchInput {
  Saliency saliency;
  ViewSearchInput input;

  SearchInput(const PlannedStep& base, const WhatIfContext& context, const ContourPlannerConfig& config)
      : saliency(rescored(*base.data.record, config)),
        input{.states = *base.data.states,
              .camera = base.data.header->camera,
              .workspace = base.data.header->workspace,
              .points = base.data.record->contours->points,
              .positions = *base.data.record->positions,
              .point_labels = *base.data.record->point_labels,
              .saliency = saliency,
              .executed = context.exclusions.executed,
              .disappointing = context.exclusions.disappointing} {}
  SearchInput(const SearchInput&) = delete;

 private:
  static Saliency rescored(const StepRecord& record, const ContourPlannerConfig& config) {
    if (!record.saliency || !config.segment_by_segment) return {};
    return {rescoreSegments(*record.saliency, *record.labels, config.saliency),
            record.saliency->distance_to_other_m};
  }
};

StepReach reachOf(const WhatIfContext& context, const StepRecord& record) {
  return {.planner = *context.motion,
          .exploration = context.settings.exploration,
          .step = record.step,
          .start = context.start,
          .left = std::nullopt};
}

ReachPose reachPose(const WhatIfContext& context, const StepRecord& record, ReachCheck check,
                    MotionPlan& reported) {
  if (check == ReachCheck::Full) return stepReach(reachOf(context, record), reported);
  return quickReach(reachOf(context, record), context.verdicts);
}

/// The header as a run with these settings would have it.
std::shared_ptr<const RunHeader> headerWith(const RunHeader& header, const Settings& wanted) {
  auto changed = std::make_shared<RunHeader>(header);
  changed->contour_config = wanted.exploration.contour;
  if (changed->octree) changed->octree->planner = wanted.exploration.hierarchical;
  return changed;
}

/// The same step under other settings; its record is made by `fill`.
template <class Fill>
StepData changedStep(const StepData& data, const Settings& wanted, Fill&& fill) {
  StepData changed = data;
  auto record = std::make_shared<StepRecord>(*data.record);
  fill(*record);
  changed.record = std::move(record);
  changed.header = headerWith(*data.header, wanted);
  return changed;
}

/// Where obstacles are only reported, the chosen view gets its true plan.
void reportTruth(StepRecord& record, const WhatIfContext& context, ReachCheck check,
                 const MotionPlan& reported) {
  if (check == ReachCheck::Full && !context.settings.exploration.enforce_reachability)
    reportMotion(record, reported);
}

Reranked rerankContour(const PlannedStep& base, const ScoredGroups& groups, const WhatIfContext& context,
                       const Settings& wanted, ReachCheck check, const RunControl& control) {
  const ContourPlannerConfig config = contourConfigOf(wanted, context.planner);
  const SearchInput search(base, context, config);
  MotionPlan reported;
  SearchAgain found = searchAgain(search.input, config, groups,
                                  reachPose(context, *base.data.record, check, reported), control);
  if (check == ReachCheck::Full && found.search.chosen)
    found.search.chosen->gain_voxels =
        countVoxels(search.input, config, found.search.segments[found.search.chosen->search],
                    found.search.chosen->T_world_camera);
  Reranked result;
  result.pending = found.pending;
  result.data = changedStep(base.data, wanted, [&](StepRecord& record) {
    if (config.segment_by_segment) record.saliency = std::make_shared<const Saliency>(search.saliency);
    record.search = std::make_shared<const ViewSearch>(std::move(found.search));
    reportTruth(record, context, check, reported);
  });
  return result;
}

Reranked rerankOctree(const PlannedStep& base, const WhatIfContext& context, const Settings& wanted,
                      ReachCheck check, const RunControl& control) {
  MotionPlan reported;
  UtilitySearch found = rankAgain(*base.data.record->utilities, hierarchicalConfigOf(wanted, context.planner),
                                  context.start.T_world_camera, context.exclusions.executed,
                                  reachPose(context, *base.data.record, check, reported), control);
  Reranked result;
  result.data = changedStep(base.data, wanted, [&](StepRecord& record) {
    record.utilities = std::make_shared<const UtilitySearch>(std::move(found));
    reportTruth(record, context, check, reported);
  });
  return result;
}

void replanContour(StepRecord& record, const PlannedStep& base, const WhatIfContext& context,
                   const Settings& wanted, const StageSet& stages, const RunControl& control) {
  const ContourPlannerConfig config = contourConfigOf(wanted, context.planner);
  const PlanViewInput input{.volume = *base.data.volume,
                            .states = *base.data.states,
                            .camera = base.data.header->camera,
                            .workspace = base.data.header->workspace,
                            .config = config,
                            .executed = context.exclusions.executed,
                            .disappointing = context.exclusions.disappointing};
  MotionPlan reported;
  planView(
      record, input, stepReach(reachOf(context, record), reported), [](Stage) {}, control, stages);
  reportTruth(record, context, ReachCheck::Full, reported);
}

void replanOctree(StepRecord& record, StepData& data, const WhatIfContext& context, const Settings& wanted,
                  const StageSet& stages, const RunControl& control) {
  const HierarchicalPlannerConfig config = hierarchicalConfigOf(wanted, context.planner);
  const OctreeHeader& octree = *data.header->octree;
  data.tree = std::make_shared<const RayTree>(config.sensor, octree.map.voxel_size_m, config.coarse_levels);
  const Box mapped = data.header->volume.bounds();
  const PlanUtilityInput input{.pyramid = *data.pyramid,
                               .tree = *data.tree,
                               .object_box = octree.object_box,
                               .workspace = mapped,
                               .current = context.start.T_world_camera,
                               .config = config,
                               .executed = context.exclusions.executed,
                               .seed = pathSeed(context.settings.exploration.seed, record.step, 0)};
  MotionPlan reported;
  planUtility(
      record, input, stepReach(reachOf(context, record), reported), [](Stage) {}, control, stages);
  reportTruth(record, context, ReachCheck::Full, reported);
}

}  // namespace

PlannerKind plannerOfStep(const StepData& data) {
  return plannerKindOf(*data.header, *data.record);
}

std::shared_ptr<const WhatIfContext> makeWhatIfContext(const StepData& data, Exclusions exclusions) {
  auto context = std::make_shared<WhatIfContext>();
  applyToml(context->settings, data.header->config_toml, "the run's configuration");
  context->planner = plannerOfStep(data);
  context->exclusions = std::move(exclusions);
  context->motion = motionPlannerOf(*data.header, context->settings);
  context->motion->observe(*data.states);
  const StepRecord& record = *data.record;
  context->start = stateAfterScan(record);
  if (!data.header->arm)  // an arm's verdicts hold for one orientation
    context->verdicts = PositionVerdicts(record, context->settings.exploration.contour.views.rolls);
  return context;
}

ContourPlannerConfig contourConfigOf(const Settings& settings, PlannerKind planner) {
  ContourPlannerConfig config = settings.exploration.contour;
  config.segment_by_segment = planner == PlannerKind::Contour;
  return config;
}

HierarchicalPlannerConfig hierarchicalConfigOf(const Settings& settings, PlannerKind planner) {
  HierarchicalPlannerConfig config = settings.exploration.hierarchical;
  if (planner == PlannerKind::Uniform) config.coarse_levels = 0;
  return config;
}

StageSet stagesToRedo(const PlannedStep& have, const Settings& want, PlannerKind planner) {
  if (usesOctree(planner))
    return stagesToRedo(hierarchicalConfigOf(have.settings, planner), hierarchicalConfigOf(want, planner));
  return stagesToRedo(contourConfigOf(have.settings, planner), contourConfigOf(want, planner));
}

PlannedStep replan(const PlannedStep& base, const WhatIfContext& context, const Settings& wanted,
                   const RunControl& control) {
  PlannedStep done;
  done.settings = wanted;
  const StageSet stages = stagesToRedo(base, wanted, context.planner);
  done.data = changedStep(base.data, wanted, [](StepRecord&) {});
  auto record = std::make_shared<StepRecord>(*base.data.record);
  if (usesOctree(context.planner))
    replanOctree(*record, done.data, context, wanted, stages, control);
  else
    replanContour(*record, base, context, wanted, stages, control);
  done.data.record = std::move(record);
  return done;
}

Reranked rerank(const PlannedStep& base, const ScoredGroups* groups, const WhatIfContext& context,
                const Settings& wanted, ReachCheck check, const RunControl& control) {
  if (usesOctree(context.planner)) return rerankOctree(base, context, wanted, check, control);
  return rerankContour(base, *groups, context, wanted, check, control);
}

std::shared_ptr<const ScoredGroup> scoreGroupOf(const PlannedStep& base, const ScoredGroups& groups,
                                                const WhatIfContext& context, const SegmentSearch& group,
                                                const RunControl& control) {
  const SearchInput search(base, context, groups.scoredWith());
  return scoreGroup(search.input, groups.scoredWith(), group, control);
}

StepData withAllScores(const StepData& data, const PlannedStep& base, const ScoredGroups& groups,
                       const WhatIfContext& context, const Settings& wanted) {
  if (!data.record->search) return data;
  const ContourPlannerConfig config = contourConfigOf(wanted, context.planner);
  const SearchInput search(base, context, config);
  auto filled = std::make_shared<ViewSearch>(*data.record->search);
  for (SegmentSearch& group : filled->segments)
    if (!group.scored) fillScores(search.input, config, groups, group);
  StepData result = data;
  auto record = std::make_shared<StepRecord>(*data.record);
  record->search = std::move(filled);
  result.record = std::move(record);
  return result;
}

}  // namespace vantage
