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
#include "viewer/app/experiments/stop_words.h"

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
    const EvaluationTime time = evaluationTime(input, config_, search, repeats_, control_);
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
    step.rejected_registration = search.rejected_registration;
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
    enum : std::uint8_t { kNotCast, kEqual, kDiffers };
    const HierarchicalQuery query = queryOf(box_, config_);
    std::vector<std::uint8_t> found(search.views.size(), kNotCast);
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t n) {
      const ViewUtility& view = search.views[n];
      if (view.rays.rays_cast == 0) return;  // dropped before its rays
      const RayCounts again = castHierarchical(input.pyramid, tree_, 0, view.T_world_camera, query);
      found[n] = again == view.rays ? kEqual : kDiffers;
    });
    const auto count = [&](std::uint8_t kind) {
      return static_cast<std::uint64_t>(std::count(found.begin(), found.end(), kind));
    };
    result_.compared_with_uniform += count(kEqual) + count(kDiffers);
    result_.different_from_uniform += count(kDiffers);
  }

  /// The grids must never drift from the octree that they stand for.
  void compareLabels(const WorldModel& world) {
    const StatePyramid& pyramid = *world.pyramid();
    const GridGeometry& g = pyramid.finest().geometry();
    const Eigen::Vector3i low = g.voxelAt(box_.min()).cwiseMax(0);
    const Eigen::Vector3i high = g.voxelAt(box_.max()).cwiseMin(g.size - Eigen::Vector3i::Ones());
    if ((low.array() > high.array()).any()) return;
    ++result_.compared_steps;
    for (int level = 0; level <= pyramid.coarseLevels(); ++level) {
      const Eigen::Vector3i first = pyramid.node(low, level), last = pyramid.node(high, level);
      for (int k = first.z(); k <= last.z(); ++k)
        for (int j = first.y(); j <= last.y(); ++j)
          for (int i = first.x(); i <= last.x(); ++i)
            compareLabel(*world.octree(), pyramid, {i, j, k}, level, low);
    }
  }

  /// \param low least voxel of the region; the node has voxels in it
  void compareLabel(const OccupancyOctree& octree, const StatePyramid& pyramid, const Eigen::Vector3i& node,
                    int level, const Eigen::Vector3i& low) {
    const Eigen::Vector3i voxel = (node * (1 << level) - pyramid.offset(level)).cwiseMax(low);
    ++result_.compared_labels;
    result_.wrong_labels += pyramid.level(level).at(node) != octree.label(voxel, level);
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

ExplorationConfig configOf(const TableSetup& setup, const RunSpec& spec) {
  ExplorationConfig config = setup.settings.exploration;
  config.planners = {spec.coarse_levels == 0 ? PlannerKind::Uniform : PlannerKind::Hierarchical};
  config.hierarchical.coarse_levels = spec.coarse_levels;
  config.hierarchical.child_start = spec.start;
  config.hierarchical.exclude_executed = !spec.repeat_views;
  if (spec.min_overlap > 0.0) config.hierarchical.min_overlap = spec.min_overlap;
  if (spec.refine_unknown) config.hierarchical.refine_unknown = true;
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
  std::shared_ptr<const UtilitySearch> last;
  explorer.addObserver([&](const std::shared_ptr<const StepRecord>& record) {
    if (record->stage == Stage::Fuse) {
      ++result.scans;
      result.unknown_per_scan.push_back(static_cast<double>(record->box->unknown));
    }
    if (record->stage == Stage::Evaluation) {
      last = record->utilities;
      meter.evaluated(*record, explorer.world());
    }
    if (record->stage == Stage::Done && !setup.truth->observableSurface().empty())
      result.coverage = record->metrics.coverage;
  });
  const ExplorationResult ended = explorer.run(control);
  control.check();
  result.cut_off = ended.stop_reason == kStepsDone;
  result.stop_reason = stopWords(ended, last.get(), config.hierarchical.stop_gain);
  measureAccuracy(setup, explorer.world(), config.objectBox(), result);
  return result;
}

}  // namespace vantage::experiments
