#include "viewer/app/experiments/table_run.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/exploration/map_metrics.h"
#include "core/exploration/stopwatch.h"
#include "hardware/simulated_depth_camera.h"
#include "hardware/simulated_robot.h"
#include "viewer/app/experiments/evaluation_time.h"

namespace vantage::experiments {
namespace {

/// Watches a run at the end of every evaluation and measures it on the step's own inputs.
class Meter {
 public:
  Meter(const TableSetup& setup, const ExplorationConfig& config, const RunSpec& spec, int repeats,
        const RunControl& control, RunResult& result)
      : setup_(setup),
        config_(config.hierarchical),
        box_(config.objectBox()),
        repeats_(repeats),
        control_(control),
        tree_(config_.sensor, config.octree.voxel_size_m, spec.coarse_levels),
        result_(result) {
    result_.rays_per_view = tree_.level(0).count();
  }

  void evaluated(const StepRecord& record, const WorldModel& world) {
    const UtilitySearch& search = *record.utilities;
    candidates_ = candidatesOf(search);
    const Pose& current = record.scan.back().T_world_camera;
    const UtilityInput input{*world.pyramid(), tree_, box_, candidates_, current, executed_};

    IterationResult step = countsOf(search);
    const EvaluationTime time = evaluationTime(input, config_, search.evaluation_s, repeats_, control_);
    step.nbv_s = record.timings.generation.value_or(0.0) + time.wall_s;
    step.cpu_s = time.cpu_s;
    if (step.literal_stop && result_.literal_stop == 0) result_.literal_stop = record.step;
    result_.iterations.push_back(step);
    if (record.step == 1) measureHidden(input);
    if (config_.coarse_levels == 0) compareWithHierarchical(input, search);
    if (record.step % 10 == 1) compareLabels(world);
    if (search.chosen) executed_.push_back(search.chosen->T_world_camera);
  }

 private:
  static IterationResult countsOf(const UtilitySearch& search) {
    IterationResult step;
    step.candidates = search.counts.poses_generated;
    step.scored = search.counts.poses_scored;
    step.survivors = search.ranking.size();
    step.rays = search.counts.rays;
    step.finest_rays = search.finest_rays_cast;
    step.visits = search.counts.voxels_visited;
    step.unknown_voxels = search.box_unknown;
    step.literal_stop = search.literal_stop;
    for (const ViewUtility& view : search.views) {
      step.occupied_rays += view.rays.occupied;
      step.unknown_rays += view.rays.unknown;
    }
    if (search.chosen) {
      step.chosen = search.chosen->id;
      step.gain = search.chosen->gain;
    }
    return step;
  }

  void measureHidden(const UtilityInput& input) {
    std::vector<ViewCandidate> hidden;
    for (const ViewCandidate& view : candidates_)
      if (view.T_world_camera.translation().z() < setup_.table_top_m &&
          bodyFits(input.pyramid.finest(), view.T_world_camera.translation(), config_.body_m))
        hidden.push_back(view);
    std::vector<double> times;
    for (int n = 0; n < std::max(repeats_, 1) + 1; ++n) {
      std::uint64_t visits = 0;
      const Stopwatch watch;
      for (const ViewCandidate& view : hidden) visits += evaluateView(input, config_, view, 1).rays.visited;
      if (n > 0) times.push_back(watch.seconds());
      result_.hidden = {hidden.size(), visits, 0.0};
    }
    result_.hidden.seconds = median(std::move(times));
  }

  /// Requirement (i) of section 10.4: the hierarchical caster without coarse levels against the uniform one.
  void compareWithHierarchical(const UtilityInput& input, const UtilitySearch& search) {
    HierarchicalQuery query;
    query.bounds = box_;
    std::vector<std::uint8_t> differs(search.views.size(), 0);
    tbb::parallel_for(std::size_t{0}, differs.size(), [&](std::size_t n) {
      const ViewUtility& view = search.views[n];
      if (view.rays.rays_cast > 0)  // not dropped before its rays
        differs[n] = castHierarchical(input.pyramid, tree_, 0, view.T_world_camera, query) != view.rays;
    });
    result_.compared_with_uniform += search.counts.poses_scored;
    result_.different_from_uniform +=
        static_cast<std::uint64_t>(std::count(differs.begin(), differs.end(), 1));
  }

  /// The grids must never drift from the octree that they stand for.
  void compareLabels(const WorldModel& world) {
    const StatePyramid& pyramid = *world.pyramid();
    const GridGeometry& g = pyramid.finest().geometry();
    const Eigen::Vector3i low = g.voxelAt(box_.min()).cwiseMax(0);
    const Eigen::Vector3i high = g.voxelAt(box_.max()).cwiseMin(g.size - Eigen::Vector3i::Ones());
    for (int level = 0; level <= pyramid.coarseLevels(); ++level) {
      const int step = 1 << level;
      for (int k = low.z(); k <= high.z(); k += step)
        for (int j = low.y(); j <= high.y(); j += step)
          for (int i = low.x(); i <= high.x(); i += step)
            result_.wrong_labels += pyramid.level(level).at(pyramid.node({i, j, k}, level)) !=
                                    world.octree()->label({i, j, k}, level);
    }
  }

  const TableSetup& setup_;
  const HierarchicalPlannerConfig& config_;
  Box box_;
  int repeats_;
  const RunControl& control_;
  RayTree tree_;
  RunResult& result_;
  std::vector<ViewCandidate> candidates_;
  std::vector<Pose> executed_;
};

/// Distances of occupied voxel centres in the box to the true surface (evaluation.md, section 2).
void measureAccuracy(const TableSetup& setup, const WorldModel& world, const Box& box, RunResult& result) {
  std::vector<double> distances;
  for (const Eigen::Vector3f& center : occupiedCenters(world.pyramid()->finest(), Box(box)))
    if (box.contains(center.cast<double>()))
      distances.push_back(setup.truth->surfaceDistance(center.cast<double>()));
  if (distances.empty()) return;
  std::sort(distances.begin(), distances.end());
  result.accuracy_mean_m = std::accumulate(distances.begin(), distances.end(), 0.0) / distances.size();
  result.accuracy_95_m = distances[static_cast<std::size_t>(std::ceil(0.95 * distances.size())) - 1];
}

/// Why a run without a further view ended.
std::string refined(const std::string& stop_reason, const RunResult& result) {
  if (stop_reason != "finished" || result.iterations.empty()) return stop_reason;
  return result.iterations.back().survivors == 0
             ? "finished: too little known surface in every view (registration)"
             : "finished: no view reaches h_stop";
}

ExplorationConfig configOf(const TableSetup& setup, const RunSpec& spec) {
  ExplorationConfig config = setup.settings.exploration;
  config.planners = {spec.coarse_levels == 0 ? PlannerKind::Uniform : PlannerKind::Hierarchical};
  config.hierarchical.coarse_levels = spec.coarse_levels;
  config.hierarchical.child_start = spec.start;
  config.hierarchical.exclude_executed = !spec.repeat_views;
  if (spec.min_overlap > 0.0) config.hierarchical.min_overlap = spec.min_overlap;
  config.octree.occupancy.inner = spec.inner;
  return config;
}

}  // namespace

double RunResult::totalNbv_s() const {
  return std::accumulate(iterations.begin(), iterations.end(), 0.0,
                         [](double sum, const IterationResult& step) { return sum + step.nbv_s; });
}
double RunResult::meanNbv_s() const {
  return iterations.empty() ? 0.0 : totalNbv_s() / static_cast<double>(iterations.size());
}

double RunResult::meanCpu_s() const {
  double sum = 0.0;
  for (const IterationResult& step : iterations) sum += step.cpu_s;
  return iterations.empty() ? 0.0 : sum / static_cast<double>(iterations.size());
}
double RunResult::secondsPerCandidate() const {
  std::uint64_t candidates = 0;
  for (const IterationResult& step : iterations) candidates += step.candidates;
  return candidates == 0 ? 0.0 : totalNbv_s() / static_cast<double>(candidates);
}

RunResult runOnTable(const TableSetup& setup, const RunSpec& spec, int repeats, const RunControl& control) {
  const ExplorationConfig config = configOf(setup, spec);
  SimulatedDepthCamera camera(setup.scene, {setup.settings.camera, setup.settings.sensor, config.seed});
  FreeFlyer robot(setup.settings.free_flyer, initialScanPoses(config.scan).back());
  Explorer explorer(config, camera, robot, setup.truth.get());

  RunResult result;
  result.spec = spec;
  Meter meter(setup, config, spec, repeats, control, result);
  explorer.addObserver([&](const std::shared_ptr<const StepRecord>& record) {
    if (record->stage == Stage::Fuse) {
      ++result.scans;
      result.unknown_per_scan.push_back(static_cast<double>(record->box->unknown));
    }
    if (record->stage == Stage::Evaluation) meter.evaluated(*record, explorer.world());
    if (record->stage == Stage::Done) result.coverage = record->metrics.coverage.value_or(0.0);
  });
  result.stop_reason = refined(explorer.run(control).stop_reason, result);
  control.check();
  measureAccuracy(setup, explorer.world(), config.objectBox(), result);
  return result;
}

}  // namespace vantage::experiments
