// Perception on a half-observed tabletop in the mapped volume of scene S1: 512x341x200 voxels of 5.86 mm, a
// table, a back panel and eight boxes seen from -y and above. Argument: threads.

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/perception/contours.h"
#include "core/perception/depth_filters.h"
#include "core/perception/saliency.h"
#include "core/perception/segmentation.h"
#include "core/perception/surface_cloud.h"

namespace {

using namespace vantage;

double boxDistance(const Eigen::Vector3d& p, const Eigen::Vector3d& center, const Eigen::Vector3d& half) {
  const Eigen::Vector3d d = (p - center).cwiseAbs() - half;
  return d.cwiseMax(0.0).norm() + std::min(d.maxCoeff(), 0.0);
}

double sceneDistance(const Eigen::Vector3d& p) {
  double distance = boxDistance(p, {0, 0, -0.05}, {1.0, 0.66, 0.05});
  distance = std::min(distance, boxDistance(p, {0, 0.6, 0.4}, {1.0, 0.02, 0.4}));
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d center(-0.7 + 0.2 * i, -0.2 + 0.1 * (i % 3), 0.08);
    distance = std::min(distance, boxDistance(p, center, {0.05, 0.06, 0.08}));
  }
  return distance;
}

/// Space behind surfaces, as seen from -y and 45 deg above, stays unknown.
bool shadowed(const Eigen::Vector3d& p) {
  const Eigen::Vector3d toward_sensor = Eigen::Vector3d(0, -1, 1).normalized();
  Eigen::Vector3d q = p;
  for (int step = 0; step < 60; ++step) {
    const double distance = sceneDistance(q);
    if (distance < -0.003 && step > 0) return true;
    if (q.z() > 0.9) return false;
    q += std::max(0.006, std::abs(distance)) * toward_sensor;
  }
  return false;
}

const TsdfVolume& tabletop() {
  static const TsdfVolume volume = [] {
    GridGeometry geometry;
    geometry.origin_m = {-1.5, -1.0, -0.05};
    geometry.voxel_size_m = 3.0 / 512;
    geometry.size = {512, 341, 200};
    TsdfVolume v(geometry);
    tbb::parallel_for(0, geometry.size.z(), [&](int k) {
      for (int j = 0; j < geometry.size.y(); ++j)
        for (int i = 0; i < geometry.size.x(); ++i) {
          const Eigen::Vector3d p = geometry.center({i, j, k});
          const double distance = sceneDistance(p);
          if (distance < -0.03 || (distance < 0.3 && shadowed(p) && distance > 0.0) ||
              shadowed(p + Eigen::Vector3d(0, -0.02, 0.02)))
            continue;
          v.at(i, j, k).value =
              static_cast<std::int16_t>(std::lround(32767 * std::clamp(distance / 0.03, -1.0, 1.0)));
          v.at(i, j, k).weight = 30;
        }
    });
    return v;
  }();
  return volume;
}

const SurfaceCloud& cloud() {
  static const SurfaceCloud surface = extractSurface(tabletop(), 5);
  return surface;
}

const Labels& labels() {
  static const Labels segments = segmentSurface(cloud(), {});
  return segments;
}

void contours(benchmark::State& state) {
  tabletop();
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, state.range(0));
  Contours found;
  for (auto _ : state) benchmark::DoNotOptimize(found = extractContours(tabletop(), {}));
  state.counters["voxels"] = static_cast<double>(tabletop().geometry().count());
  state.counters["contour_voxels"] = static_cast<double>(found.voxels.size());
  state.counters["points"] = static_cast<double>(found.points.size());
}

void surface(benchmark::State& state) {
  tabletop();
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(extractSurface(tabletop(), 5));
  state.counters["points"] = static_cast<double>(cloud().points.size());
  state.counters["triangles"] = static_cast<double>(cloud().triangles.size());
}

void segmentation(benchmark::State& state) {
  cloud();
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(segmentSurface(cloud(), {}));
  state.counters["points"] = static_cast<double>(cloud().points.size());
  state.counters["supervoxels"] = labels().supervoxels;
  state.counters["segments"] = labels().count;
}

void saliency(benchmark::State& state) {
  labels();
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(computeSaliency(cloud(), labels(), {}));
  state.counters["points"] = static_cast<double>(cloud().points.size());
  state.counters["segments"] = labels().count;
}

void rescore(benchmark::State& state) {
  const Saliency kept = computeSaliency(cloud(), labels(), {});
  for (auto _ : state) benchmark::DoNotOptimize(rescoreSegments(kept, labels(), {}));
}

/// A frame of 512x424: the same boxes before a wall, with noise and holes. Second argument: filters.
enum FilterChoice { ShadowAndVeil, WithEdges, Paper };

DepthImage noisyDepth() {
  DepthImage depth(512, 424);
  std::uint32_t state = 12345;
  for (int v = 0; v < depth.height; ++v)
    for (int u = 0; u < depth.width; ++u) {
      state = state * 1664525u + 1013904223u;
      const float noise = 0.004f * static_cast<float>(state >> 8) / 16777216.0f;
      const bool box = (u / 40) % 2 == 0 && v > 150 && v < 330;
      if (state % 50 != 0) depth.at(u, v) = (box ? 1.0f : 2.5f) + noise;
    }
  return depth;
}

void depthFilters(benchmark::State& state) {
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, state.range(0));
  DepthFilterConfig config;
  config.shadow = config.veil = true;
  config.edge_aware = state.range(1) == WithEdges;
  config.bilateral = state.range(1) == Paper;
  const DepthImage depth = noisyDepth();
  FilteredDepth filtered;
  for (auto _ : state) benchmark::DoNotOptimize(filtered = filterDepth(depth, {}, config));
  state.counters["removed"] = static_cast<double>(countMask(filtered.mask).removed());
}
BENCHMARK(depthFilters)
    ->ArgNames({"threads", "edges1_paper2"})
    ->ArgsProduct({{1, 2}, {ShadowAndVeil, WithEdges, Paper}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

BENCHMARK(contours)->Arg(1)->Arg(2)->ArgName("threads")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(surface)->Arg(1)->Arg(2)->ArgName("threads")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(segmentation)->Arg(1)->Arg(2)->ArgName("threads")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(saliency)->Arg(1)->Arg(2)->ArgName("threads")->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(rescore)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
