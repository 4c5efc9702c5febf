#include "core/exploration/plan_view.h"

#include <utility>

#include "core/exploration/stopwatch.h"

namespace vantage {
namespace {

/// The result of `work`, shared and immutable; stores its duration.
template <class Work>
auto timed(std::optional<double>& seconds, Work&& work) {
  const Stopwatch watch;
  auto result = std::make_shared<const decltype(work())>(work());
  seconds = watch.seconds();
  return result;
}

}  // namespace

MotionPlan judged(MotionPlan plan, bool enforce, MotionPlan& reported) {
  if (enforce || plan.verdict == Reachability::OutOfReach) return plan;
  reported = plan;
  plan.verdict = Reachability::Reachable;
  return plan;
}

void reportMotion(StepRecord& record, const MotionPlan& reported) {
  if (!record.hasView()) return;
  const auto replace = [&](auto& product) {
    if (!product || !product->chosen) return;
    const auto changed = std::make_shared<std::remove_cvref_t<decltype(*product)>>(*product);
    changed->chosen->path = reported;
    product = changed;
  };
  replace(record.search);
  replace(record.utilities);
}

void Exclusions::add(const StepRecord& record, const GainConfig& config) {
  if (!record.hasView()) return;
  executed.push_back(record.chosen()->T_world_camera);
  if (record.served) executed.push_back(record.served->T_world_camera);
  if (!record.search) return;
  const ContourChosenView& chosen = *record.search->chosen;
  if (config.exclude_disappointing && record.realised_voxels &&
      static_cast<double>(*record.realised_voxels) <
          config.disappointing_share * static_cast<double>(chosen.gain_voxels))
    disappointing.push_back(record.contours->points[chosen.contour_point].position_m);
}

void planView(StepRecord& record, const PlanViewInput& input, const ReachPose& reach,
              const std::function<void(Stage)>& publish, const RunControl& control) {
  const ContourPlannerConfig& config = input.config;
  const bool segments = config.segment_by_segment;
  Timings& t = record.timings;
  std::optional<double> untimed;  // the baseline needs no surface; it is kept for coverage and pictures
  const auto finish = [&](Stage stage) {
    publish(stage);
    control.check();
  };

  record.contours = timed(t.contours, [&] { return extractContours(input.volume, config.contours); });
  finish(Stage::Contours);

  record.surface = timed(segments ? t.surface : untimed,
                         [&] { return extractSurface(input.volume, config.contours.weight_threshold); });
  finish(Stage::Surface);

  if (segments) {
    record.labels =
        timed(t.segmentation, [&] { return segmentSurface(*record.surface, config.segmentation); });
    finish(Stage::Segmentation);
    record.saliency =
        timed(t.saliency, [&] { return computeSaliency(*record.surface, *record.labels, config.saliency); });
    finish(Stage::Saliency);
  }

  record.positions =
      timed(t.generation, [&] { return contourViewPositions(record.contours->points, config.views); });
  record.point_labels = std::make_shared<const std::vector<std::uint32_t>>(
      segments ? assignContourPoints(record.contours->points, *record.surface, *record.labels)
               : std::vector<std::uint32_t>());
  finish(Stage::Generation);

  const Saliency no_saliency;
  const ViewSearchInput search_input{.states = input.states,
                                     .camera = input.camera,
                                     .workspace = input.workspace,
                                     .points = record.contours->points,
                                     .positions = *record.positions,
                                     .point_labels = *record.point_labels,
                                     .saliency = segments ? *record.saliency : no_saliency,
                                     .executed = input.executed,
                                     .disappointing = input.disappointing};
  record.search = std::make_shared<const ViewSearch>(searchView(search_input, config, reach, control));
  t.evaluation = record.search->evaluation_s;
  t.motion_planning = record.search->motion_planning_s;
  finish(Stage::Evaluation);
}

void planUtility(StepRecord& record, const PlanUtilityInput& input, const ReachPose& reach,
                 const std::function<void(Stage)>& publish, const RunControl& control) {
  Timings& t = record.timings;
  const auto candidates = timed(t.generation, [&] {
    auto views = makeCandidates(input.config, input.object_box, input.workspace, input.seed);
    for (const ScanPose& pose : input.recorded)
      views.push_back({static_cast<std::uint32_t>(views.size()), pose.T_world_camera, pose.frame});
    return views;
  });
  publish(Stage::Generation);
  control.check();

  const UtilityInput search_input{.pyramid = input.pyramid,
                                  .tree = input.tree,
                                  .object_box = input.object_box,
                                  .candidates = *candidates,
                                  .current = input.current,
                                  .executed = input.executed};
  record.utilities =
      std::make_shared<const UtilitySearch>(searchUtility(search_input, input.config, reach, control));
  t.evaluation = record.utilities->evaluation_s;
  t.motion_planning = record.utilities->motion_planning_s;
  publish(Stage::Evaluation);
  control.check();
}

}  // namespace vantage
