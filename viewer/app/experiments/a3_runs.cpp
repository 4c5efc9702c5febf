#include "viewer/app/experiments/a3_runs.h"

#include "core/exploration/plan_view.h"
#include "hardware/replay_depth_camera.h"
#include "hardware/simulated_depth_camera.h"
#include "hardware/simulated_robot.h"
#include "io/scene_truth.h"
#include "viewer/app/experiments/evaluation_time.h"
#include "viewer/app/experiments/stop_words.h"
#include "viewer/app/experiments/table_run.h"

namespace vantage::experiments {
namespace {

/// Takes the times of the phases of every step.
class Meter {
 public:
  Meter(const ExplorationConfig& config, const WorldModel& world, const ExperimentOptions& options,
        RateRun& run)
      : config_(config),
        planner_(config.hierarchical),
        world_(world),
        options_(options),
        box_(config.objectBox()),
        tree_(planner_.sensor, config.octree.voxel_size_m, planner_.coarse_levels),
        run_(run) {}

  void watch(const StepRecord& record) {
    if (record.stage == Stage::Realised) exclusions_.add(record, config_.contour.gain);
    if (record.stage == Stage::Fuse)
      run_.unknown_per_scan.push_back(static_cast<double>(record.box->unknown));
    if (record.stage == Stage::Evaluation) evaluated(record);
  }
  const UtilitySearch* last() const { return last_.get(); }

 private:
  void evaluated(const StepRecord& record) {
    last_ = record.utilities;
    const auto candidates = candidatesOf(*last_);
    const Pose& current = record.scan.back().T_world_camera;
    const UtilityInput input{*world_.pyramid(), tree_, box_, candidates, current, exclusions_.executed};
    const Timings& t = record.timings;
    const double evaluation_s =
        evaluationTime(input, planner_, *last_, options_.repeats, options_.control).wall_s;
    run_.steps.push_back({t.sense.value_or(0), t.fuse.value_or(0), t.generation.value_or(0) + evaluation_s,
                          t.motion_planning.value_or(0)});
    run_.candidates += static_cast<double>(last_->counts.poses_generated);
    run_.scored += static_cast<double>(last_->counts.poses_scored);
    run_.rejected_position += static_cast<double>(last_->rejected_position);
    run_.rejected_registration += static_cast<double>(last_->rejected_registration);
  }

  const ExplorationConfig& config_;
  const HierarchicalPlannerConfig& planner_;
  const WorldModel& world_;
  const ExperimentOptions& options_;
  Box box_;
  RayTree tree_;
  RateRun& run_;
  Exclusions exclusions_;  // as the loop keeps them
  std::shared_ptr<const UtilitySearch> last_;
};

/// Runs the loop and takes the times of its phases.
RateRun measureRun(const ExplorationConfig& config, DepthCamera& camera, Robot& robot,
                   const GroundTruth* truth, const ExperimentOptions& options) {
  Explorer explorer(config, camera, robot, truth);
  RateRun run;
  run.mode = RunSpec{.coarse_levels = config.hierarchical.coarse_levels,
                     .start = config.hierarchical.child_start,
                     .inner = config.octree.occupancy.inner}
                 .label();
  Meter meter(config, explorer.world(), options, run);
  explorer.addObserver([&](const std::shared_ptr<const StepRecord>& record) { meter.watch(*record); });
  const ExplorationResult ended = explorer.run(options.control);
  options.control.check();
  run.cut_off = ended.stop_reason == kStepsDone;
  run.stop_reason = stopWords(ended, meter.last(), config.hierarchical.stop_gain);
  for (double* value : {&run.candidates, &run.scored, &run.rejected_position, &run.rejected_registration})
    *value /= std::max<double>(1.0, static_cast<double>(run.steps.size()));
  return run;
}

/// The command line's part, then what makes it this experiment.
void prepare(Settings& settings, const ExperimentOptions& options, std::uint64_t seed) {
  if (options.quick) settings.exploration.steps = 6;
  if (options.tune) options.tune(settings);
  settings.exploration.planners = {PlannerKind::Hierarchical};
  settings.exploration.seed += seed;
  settings.validate();
}

Settings roomSettings(const SceneFile& scene, const ExperimentOptions& options, std::uint64_t seed) {
  Settings settings;
  applyScene(settings, scene);
  settings.exploration.octree.known_scene = true;
  prepare(settings, options, seed);
  return settings;
}

Settings replaySettings(const Dataset& dataset, const ExperimentOptions& options, std::uint64_t seed) {
  Settings settings = settingsForDataset(dataset);
  ExplorationConfig& config = settings.exploration;
  config.hierarchical.generator = CandidateGenerator::Workspace;
  config.hierarchical.exclude_executed = true;
  config.recorded_candidates = true;
  config.serve_distance_m = 0.10;  // and 10 deg, as the settings have it
  config.scan.initial_frames = 1;
  config.steps = 10;
  prepare(settings, options, seed);
  return settings;
}

}  // namespace

Phases RateRun::mean() const {
  Phases sum;
  for (const Phases& p : steps) {
    sum.scan += p.scan;
    sum.update += p.update;
    sum.evaluate += p.evaluate;
    sum.path += p.path;
  }
  const double n = std::max<double>(1.0, static_cast<double>(steps.size()));
  return {sum.scan / n, sum.update / n, sum.evaluate / n, sum.path / n};
}

std::optional<double> RateRun::secondsPerView() const {
  return scored > 0 ? std::optional(mean().evaluate / candidates) : std::nullopt;
}

bool RateRun::unknownFalls() const {
  return std::ranges::adjacent_find(unknown_per_scan, std::less_equal<>()) == unknown_per_scan.end();
}

RateRun runRoom(const ExperimentOptions& options, std::uint64_t seed, std::vector<DefaultUsed>& used) {
  const SceneFile scene = loadScene("a3_room");
  const Settings settings = roomSettings(scene, options, seed);
  used = defaultsUsed(settings, "A3 room", true);
  const ExplorationConfig& config = settings.exploration;
  SimulatedDepthCamera camera(scene, {settings.camera, settings.sensor, config.seed});
  FreeFlyer robot(settings.free_flyer, initialScanPoses(config.scan).back());
  const SceneTruth truth(scene);
  return measureRun(config, camera, robot, &truth, options);
}

RateRun runReplay(const ExperimentOptions& options, std::uint64_t seed, std::vector<DefaultUsed>& used) {
  Dataset dataset = openDataset(options.dataset);
  const Settings settings = replaySettings(dataset, options, seed);
  used = defaultsUsed(settings, "A3 replay", false);
  FreeFlyer robot(settings.free_flyer, dataset.frames.front().T_world_camera);
  ReplayDepthCamera camera(std::move(dataset));
  return measureRun(settings.exploration, camera, robot, nullptr, options);
}

void checkA3(const ExperimentOptions& options) {
  roomSettings(loadScene("a3_room"), options, 0);
  if (!options.dataset.empty()) replaySettings(openDataset(options.dataset), options, 0);
}

}  // namespace vantage::experiments
