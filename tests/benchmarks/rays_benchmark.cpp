// Hierarchical against uniform ray tracing in the reference room, uniform ray tracing against OctoMap's
// castRay, and the pyramid that both read. Compared times alternate within a case, so that load meets both;
// the time of a view is the median of the rounds.
#include <benchmark/benchmark.h>
#include <octomap/OcTree.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "core/raycasting/hierarchical_view.h"
#include "core/views/sphere_views.h"
#include "tests/support/reference_room.h"

namespace vantage {
namespace {

using testing::ReferenceRoom;

constexpr int kLevels = 4;

/// The room at a scale, with the paper's box of 0.8 m times the scale, or a box 5 cm about the object.
struct Scene {
  ReferenceRoom room;
  StatePyramid pyramid;
  RayTree tree{RaySensor{}, 0.01, kLevels};
  HierarchicalQuery query;

  Scene(double scale, testing::RoomBox box)
      : room(testing::makeReferenceRoom(scale, box)), pyramid(room.grid, Eigen::Vector3i::Zero(), kLevels) {
    query.bounds = room.object_box;
  }
};

const Scene& sceneOf(int percent, bool tight) {
  static std::map<std::pair<int, bool>, Scene> scenes;
  const auto [at, added] = scenes.try_emplace({percent, tight}, percent / 100.0,
                                              tight ? testing::RoomBox::Tight : testing::RoomBox::Paper);
  return at->second;
}

using Cast = std::function<RayCounts(const Pose&)>;

/// What a tracer does and needs over all views of a room.
struct Tally {
  std::vector<std::vector<double>> seconds;  ///< by view, one a round
  double visited = 0, hidden_visited = 0, rays_cast = 0, finest = 0;

  explicit Tally(const ReferenceRoom& room) : seconds(room.views.size()) {}

  /// One round: every view once.
  void add(const ReferenceRoom& room, const Cast& cast) {
    visited = hidden_visited = rays_cast = finest = 0;
    for (std::size_t n = 0; n < room.views.size(); ++n) {
      const auto begin = std::chrono::steady_clock::now();
      const RayCounts counts = cast(room.views[n].T_world_camera);
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
      seconds[n].push_back(time.count());
      visited += static_cast<double>(counts.visited);
      rays_cast += static_cast<double>(counts.rays_cast);
      finest += static_cast<double>(counts.finest_rays_cast);
      if (room.views[n].hidden) hidden_visited += static_cast<double>(counts.visited);
    }
  }
  static double median(std::vector<double> times) {
    std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
    return times[times.size() / 2];
  }
  double total(const ReferenceRoom& room, bool hidden_alone) const {
    double sum = 0;
    for (std::size_t n = 0; n < seconds.size(); ++n)
      if (!hidden_alone || room.views[n].hidden) sum += median(seconds[n]);
    return sum;
  }
};

/// Alternates both tracers over the views; reports the first in shares of the second.
void compare(benchmark::State& state, const ReferenceRoom& room, const Cast& cast, const Cast& uniform,
             int rounds) {
  Tally mine(room), whole(room);
  for (auto _ : state) {
    for (int n = 0; n < rounds; ++n) {
      whole.add(room, uniform);
      mine.add(room, cast);
    }
    state.SetIterationTime(mine.total(room, false));
  }
  const auto views = static_cast<double>(room.views.size());
  state.counters["view_us"] = mine.total(room, false) / views * 1e6;
  state.counters["rays"] = mine.rays_cast / views;
  state.counters["visits"] = mine.visited / views;
  state.counters["finest%"] = 100 * mine.finest / whole.finest;
  state.counters["visits%"] = 100 * mine.visited / whole.visited;
  state.counters["time%"] = 100 * mine.total(room, false) / whole.total(room, false);
  state.counters["hidden_visits%"] = 100 * mine.hidden_visited / whole.hidden_visited;
  state.counters["hidden_time%"] = 100 * mine.total(room, true) / whole.total(room, true);
}

void BM_Hierarchical(benchmark::State& state) {
  const Scene& scene = sceneOf(static_cast<int>(state.range(0)), state.range(1) != 0);
  const int m = static_cast<int>(state.range(2));
  HierarchicalQuery query = scene.query;
  query.start = state.range(3) ? ChildStart::Restart : ChildStart::Resume;
  compare(
      state, scene.room,
      [&](const Pose& pose) { return castHierarchical(scene.pyramid, scene.tree, m, pose, query); },
      [&](const Pose& pose) { return castUniformRays(scene.room.grid, scene.tree, pose, query); }, 5);
}
BENCHMARK(BM_Hierarchical)
    ->ArgNames({"percent", "tight", "m", "restart"})
    ->ArgsProduct({{100}, {0}, {0, 1, 2, 3, 4}, {0, 1}})
    ->ArgsProduct({{43, 75}, {1}, {1, 2, 3, 4}, {0}})  // objects of 0.20 and 0.35 m
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->UseManualTime();

/// Every eighth view of a room.
ReferenceRoom thinned(const ReferenceRoom& room) {
  ReferenceRoom some;
  for (std::size_t n = 0; n < room.views.size(); n += 8) some.views.push_back(room.views[n]);
  return some;
}

/// Both voxel by voxel, as the specification's figures were taken.
void BM_Plain(benchmark::State& state) {
  const bool tight = state.range(0) != 0;
  const Scene& scene = sceneOf(tight ? 75 : 100, tight);
  const int m = static_cast<int>(state.range(1));
  const auto cast = [&](int levels) {
    return [&scene, levels](const Pose& pose) {
      return castHierarchicalReference(scene.pyramid, scene.tree, levels, pose, scene.query);
    };
  };
  compare(state, thinned(scene.room), cast(m), cast(0), 5);
}
BENCHMARK(BM_Plain)
    ->ArgNames({"tight", "m"})
    ->ArgsProduct({{0, 1}, {1, 2, 3, 4}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->UseManualTime();

/// A map of the room: what its grid holds, at the clamping values.
const OccupancyOctree& roomMap() {
  static const OccupancyOctree map = [] {
    const ReferenceRoom& room = sceneOf(75, true).room;
    OccupancyOctree octree(room.grid.geometry(), room.object_box, VoxelState::Free, {});
    for (std::uint32_t b = 0; b < octree.bricks().total(); ++b) {
      const BrickRange r = octree.bricks().range(b);
      std::vector<float> values(static_cast<std::size_t>((r.end - r.begin).prod()));
      octree.readBrick(b, values);
      auto value = values.begin();
      bool changed = false;
      for (int k = r.begin.z(); k < r.end.z(); ++k)
        for (int j = r.begin.y(); j < r.end.y(); ++j)
          for (int i = r.begin.x(); i < r.end.x(); ++i, ++value) {
            const VoxelState label = room.grid.at(i, j, k);
            if (occupancyLabel(*value, octree.config()) == label) continue;
            *value = label == VoxelState::Occupied ? 3.5f : label == VoxelState::Free ? -2.0f : 0.0f;
            changed = true;
          }
      if (changed) octree.setBrick(b, values);
    }
    return octree;
  }();
  return map;
}

/// The same map as OctoMap holds it: unknown voxels are not stored.
const octomap::OcTree& octomapRoom() {
  static const std::unique_ptr<octomap::OcTree> tree = [] {
    std::stringstream stream;
    roomMap().write(stream, OccupancyOctree::Format::Bt);
    auto read = std::make_unique<octomap::OcTree>(0.01);
    read->readBinary(stream);
    return read;
  }();
  return *tree;
}

/// First voxels of some pixels of a view by OctoMap; \return those it found occupied
int castByOctomap(const PinholeCamera& camera, const Pose& pose, int stride, std::int64_t& rays) {
  const octomap::OcTree& tree = octomapRoom();
  const Eigen::Vector3d o = pose.translation();
  const octomap::point3d origin(static_cast<float>(o.x()), static_cast<float>(o.y()),
                                static_cast<float>(o.z()));
  int occupied = 0;
  for (int v = stride / 2; v < camera.height; v += stride)
    for (int u = stride / 2; u < camera.width; u += stride, ++rays) {
      const Eigen::Vector3f d = (pose.linear() * camera.ray(u, v)).cast<float>();
      octomap::point3d end;
      occupied += tree.castRay(origin, {d.x(), d.y(), d.z()}, end, false, camera.max_range_m);
    }
  return occupied;
}

/// 640 x 480 rays a view, one thread: every view by our caster, some pixels of some views by OctoMap.
void BM_UniformAgainstOctomap(benchmark::State& state) {
  const ReferenceRoom& room = sceneOf(75, true).room;
  const RaySensor sensor;
  PinholeCamera camera;
  camera.width = 640;
  camera.height = 480;
  camera.cx = 319.5;
  camera.cy = 239.5;
  camera.fx = 320 / std::tan(sensor.horizontal_fov_rad / 2);
  camera.fy = 240 / std::tan(sensor.vertical_fov_rad / 2);
  camera.min_range_m = sensor.min_range_m;
  camera.max_range_m = sensor.max_range_m;
  const std::vector<CpuPath> paths = availableCpuPaths();
  if (state.range(0) >= static_cast<int>(paths.size())) return state.SkipWithError("not on this processor");
  const CpuPath path = paths[state.range(0)];
  octomapRoom();
  std::int64_t rays = 0, octomap_rays = 0;
  double seconds = 0, octomap_seconds = 0, visited = 0;
  const auto now = [] { return std::chrono::steady_clock::now(); };
  for (auto _ : state) {
    for (std::size_t n = 0; n < room.views.size(); n += 8) {
      const Pose& pose = room.views[n].T_world_camera;
      const auto begin = now();
      const VisibilityCounts counts =
          casting::castRectangle(path, room.grid, camera, pose, {}, {0, 0, camera.width, camera.height});
      const auto middle = now();
      benchmark::DoNotOptimize(castByOctomap(camera, pose, 20, octomap_rays));
      seconds += std::chrono::duration<double>(middle - begin).count();
      octomap_seconds += std::chrono::duration<double>(now() - middle).count();
      rays += static_cast<std::int64_t>(counts.rays);
      visited += static_cast<double>(counts.visited);
    }
    state.SetIterationTime(seconds);
  }
  state.counters["Mrays/s"] = static_cast<double>(rays) / seconds * 1e-6;
  state.counters["octomap_Mrays/s"] = static_cast<double>(octomap_rays) / octomap_seconds * 1e-6;
  state.counters["times_octomap"] =
      static_cast<double>(rays) / seconds / (static_cast<double>(octomap_rays) / octomap_seconds);
  state.counters["visits_per_ray"] = visited / static_cast<double>(rays);
}
BENCHMARK(BM_UniformAgainstOctomap)
    ->ArgName("path")
    ->DenseRange(0, 2)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->UseManualTime();

/// 1500 views drawn uniformly in the room.
void BM_WorkspaceViews(benchmark::State& state) {
  const Scene& scene = sceneOf(75, true);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, state.range(0));
  const int m = static_cast<int>(state.range(1));
  const std::vector<ViewCandidate> views = workspaceViews(scene.room.grid.geometry().bounds(), 1500, 1);
  std::vector<RayCounts> counts(views.size());
  for (auto _ : state)
    tbb::parallel_for(std::size_t{0}, views.size(), [&](std::size_t n) {
      counts[n] = castHierarchical(scene.pyramid, scene.tree, m, views[n].T_world_camera, scene.query);
    });
  state.counters["seeing"] = static_cast<double>(
      std::count_if(counts.begin(), counts.end(), [](const RayCounts& c) { return c.unknown > 0; }));
}
BENCHMARK(BM_WorkspaceViews)
    ->ArgNames({"threads", "m"})
    ->ArgsProduct({{1, 2}, {0, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void BM_PyramidOfMap(benchmark::State& state) {
  const OccupancyOctree& map = roomMap();
  for (auto _ : state) benchmark::DoNotOptimize(StatePyramid(map, kLevels));
  state.SetLabel("360 x 360 x 200");
}
BENCHMARK(BM_PyramidOfMap)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_PyramidOfGrid(benchmark::State& state) {
  const StateGrid& grid = sceneOf(75, true).room.grid;
  for (auto _ : state) benchmark::DoNotOptimize(StatePyramid(grid, Eigen::Vector3i::Zero(), kLevels));
  state.SetLabel("360 x 360 x 200, with a copy of the finest level");
}
BENCHMARK(BM_PyramidOfGrid)->Unit(benchmark::kMillisecond)->UseRealTime();

/// A cube of bricks in the middle of the room changes to and fro.
void BM_PyramidUpdate(benchmark::State& state) {
  static OccupancyOctree map(roomMap().geometry(), roomMap().objectBox(), VoxelState::Free, {});
  static StatePyramid pyramid(map, kLevels);
  const int edge = static_cast<int>(state.range(0));
  BrickSet changed(map.bricks().total());
  std::uint64_t bricks = 0;
  float value = 3.5f;
  for (auto _ : state) {
    state.PauseTiming();
    value = value > 0 ? -2.0f : 3.5f;
    bricks = 0;
    for (int z = 0; z < edge; ++z)
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x, ++bricks) {
          const Eigen::Vector3i voxel(kBrickX * (4 + x), kBrickY * (10 + y), kBrickZ * (8 + z));
          map.set(voxel, value);
          changed.insert(map.bricks().brickOf(voxel));
        }
    state.ResumeTiming();
    pyramid.update(map, changed);
  }
  state.counters["bricks"] = static_cast<double>(bricks);
}
BENCHMARK(BM_PyramidUpdate)
    ->ArgName("edge")
    ->Arg(3)
    ->Arg(6)
    ->Arg(10)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace vantage
