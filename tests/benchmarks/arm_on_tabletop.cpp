#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "core/exploration/plan_view.h"
#include "hardware/simulated_arm.h"
#include "hardware/simulated_depth_camera.h"
#include "io/robot_file.h"
#include "io/scene_file.h"

// Motions of an arm on the embedded scene `tabletop` after the arm's initial scan: from where it then stands
// to every view that the contour planner would take, best first, were none of them reachable. One thread.

namespace vantage {
namespace {

struct ScannedByArm {
  explicit ScannedByArm(const std::string& robot) {
    const SceneFile scene = loadScene("tabletop");
    applyScene(settings, scene);
    const ExplorationConfig& config = settings.exploration;
    arm = startedArm(loadRobot(robot), settings);
    SimulatedDepthCamera camera(scene, {settings.camera, settings.sensor, config.seed});
    SimulatedHandCamera hand(camera, *arm);
    volume = TsdfVolume(config.volume);
    std::uint64_t index = 0;
    for (const Pose& pose : arm->startPoses()) {
      arm->adjust(pose, {});
      const Pose here = arm->state().T_world_camera;
      clearSphere(volume, here.translation(), config.scan.clear_radius_m);
      fuseDepth(volume, hand.capture(here, index++)->depth, hand.model(), here, config.fusion);
    }
    states = makeStateGrid(volume);
    arm->observe(states);
  }

  /// Views above the threshold, in the order in which the planner asks for a motion to them.
  std::vector<Pose> wantedViews() const {
    std::vector<Pose> views;
    StepRecord record;
    planView(
        record,
        {.volume = volume,
         .states = states,
         .camera = settings.camera,
         .workspace = settings.exploration.workspace,
         .config = settings.exploration.contour},
        [&](const Pose& view) {
          views.push_back(view);
          MotionPlan none;
          none.verdict = Reachability::NoPath;
          return none;
        },
        [](Stage) {}, {});
    return views;
  }

  Settings settings;
  std::unique_ptr<SimulatedArm> arm;
  TsdfVolume volume;
  StateGrid states;
};

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

void BM_ArmOnTabletop(benchmark::State& state, const std::string& robot) {
  const ScannedByArm scanned(robot);
  const std::vector<Pose> views = scanned.wantedViews();
  const RobotState from = scanned.arm->state();
  std::map<Reachability, int> verdicts;
  std::vector<double> reached_ms, barred_ms;
  int straight = 0;
  for (auto _ : state)
    for (std::size_t n = 0; n < views.size(); ++n) {
      const auto begin = std::chrono::steady_clock::now();
      const MotionPlan plan = scanned.arm->planner().plan(from, views[n], pathSeed(1, 1, n));
      const double ms =
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
      ++verdicts[plan.verdict];
      straight += plan.straight && plan.verdict == Reachability::Reachable;
      (plan.verdict == Reachability::Reachable ? reached_ms : barred_ms).push_back(ms);
    }
  state.SetLabel("tabletop, " + robot);
  state.counters["views"] = static_cast<double>(views.size());
  for (const auto& [verdict, count] : verdicts) state.counters[std::string(tokenOf(verdict))] = count;
  state.counters["straight"] = straight;
  state.counters["median_ms"] = quantile(reached_ms, 0.5);
  state.counters["p95_ms"] = quantile(reached_ms, 0.95);
  state.counters["max_ms"] = quantile(reached_ms, 1.0);
  state.counters["barred_median_ms"] = quantile(barred_ms, 0.5);
  state.counters["barred_max_ms"] = quantile(barred_ms, 1.0);
}
BENCHMARK_CAPTURE(BM_ArmOnTabletop, smart_six, "smart_six")->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_ArmOnTabletop, ur5, "ur5")->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vantage
