// Insertion of depth images into the occupancy octree against OctoMap's own, in the same run.
#include <benchmark/benchmark.h>
#include <octomap/octomap.h>
#include <omp.h>
#include <tbb/global_control.h>

#include <numbers>

#include "core/volume/occupancy_octree.h"

namespace vantage {
namespace {

constexpr int kScans = 8;
constexpr double kVoxel_m = 0.01;

/// The rays of the hierarchical planner as an image: 57 x 43 deg, one pixel a voxel at 2.8 m.
PinholeCamera scanCamera() {
  PinholeCamera camera = cameraFromFov(279, 211, 57 * std::numbers::pi / 180);
  camera.min_range_m = 0.4;
  camera.max_range_m = 8.0;
  return camera;
}

/// A room of 3.6 x 3.6 x 2 m with a table and a ball on it, seen from a circle around the table.
struct Room {
  PinholeCamera camera = scanCamera();
  std::vector<Pose> poses;
  std::vector<DepthImage> images;

  static double boxEntry(const Eigen::Vector3d& from, const Eigen::Vector3d& d, const Box& box, bool inside) {
    double first = -1e9, last = 1e9;
    for (int a = 0; a < 3; ++a) {
      const double t0 = (box.min()[a] - from[a]) / d[a], t1 = (box.max()[a] - from[a]) / d[a];
      first = std::max(first, std::min(t0, t1));
      last = std::min(last, std::max(t0, t1));
    }
    if (inside) return last;
    return first <= last && first > 0 ? first : 1e9;
  }
  static double depth(const Eigen::Vector3d& from, const Eigen::Vector3d& d) {
    const Box walls(Eigen::Vector3d(-1.79, -1.79, 0.01), Eigen::Vector3d(1.79, 1.79, 1.99));
    const Box table(Eigen::Vector3d(-0.6, -0.6, 0.4), Eigen::Vector3d(0.6, 0.6, 0.43));
    double t = std::min(boxEntry(from, d, walls, true), boxEntry(from, d, table, false));
    const Eigen::Vector3d c = from - Eigen::Vector3d(0, 0, 0.58);
    const double b = c.dot(d), root = b * b - d.squaredNorm() * (c.squaredNorm() - 0.15 * 0.15);
    if (root > 0) t = std::min(t, (-b - std::sqrt(root)) / d.squaredNorm());
    return t;
  }
  Room() {
    for (int n = 0; n < kScans; ++n) {
      const double angle = 2 * std::numbers::pi * n / kScans;
      poses.push_back(lookAt({1.2 * std::cos(angle), 1.2 * std::sin(angle), 1.1}, {0, 0, 0.6}));
      DepthImage image(camera.width, camera.height);
      for (int v = 0; v < camera.height; ++v)
        for (int u = 0; u < camera.width; ++u)
          image.at(u, v) =
              static_cast<float>(depth(poses[n].translation(), poses[n].linear() * camera.ray(u, v)));
      images.push_back(std::move(image));
    }
  }
};

const Room& room() {
  static const Room instance;
  return instance;
}

GridGeometry roomGrid() {
  return OccupancyOctree::gridAround(Box(Eigen::Vector3d(-1.8, -1.8, 0), Eigen::Vector3d(1.8, 1.8, 2)),
                                     kVoxel_m);
}
const Box kObject(Eigen::Vector3d(-0.4, -0.4, 0.43), Eigen::Vector3d(0.4, 0.4, 0.95));

/// Arguments: threads, 1 = the seven scans after the first, 1 = the room starts free.
void ours(benchmark::State& state) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, state.range(0));
  const bool first = state.range(1) == 0;
  std::uint64_t updated = 0, marked = 0, scans = 0;
  while (state.KeepRunning()) {
    state.PauseTiming();
    OccupancyOctree map(roomGrid(), kObject, state.range(2) ? VoxelState::Free : VoxelState::Unknown, {});
    if (!first) map.insert(room().images[0], room().camera, room().poses[0]);
    state.ResumeTiming();
    for (int n = first ? 0 : 1; n < (first ? 1 : kScans); ++n, ++scans) {
      const OccupancyUpdate update = map.insert(room().images[n], room().camera, room().poses[n]);
      updated += update.updated;
      marked += update.hits + update.misses;
    }
  }
  state.counters["time_a_scan"] = benchmark::Counter(
      static_cast<double>(scans), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["voxels_updated"] = static_cast<double>(updated) / scans;
  state.counters["voxels_marked"] = static_cast<double>(marked) / scans;
}
BENCHMARK(ours)
    ->Name("vantage")
    ->ArgNames({"threads", "later", "room_free"})
    ->ArgsProduct({{1, 2}, {0, 1}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Arguments: threads, 1 = the seven scans after the first, 1 = points are reduced to voxels first.
void theirs(benchmark::State& state) {
  omp_set_num_threads(static_cast<int>(state.range(0)));
  const bool first = state.range(1) == 0;
  std::vector<octomap::Pointcloud> clouds(kScans);
  for (int n = 0; n < kScans; ++n)
    for (int v = 0; v < room().camera.height; ++v)
      for (int u = 0; u < room().camera.width; ++u) {
        const Eigen::Vector3d p = room().poses[n] * (room().camera.ray(u, v) * room().images[n].at(u, v));
        clouds[n].push_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
      }
  std::uint64_t scans = 0;
  while (state.KeepRunning()) {
    state.PauseTiming();
    octomap::OcTree tree(kVoxel_m);
    const auto insert = [&](int n) {
      const Eigen::Vector3f t = room().poses[n].translation().cast<float>();
      tree.insertPointCloud(clouds[n], octomap::point3d(t.x(), t.y(), t.z()), 2.8, true, state.range(2) != 0);
    };
    if (!first) insert(0);
    state.ResumeTiming();
    for (int n = first ? 0 : 1; n < (first ? 1 : kScans); ++n, ++scans) insert(n);
    tree.updateInnerOccupancy();
  }
  state.counters["time_a_scan"] = benchmark::Counter(
      static_cast<double>(scans), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(theirs)
    ->Name("octomap")
    ->ArgNames({"threads", "later", "discretized"})
    ->ArgsProduct({{1, 2}, {0, 1}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// The whole map brick by brick, as a state pyramid takes it over.
void readAll(benchmark::State& state) {
  OccupancyOctree map(roomGrid(), kObject, VoxelState::Free, {});
  for (int n = 0; n < kScans; ++n) map.insert(room().images[n], room().camera, room().poses[n]);
  std::vector<float> values(kBrickX * kBrickY * kBrickZ);
  for (auto _ : state)
    for (std::uint32_t b = 0; b < map.bricks().total(); ++b) {
      const BrickRange r = map.bricks().range(b);
      map.readBrick(b, std::span(values).first((r.end - r.begin).prod()));
    }
  state.counters["voxels"] = static_cast<double>(map.geometry().count());
  state.counters["nodes"] = static_cast<double>(map.nodeCount());
}
BENCHMARK(readAll)->Name("vantage/read_all")->Unit(benchmark::kMillisecond)->UseRealTime();

void build(benchmark::State& state) {
  for (auto _ : state) OccupancyOctree map(roomGrid(), kObject, VoxelState::Free, {});
}
BENCHMARK(build)->Name("vantage/build")->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace vantage
