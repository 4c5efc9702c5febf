#include "tests/support/simulated_run.h"

#include <tbb/global_control.h>

#include "hardware/simulated_depth_camera.h"
#include "hardware/simulated_robot.h"
#include "io/scene_file.h"

namespace vantage::testing {

Settings sceneSettings(const std::string& scene, const std::vector<std::string>& assignments) {
  Settings settings;
  applyScene(settings, loadScene(scene));
  for (const std::string& assignment : assignments) applyAssignment(settings, assignment);
  settings.validate();
  return settings;
}

SimulatedRun exploreScene(const std::string& name, const Settings& settings, int threads,
                          const RunObserver& observer) {
  SimulatedDepthCamera camera(loadScene(name), {settings.camera, settings.sensor, settings.exploration.seed});
  FreeFlyer robot(settings.free_flyer, initialScanPoses(settings.exploration.scan).back());
  return exploreWith(name, settings, camera, robot, threads, observer);
}

SimulatedRun exploreWith(const std::string& name, const Settings& settings, DepthCamera& camera, Robot& robot,
                         int threads, const RunObserver& observer) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  const SceneFile scene = loadScene(name);
  SimulatedRun run;
  run.truth = std::make_shared<SceneTruth>(scene);
  Explorer explorer(settings.exploration, camera, robot, run.truth.get());
  explorer.addObserver([&](const std::shared_ptr<const StepRecord>& record) {
    if (observer) observer(*record, explorer.world());
    if (record->closing) {
      if (record->stage == Stage::Done) run.closing = *record;
    } else if (record->stage == Stage::Done) {
      run.steps.push_back(*record);
    } else if (record->stage == Stage::Realised) {
      run.steps.back() = *record;
    }
  });
  run.stop_reason = explorer.run({}).stop_reason;
  return run;
}

}  // namespace vantage::testing
