#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>
#include <string>

#include "core/planners/contour_planner.h"

// Collision map, paths, and the search of one next best view on a made-up table scene in the volume of
// section 10: 34.9 M voxels, a room of free space in the middle, unknown beyond it, and twelve half-seen
// boxes.

namespace vantage {
namespace {

struct TableScene {
  StateGrid states{GridGeometry{{-1.5, -1.0, -0.05}, 3.0 / 512.0, {512, 341, 200}}};
  PinholeCamera camera;
  Box workspace{Eigen::Vector3d(-1.0, -0.66, 0.0), Eigen::Vector3d(1.0, 0.66, 1.0)};
  std::vector<ContourPoint> points;
  std::vector<std::uint32_t> labels;
  Saliency saliency;

  TableScene() {
    fill(Box(Eigen::Vector3d(-1.3, -0.98, 0.0), Eigen::Vector3d(1.3, 0.5, 1.1)), VoxelState::Free);
    fill(Box(Eigen::Vector3d(-1.3, -0.7, -0.05), Eigen::Vector3d(1.3, 0.5, 0.0)), VoxelState::Occupied);
    std::mt19937_64 random(1);
    const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    for (std::uint32_t object = 0; object < 12; ++object)
      addBox({-0.8 + 0.3 * (object % 6), object < 6 ? -0.3 : 0.2, 0.1}, unit);
    states.rebuildFreeRadius();
  }

  void fill(const Box& box, VoxelState state) {
    const GridGeometry& g = states.geometry();
    for (std::size_t n = 0; n < g.count(); ++n)
      if (box.contains(g.center(g.voxel(n)))) states.set(g.voxel(n), state);
  }

  /// Front seen, interior and a shadow behind it unknown; contour points along both rear edges.
  template <class Unit>
  void addBox(const Eigen::Vector3d& center, const Unit& unit) {
    const Eigen::Vector3d half(0.06, 0.05, 0.1);
    fill(Box(center - half, center + half + Eigen::Vector3d(0.0, 0.15, 0.0)), VoxelState::Unknown);
    fill(Box(center - half,
             Eigen::Vector3d(center.x() + half.x(), center.y() - half.y() + 0.02, center.z() + half.z())),
         VoxelState::Occupied);
    Segment segment;
    segment.label = static_cast<std::uint32_t>(saliency.segments.size() + 1);
    segment.saliency = 0.3 + 0.3 * unit();
    segment.center_m = center;
    segment.radius_m = half.norm();
    saliency.segments.push_back(segment);
    for (const double side : {-1.0, 1.0})
      for (int n = 0; n < 12; ++n) {
        const Eigen::Vector3d p =
            center + Eigen::Vector3d(side * (half.x() + 0.006), half.y(), -0.09 + 0.015 * n);
        points.push_back({p, Eigen::Vector3d(side, 0.2 * unit() - 0.1, 0.3 * unit()).normalized(), 4});
        labels.push_back(segment.label);
      }
  }
};

const TableScene& scene() {
  static const TableScene kScene;
  return kScene;
}

void BM_CollisionGrid(benchmark::State& state) {
  const TableScene& s = scene();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(CollisionGrid(s.states, 0.04, 0.08));
  state.counters["voxels"] = static_cast<double>(s.states.geometry().count());
}
BENCHMARK(BM_CollisionGrid)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Over a row of boxes, where the straight line is blocked.
void BM_PathAroundObstacles(benchmark::State& state) {
  const CollisionGrid grid(scene().states, 0.04, 0.08);
  FreeFlyerConfig config;
  std::uint64_t seed = 0;
  double iterations = 0.0, found = 0.0;
  for (auto _ : state) {
    const MotionPlan plan = planPath(grid, lookAt({-0.7, -0.55, 0.15}, {0.0, 0.0, 0.0}),
                                     lookAt({0.9, 0.0, 0.15}, {0.0, 0.0, 0.0}), config, seed++);
    iterations += plan.iterations;
    found += plan.verdict == Reachability::Reachable;
  }
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
  state.counters["found"] = benchmark::Counter(found, benchmark::Counter::kAvgIterations);
}
BENCHMARK(BM_PathAroundObstacles)->Unit(benchmark::kMillisecond);

/// Every iteration spent in vain: two rooms joined by a slit that only a point fits through.
void BM_NoPath(benchmark::State& state) {
  StateGrid states(GridGeometry{{-0.99, -0.99, 0.01}, 0.02, {100, 100, 50}});
  for (std::size_t n = 0; n < states.geometry().count(); ++n) {
    const Eigen::Vector3i v = states.geometry().voxel(n);
    const bool slit = v.y() >= 70 && v.y() < 74 && v.z() >= 30 && v.z() < 34;
    states.set(v, v.x() >= 50 && v.x() < 54 && !slit ? VoxelState::Occupied : VoxelState::Free);
  }
  const CollisionGrid points(states, 0.04), bodies(states, 0.04, 0.08);
  const CollisionGrid& grid = state.range(0) ? bodies : points;
  FreeFlyerConfig config;
  config.reach_m = 0.0;
  MotionPlan plan;
  for (auto _ : state)
    plan = planPath(grid, lookAt({-0.6, -0.6, 0.2}, {0.0, 0.0, 0.0}),
                    lookAt({0.6, -0.6, 0.2}, {0.0, 0.0, 0.0}), config, 1);
  state.counters["iterations"] = plan.iterations;
  state.SetLabel(std::string(toString(plan.verdict)));
}
BENCHMARK(BM_NoPath)->ArgName("components_of_bodies")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

/// range(0): threads, range(1): 1 = the planner, 0 = its baseline that scores every pose.
void BM_SearchView(benchmark::State& state) {
  const TableScene& s = scene();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, state.range(0));
  ContourPlannerConfig config;
  config.segment_by_segment = state.range(1) != 0;
  const std::vector<ViewPosition> positions = contourViewPositions(s.points, config.views);
  const ViewSearchInput input{.states = s.states,
                              .camera = s.camera,
                              .workspace = s.workspace,
                              .points = s.points,
                              .positions = positions,
                              .point_labels = s.labels,
                              .saliency = s.saliency,
                              .executed = {},
                              .disappointing = {}};
  const CollisionGrid grid(s.states, 0.04, 0.08);
  const Pose start = lookAt({0.0, -0.85, 0.6}, {0.0, 0.0, 0.1});
  SearchCounts counts;
  for (auto _ : state) {
    const ViewSearch search =
        searchView(input, config, [&](const Pose& pose) { return planPath(grid, start, pose, {}, 1); }, {});
    counts = search.counts;
  }
  state.counters["poses"] = static_cast<double>(counts.poses_scored);
  state.counters["rays"] = static_cast<double>(counts.rays);
  state.counters["voxels"] = static_cast<double>(counts.voxels_visited);
  state.counters["paths"] = static_cast<double>(counts.paths_planned);
}
BENCHMARK(BM_SearchView)
    ->ArgNames({"threads", "segments"})
    ->ArgsProduct({{1, 2}, {1, 0}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// range(0): points of the cloud; 1000 contour points at 1 cm from it.
void BM_AssignContourPoints(benchmark::State& state) {
  std::mt19937_64 random(5);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  SurfaceCloud cloud;
  Labels labels;
  for (std::int64_t n = 0; n < state.range(0); ++n) {
    const double x = 2.0 * unit() - 1.0, y = 1.3 * unit() - 0.65;
    cloud.points.emplace_back(x, y, 0.05 * std::sin(9.0 * x) * std::cos(7.0 * y));
    labels.of_point.push_back(static_cast<std::uint32_t>(n % 7));
  }
  std::vector<ContourPoint> points;
  for (int n = 0; n < 1000; ++n)
    points.push_back(
        {cloud.points[random() % cloud.points.size()].cast<double>() + Eigen::Vector3d(0.0, 0.0, 0.01),
         Eigen::Vector3d::UnitZ(), 1});
  for (auto _ : state) benchmark::DoNotOptimize(assignContourPoints(points, cloud, labels));
}
BENCHMARK(BM_AssignContourPoints)->Arg(200000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vantage
