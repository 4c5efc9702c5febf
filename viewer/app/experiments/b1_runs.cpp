#include "viewer/app/experiments/b1_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/exploration/explorer.h"
#include "hardware/simulated_arm.h"
#include "hardware/simulated_depth_camera.h"
#include "hardware/simulated_robot.h"
#include "io/robot_file.h"
#include "io/scene_truth.h"
#include "viewer/app/experiments/b1_segments.h"

namespace vantage::experiments {
namespace {

constexpr const char* kArm = "smart_six";  // of the paper

double orZero(const std::optional<double>& seconds) {
  return seconds.value_or(0.0);
}

NbvSeconds secondsOf(const Timings& t, bool proposed) {
  NbvSeconds seconds;
  if (proposed) seconds.segmentation = orZero(t.surface) + orZero(t.segmentation) + orZero(t.saliency);
  seconds.generation = orZero(t.contours) + orZero(t.generation);
  seconds.evaluation = orZero(t.evaluation);
  seconds.map_update = orZero(t.fuse) + orZero(t.collision_map);
  seconds.motion_planning = orZero(t.motion_planning);
  seconds.motion = orZero(t.motion);
  return seconds;
}

/// What a step decided; the gain that it realised comes later.
NbvResult nbvOf(const StepRecord& record, bool proposed, const SceneTruth& truth, const SceneRays& others) {
  NbvResult nbv;
  const ViewSearch& search = *record.search;
  nbv.generated = search.counts.poses_generated;
  nbv.scored = search.counts.poses_scored;
  nbv.unreachable = search.counts.poses_unreachable;
  nbv.rays = search.counts.rays;
  nbv.visited = search.counts.voxels_visited;
  nbv.seconds = secondsOf(record.timings, proposed);
  if (proposed) {
    const SegmentObjects objects(record, truth, others);
    nbv.segments = objects.rows();
    nbv.saliency_check = objects.check();
  }
  if (!search.chosen) return nbv;
  nbv.chosen = true;
  nbv.toward_object = record.toward_object.value_or(false);
  nbv.gain = search.chosen->gain;
  nbv.gain_voxels = search.chosen->gain_voxels;
  nbv.rank = search.chosen->rank;
  nbv.saliency = search.segments[search.chosen->search].saliency;
  return nbv;
}

/// Takes what is asked of each step while the loop runs.
class Recorder {
 public:
  Recorder(ExplorationRun& result, const SceneFile& scene, const SceneTruth& truth)
      : result_(result), truth_(truth), others_(meshOfOthers(scene)) {}

  void watch(const StepRecord& record) {
    if (record.stage == Stage::Realised) {
      result_.nbvs.at(static_cast<std::size_t>(record.step) - 1).realised_voxels =
          record.realised_voxels.value_or(0);
      return;
    }
    if (record.stage != Stage::Done) return;
    result_.unknown_near_objects.push_back(
        static_cast<double>(record.metrics.unknown_near_objects.value_or(0)));
    result_.unknown_in_boxes.push_back(static_cast<double>(record.metrics.unknown_in_boxes.value_or(0)));
    if (record.metrics.coverage) result_.coverage = *record.metrics.coverage;
    if (!record.closing) result_.nbvs.push_back(nbvOf(record, result_.run.proposed, truth_, others_));
  }

 private:
  ExplorationRun& result_;
  const SceneTruth& truth_;
  SceneRays others_;
};

/// A run that ended early did not change the map any more.
void fill(ExplorationRun& result) {
  result.nbvs.resize(kNbvs);
  for (auto* curve : {&result.unknown_near_objects, &result.unknown_in_boxes})
    curve->resize(kNbvs + 1, curve->empty() ? 0.0 : curve->back());
}

}  // namespace

std::string_view toString(Series series) {
  constexpr std::string_view kNames[] = {"core", "open", "filtered", "exact", "unseen", "arm"};
  return kNames[static_cast<int>(series)];
}

std::string RunOf::text() const {
  return fmt::format("{} {} {} seed {}{}{}", scene, toString(series), method(), seed,
                     variant.empty() ? "" : ", ", variant);
}

int ExplorationRun::ticks() const {
  return static_cast<int>(std::ranges::count_if(nbvs, &NbvResult::toward_object));
}

bool ExplorationRun::ticksFirst() const {
  return std::ranges::is_partitioned(nbvs, [](const NbvResult& nbv) { return nbv.toward_object; });
}

double ExplorationRun::area() const {
  double area = 0.0;
  for (std::size_t i = 1; i < unknown_near_objects.size(); ++i)
    area += (unknown_near_objects[i - 1] + unknown_near_objects[i]) / 2;
  return area;
}

NbvSeconds ExplorationRun::seconds() const {
  NbvSeconds sum;
  for (const NbvResult& nbv : nbvs)
    for (double NbvSeconds::*part :
         {&NbvSeconds::segmentation, &NbvSeconds::generation, &NbvSeconds::evaluation,
          &NbvSeconds::map_update, &NbvSeconds::motion_planning, &NbvSeconds::motion})
      sum.*part += nbv.seconds.*part;
  return sum;
}

SceneFile sceneOf(const RunOf& run) {
  return loadScene(run.series == Series::Open ? run.scene + "_open" : run.scene);
}

Settings settingsOf(const RunOf& run, const SceneFile& scene, const std::function<void(Settings&)>& tune) {
  Settings settings;
  applyScene(settings, scene);
  if (tune) tune(settings);
  for (const std::string& assignment : run.settings) applyAssignment(settings, assignment, "variant");
  ExplorationConfig& exploration = settings.exploration;
  exploration.steps = kNbvs;
  exploration.planners = {run.proposed ? PlannerKind::Contour : PlannerKind::Standard};
  exploration.seed += run.seed - 1;
  if (run.series == Series::Exact) settings.sensor.noise_at_1m_m = 0.0;
  if (run.series == Series::Filtered) {
    settings.sensor.faults = true;
    exploration.filter.bilateral = exploration.filter.shadow = exploration.filter.veil = true;
  }
  settings.validate();
  return settings;
}

ExplorationRun runExploration(const RunOf& run, const std::function<void(Settings&)>& tune,
                              const RunControl& control) {
  const SceneFile scene = sceneOf(run);
  const Settings settings = settingsOf(run, scene, tune);
  const ExplorationConfig& config = settings.exploration;
  SimulatedDepthCamera camera(scene, {settings.camera, settings.sensor, config.seed});
  FreeFlyer flyer(settings.free_flyer, initialScanPoses(config.scan).back());
  std::unique_ptr<SimulatedArm> arm;
  std::optional<SimulatedHandCamera> hand;
  if (run.series == Series::Arm) {
    arm = startedArm(loadRobot(kArm), settings);
    hand.emplace(camera, *arm);
  }
  const SceneTruth truth(scene);
  ExplorationRun result;
  result.run = run;
  Recorder recorder(result, scene, truth);
  Explorer explorer(config, hand ? static_cast<DepthCamera&>(*hand) : camera,
                    arm ? static_cast<Robot&>(*arm) : flyer, &truth);
  explorer.addObserver([&](const std::shared_ptr<const StepRecord>& record) { recorder.watch(*record); });
  result.stop_reason = explorer.run(control).stop_reason;
  control.check();
  fill(result);
  return result;
}

}  // namespace vantage::experiments
