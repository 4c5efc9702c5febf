// Fusion of one 512 x 424 frame into the volumes W1 and S1, and the update of the state grid that follows.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "core/volume/fusion_paths.h"
#include "core/volume/state_grid.h"
#include "tests/benchmarks/workload.h"

namespace vantage {
namespace {

struct Frames {
  PinholeCamera camera;
  std::vector<Pose> poses;
  std::vector<DepthImage> depths;
};

const Frames& frames() {
  static const Frames all = [] {
    Frames f;
    f.poses = benchmarks::scanPoses(30);
    for (const Pose& pose : benchmarks::tabletopViews()) f.poses.push_back(pose);
    for (const Pose& pose : f.poses) f.depths.push_back(benchmarks::tabletopDepth(f.camera, pose));
    return f;
  }();
  return all;
}

GridGeometry gridOf(std::int64_t which) {
  return which == 0 ? benchmarks::w1Geometry() : benchmarks::tabletopGeometry();
}

const char* labelOf(std::int64_t which) {
  return which == 0 ? "tabletop, W1: 16.3 M voxels of 5.8 mm" : "tabletop, S1: 34.9 M voxels of 5.86 mm";
}

template <class Fuse>
void fuseFrames(benchmark::State& state, Fuse fuse) {
  const Frames& f = frames();
  TsdfVolume volume(gridOf(state.range(0)));
  std::size_t next = 0;
  std::uint64_t updated = 0;
  for (auto _ : state) {
    const std::size_t n = next++ % f.poses.size();
    updated += fuse(volume, f.depths[n], f.camera, f.poses[n]).voxels_updated;
  }
  state.counters["voxels_a_frame"] = static_cast<double>(updated) / static_cast<double>(state.iterations());
  state.SetLabel(labelOf(state.range(0)));
}

void BM_FuseReference(benchmark::State& state) {
  fuseFrames(state, [](TsdfVolume& volume, const DepthImage& depth, const PinholeCamera& camera,
                       const Pose& pose) { return fuseDepthReference(volume, depth, camera, pose, {}); });
}
BENCHMARK(BM_FuseReference)->ArgName("S1")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_Fuse(benchmark::State& state) {
  const std::vector<CpuPath> paths = availableCpuPaths();
  if (state.range(2) >= static_cast<int>(paths.size())) return state.SkipWithError("not on this processor");
  const CpuPath path = paths[state.range(2)];
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, state.range(1));
  fuseFrames(state,
             [=](TsdfVolume& volume, const DepthImage& depth, const PinholeCamera& camera, const Pose& pose) {
               return fusion::fuseDepthOn(path, volume, depth, camera, pose, {});
             });
}
BENCHMARK(BM_Fuse)
    ->ArgNames({"S1", "threads", "path"})
    ->ArgsProduct({{0, 1}, {1, 2}, {0, 1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void BM_MakeStateGrid(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, state.range(0));
  const TsdfVolume& volume = benchmarks::scannedTabletop();
  for (auto _ : state) benchmark::DoNotOptimize(makeStateGrid(volume));
  state.SetLabel(labelOf(1));
}
BENCHMARK(BM_MakeStateGrid)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_RebuildFreeRadius(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, state.range(0));
  StateGrid grid = makeStateGrid(benchmarks::scannedTabletop());
  for (auto _ : state) grid.rebuildFreeRadius();
  state.SetLabel(labelOf(1));
}
BENCHMARK(BM_RebuildFreeRadius)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// The update after one stop of 15 frames at a new view.
void BM_UpdateStateGrid(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, state.range(0));
  const Frames& f = frames();
  const StateGrid before = makeStateGrid(benchmarks::scannedTabletop());
  TsdfVolume volume = benchmarks::scannedTabletop();
  FusionConfig config;
  config.observations_per_frame = 15;
  const FusionResult fused = fuseDepth(volume, f.depths[40], f.camera, f.poses[40], config);
  for (auto _ : state) {
    state.PauseTiming();
    StateGrid grid = before;
    state.ResumeTiming();
    grid.update(volume, fused.changed);
  }
  state.counters["bricks"] = static_cast<double>(fused.changed.list().size());
  state.SetLabel(labelOf(1));
}
BENCHMARK(BM_UpdateStateGrid)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace vantage
