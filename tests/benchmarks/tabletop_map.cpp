#include "tests/benchmarks/tabletop_map.h"

#include "core/exploration/explorer.h"
#include "hardware/simulated_depth_camera.h"
#include "io/scene_file.h"

namespace vantage::benchmarks {

TabletopMap::TabletopMap() {
  const SceneFile scene = loadScene("tabletop");
  applyScene(settings, scene);
  const ExplorationConfig& config = settings.exploration;
  SimulatedDepthCamera camera(scene, {settings.camera, settings.sensor, config.seed});
  volume = TsdfVolume(config.volume);
  std::uint64_t index = 0;
  for (const Pose& pose : initialScanPoses(config.scan)) {
    clearSphere(volume, pose.translation(), config.scan.clear_radius_m);
    fuseDepth(volume, camera.capture(pose, index++)->depth, camera.model(), pose, config.fusion);
  }
  states = makeStateGrid(volume);
  collision = CollisionGrid(states, settings.free_flyer.cell_m, settings.free_flyer.body_radius_m);
  motion = FreeFlyerPlanner(settings.free_flyer);
  motion.observe(states);
}

const TabletopMap& tabletopMap() {
  static const TabletopMap map;
  return map;
}

}  // namespace vantage::benchmarks
