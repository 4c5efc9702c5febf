#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "core/exploration/plan_view.h"
#include "tests/benchmarks/tabletop_map.h"

// One next best view on the embedded scene `tabletop` after its initial scan, from contours to the chosen
// pose: lines 1 to 17 of Algorithm 1, the sensor's fit checked and paths left out. Contour planner and
// standard baseline.

namespace vantage {
namespace {

void planOneView(benchmark::State& state) {
  const benchmarks::TabletopMap& scene = benchmarks::tabletopMap();
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
