// Rays a second of the first-hit gain, plain walk against jumps, over a partially known map.
#include <benchmark/benchmark.h>

#include <numbers>

#include "core/raycasting/bundle.h"
#include "tests/benchmarks/workload.h"

namespace vantage {
namespace {

/// Casts the views in turn; reports rays and voxels visited.
template <class Cast>
void castViews(benchmark::State& state, const StateGrid& grid, const std::vector<Pose>& views, Cast cast) {
  std::uint64_t rays = 0, visited = 0, unknown = 0;
  std::size_t next = 0;
  for (auto _ : state) {
    const VisibilityCounts counts = cast(grid, views[next++ % views.size()]);
    rays += counts.rays;
    visited += counts.visited;
    unknown += counts.unknown;
  }
  const auto rate = [](std::uint64_t n) {
    return benchmark::Counter(static_cast<double>(n), benchmark::Counter::kIsRate);
  };
  state.counters["rays"] = rate(rays);
  state.counters["voxels_per_ray"] = static_cast<double>(visited) / static_cast<double>(rays);
  state.counters["unknown_share"] = static_cast<double>(unknown) / static_cast<double>(rays);
  state.SetLabel("tabletop after 30 frames, 34.9 M voxels");
}

const StateGrid& tabletopGrid() {
  static const StateGrid grid = makeStateGrid(benchmarks::scannedTabletop());
  return grid;
}

PinholeCamera cameraAt(int reduction) {
  return PinholeCamera{}.reduced(reduction);
}

void BM_GainReference(benchmark::State& state) {
  const PinholeCamera camera = cameraAt(static_cast<int>(state.range(0)));
  castViews(state, tabletopGrid(), benchmarks::tabletopViews(), [&](const StateGrid& grid, const Pose& pose) {
    return castUniformReference(grid, camera, pose, {});
  });
}
BENCHMARK(BM_GainReference)
    ->ArgName("reduction")
    ->Arg(4)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void BM_Gain(benchmark::State& state) {
  const PinholeCamera camera = cameraAt(static_cast<int>(state.range(0)));
  const std::vector<CpuPath> paths = availableCpuPaths();
  if (state.range(1) >= static_cast<int>(paths.size())) return state.SkipWithError("not on this processor");
  const CpuPath path = paths[state.range(1)];
  castViews(state, tabletopGrid(), benchmarks::tabletopViews(), [&](const StateGrid& grid, const Pose& pose) {
    return casting::castRectangle(path, grid, camera, pose, {}, {0, 0, camera.width, camera.height});
  });
}
BENCHMARK(BM_Gain)
    ->ArgNames({"reduction", "path"})
    ->ArgsProduct({{4, 1}, {0, 1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void BM_QuarterTurns(benchmark::State& state) {
  const PinholeCamera camera = cameraAt(static_cast<int>(state.range(0)));
  castViews(state, tabletopGrid(), benchmarks::tabletopViews(), [&](const StateGrid& grid, const Pose& pose) {
    const QuarterTurnCounts both = castQuarterTurns(grid, camera, pose, {});
    VisibilityCounts cast = both.upright;
    cast.rays = both.rays_cast;
    return cast;
  });
}
BENCHMARK(BM_QuarterTurns)->ArgName("reduction")->Arg(4)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace vantage
