#include "viewer/app/experiments/b2_first_step.h"

#include <utility>

#include "core/exploration/explorer.h"
#include "hardware/simulated_depth_camera.h"
#include "hardware/simulated_robot.h"
#include "io/scene_truth.h"

namespace vantage::experiments {
namespace {

/// What the first scan made of an unknown volume.
TsdfVolume volumeOf(const StepRecord& record, const GridGeometry& geometry) {
  TsdfVolume volume(geometry);
  for (const TsdfBrick& brick : *record.changed_bricks) volume.setBrick(brick.brick, brick.voxels);
  return volume;
}

}  // namespace

FirstStep firstStep(const ExperimentOptions& options, const std::vector<std::string>& changes) {
  const RunOf run{.scene = "tabletop", .settings = changes};
  const SceneFile scene = sceneOf(run);
  Settings settings = settingsOf(run, scene, options.tune);
  ExplorationConfig& config = settings.exploration;
  config.steps = 1;
  SimulatedDepthCamera camera(scene, {settings.camera, settings.sensor, config.seed});
  FreeFlyer robot(settings.free_flyer, initialScanPoses(config.scan).back());
  const SceneTruth truth(scene);
  Explorer explorer(config, camera, robot, &truth);
  FirstStep first;
  explorer.addObserver([&](const std::shared_ptr<const StepRecord>& record) {
    if (record->stage == Stage::Done && !record->closing) first.record = record;
  });
  explorer.run(options.control);
  options.control.check();
  first.header.input = run.scene;
  first.header.camera = camera.model();
  first.header.volume = config.volume;
  first.header.workspace = config.workspace;
  first.header.contour_config = config.contour;
  first.volume = volumeOf(*first.record, config.volume);
  first.states = makeStateGrid(first.volume);
  first.rows = SegmentObjects(*first.record, truth, SceneRays(meshOfOthers(scene))).rows();
  return first;
}

}  // namespace vantage::experiments
