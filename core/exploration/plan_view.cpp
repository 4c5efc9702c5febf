#include "core/exploration/plan_view.h"

#include <stdexcept>
#include <string>
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

template <class Product>
void requireProduct(const Product* product, const char* name, Stage stage) {
  if (product) return;
  throw std::invalid_argument(std::string("planning again: the record has no ") + name +
                              " to start from; do " + std::string(toString(stage)) + " again too");
}

/// What is not done again must be there.
void requireKept(const StepRecord& record, const StageSet& todo, bool segments) {
  const auto require = [&](Stage stage, const auto& product, const char* name) {
    if (!todo.has(stage)) requireProduct(product.get(), name, stage);
  };
  require(Stage::Contours, record.contours, "contours");
  require(Stage::Surface, record.surface, "surface");
  require(Stage::Generation, record.positions, "view positions");
  require(Stage::Generation, record.point_labels, "labels of contour points");
  if (!segments) return;
  require(Stage::Segmentation, record.labels, "segments");
  require(Stage::Saliency, record.saliency, "saliency");
}

/// Those of the stages to do, and those that the baseline has no use for.
void dropProducts(StepRecord& record, const StageSet& stages, bool segments) {
  if (stages.has(Stage::Contours)) record.contours.reset();
  if (stages.has(Stage::Surface)) record.surface.reset();
  if (!segments || stages.has(Stage::Segmentation)) record.labels.reset();
  if (!segments || stages.has(Stage::Saliency)) record.saliency.reset();
  if (stages.has(Stage::Generation)) {
    record.positions.reset();
    record.point_labels.reset();
  }
  if (stages.has(Stage::Evaluation)) record.search.reset();
}

/// The recorded saliency under another configuration, from the distances kept.
std::shared_ptr<const Saliency> scoredAnew(const StepRecord& record, const SaliencyConfig& config) {
  const auto saliency = std::make_shared<Saliency>(*record.saliency);
  saliency->segments = rescoreSegments(*saliency, *record.labels, config);
  return saliency;
}

/// Lines 6-17.
void evaluate(StepRecord& record, const PlanViewInput& input, const ReachPose& reach,
              const RunControl& control) {
  const Saliency no_saliency;
  const ViewSearchInput search_input{.states = input.states,
                                     .camera = input.camera,
                                     .workspace = input.workspace,
                                     .points = record.contours->points,
                                     .positions = *record.positions,
                                     .point_labels = *record.point_labels,
                                     .saliency = record.saliency ? *record.saliency : no_saliency,
                                     .executed = input.executed,
                                     .disappointing = input.disappointing};
  record.search = std::make_shared<const ViewSearch>(searchView(search_input, input.config, reach, control));
  record.timings.evaluation = record.search->evaluation_s;
  record.timings.motion_planning = record.search->motion_planning_s;
}

/// Generated ones and the recorded poses that are offered beside them.
std::vector<ViewCandidate> generateCandidates(const PlanUtilityInput& input) {
  auto candidates = makeCandidates(input.config, input.object_box, input.workspace, input.seed);
  for (const ScanPose& pose : input.recorded)
    candidates.push_back({static_cast<std::uint32_t>(candidates.size()), pose.T_world_camera, pose.frame});
  return candidates;
}

std::vector<ViewCandidate> candidatesOf(const UtilitySearch& search) {
  std::vector<ViewCandidate> candidates;
  for (const ViewUtility& view : search.views)
    candidates.push_back({view.id, view.T_world_camera, view.frame});
  return candidates;
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
              const std::function<void(Stage)>& publish, const RunControl& control, const StageSet& stages) {
  const ContourPlannerConfig& config = input.config;
  const bool segments = config.segment_by_segment;
  const StageSet todo = stages.withDependents();
  if (todo.empty()) return;
  requireKept(record, todo, segments);
  control.check();
  dropProducts(record, todo, segments);
  if (record.saliency) record.saliency = scoredAnew(record, config.saliency);

  Timings& t = record.timings;
  std::optional<double> untimed;  // the baseline needs no surface; it is kept for coverage and pictures
  const auto finish = [&](Stage stage) {
    publish(stage);
    control.check();
  };
  int started = 0;
  const auto start = [&](Stage stage) {
    if (!todo.has(stage)) return false;
    control.report(toString(stage), started++, todo.count());
    return true;
  };

  if (start(Stage::Contours)) {
    record.contours = timed(t.contours, [&] { return extractContours(input.volume, config.contours); });
    finish(Stage::Contours);
  }
  if (start(Stage::Surface)) {
    record.surface = timed(segments ? t.surface : untimed,
                           [&] { return extractSurface(input.volume, config.contours.weight_threshold); });
    finish(Stage::Surface);
  }
  if (segments && start(Stage::Segmentation)) {
    record.labels =
        timed(t.segmentation, [&] { return segmentSurface(*record.surface, config.segmentation); });
    finish(Stage::Segmentation);
  }
  if (segments && start(Stage::Saliency)) {
    record.saliency =
        timed(t.saliency, [&] { return computeSaliency(*record.surface, *record.labels, config.saliency); });
    finish(Stage::Saliency);
  }
  if (start(Stage::Generation)) {
    record.positions =
        timed(t.generation, [&] { return contourViewPositions(record.contours->points, config.views); });
    record.point_labels = std::make_shared<const std::vector<std::uint32_t>>(
        segments ? assignContourPoints(record.contours->points, *record.surface, *record.labels)
                 : std::vector<std::uint32_t>());
    finish(Stage::Generation);
  }
  evaluate(record, input, reach, control);
  finish(Stage::Evaluation);
}

void planUtility(StepRecord& record, const PlanUtilityInput& input, const ReachPose& reach,
                 const std::function<void(Stage)>& publish, const RunControl& control,
                 const StageSet& stages) {
  const StageSet todo = stages.withDependents();
  if (todo.empty()) return;
  if (!todo.has(Stage::Generation)) requireProduct(record.utilities.get(), "views", Stage::Generation);
  control.check();
  Timings& t = record.timings;
  const auto recorded = std::exchange(record.utilities, nullptr);
  std::shared_ptr<const std::vector<ViewCandidate>> candidates;
  if (todo.has(Stage::Generation)) {
    control.report(toString(Stage::Generation), 0, todo.count());
    candidates = timed(t.generation, [&] { return generateCandidates(input); });
    publish(Stage::Generation);
    control.check();
  } else {
    candidates = std::make_shared<const std::vector<ViewCandidate>>(candidatesOf(*recorded));
  }

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
