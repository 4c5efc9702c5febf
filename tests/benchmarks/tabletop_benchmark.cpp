#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "core/exploration/explorer.h"
#include "core/exploration/plan_view.h"
#include "hardware/simulated_depth_camera.h"
#include "io/config_file.h"
#include "io/scene_file.h"

// One next best view on the embedded scene `tabletop` after its initial scan, from contours to the chosen
// pose: lines 1 to 17 of Algorithm 1, the sensor's fit checked and paths left out. Contour planner and
// standard baseline.

namespace vantage {
namespace {

/// The map after the initial scan.
struct Tabletop {
  Settings settings;
  TsdfVolume volume;
  StateGrid states;
  CollisionGrid collision;

  Tabletop() {
    const SceneFile scene = loadScene("tabletop");
    applyToml(settings, scene.text, scene.source_path, sceneGeometryKeys());
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
  }
};

const Tabletop& tabletop() {
  static const Tabletop scene;
  return scene;
}

void planOneView(benchmark::State& state) {
  const Tabletop& scene = tabletop();
  const bool contour = state.range(0) == 1;
  const int threads = static_cast<int>(state.range(1));
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  ContourPlannerConfig config = scene.settings.exploration.contour;
  config.segment_by_segment = contour;
  const PlanViewInput input{.volume = scene.volume,
                            .states = scene.states,
                            .camera = scene.settings.camera,
                            .workspace = scene.settings.exploration.workspace,
                            .config = config};
  const ReachPose reach = [&](const Pose& pose) {
    MotionPlan plan;
    plan.verdict = checkPosition(scene.collision, pose.translation(), scene.settings.free_flyer);
    return plan;
  };
  SearchCounts counts;
  for (auto _ : state) {
    StepRecord record;
    planView(record, input, reach, [](Stage) {}, {});
    counts = record.search->counts;
  }
  state.SetLabel(std::string("tabletop, ") + (contour ? "contour" : "standard") + ", " +
                 std::to_string(threads) + " threads");
  state.counters["poses"] = static_cast<double>(counts.poses_scored);
  state.counters["rays"] = static_cast<double>(counts.rays);
  state.counters["voxels"] = static_cast<double>(counts.voxels_visited);
}
BENCHMARK(planOneView)
    ->ArgNames({"contour", "threads"})
    ->Args({1, 1})
    ->Args({1, 2})
    ->Args({0, 2})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace vantage
