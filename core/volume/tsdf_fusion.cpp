#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "core/geometry/check.h"
#include "core/volume/fusion_paths.h"
#include "core/volume/prepared_frame.h"
#include "core/volume/tsdf_volume.h"

namespace vantage {

void FusionConfig::validate(double voxel_size_m) const {
  requireInRange("fusion.truncation_m", truncation_m, 2.1 * voxel_size_m * (1 - 1e-12), 1e3);
  requireInRange("fusion.max_weight", max_weight, 1, 60000);
  requireInRange("fusion.observations_per_frame", observations_per_frame, 1, max_weight);
}

namespace fusion {
namespace {

Kernels kernelsFor(CpuPath path) {
#ifdef VANTAGE_X86_KERNELS
  if (path == CpuPath::Avx512) return avx512Kernels();
  if (path == CpuPath::Avx2) return avx2Kernels();
#endif
  static_cast<void>(path);
  return portableKernels();
}

/// Fuses one row of bricks; returns the voxels observed.
std::uint64_t fuseBrickRow(TsdfVolume& volume, const PreparedFrame& prepared, const Kernels& kernels,
                           std::uint32_t first_brick, std::uint8_t* changed) {
  const BrickLayout& bricks = volume.bricks();
  const BrickRange box = bricks.range(first_brick);
  const int end = bricks.grid.x();
  std::vector<Sight> sights(bricks.count.x());
  prepared.lookAt(box.begin.y(), box.end.y(), box.begin.z(), box.end.z(), end, sights);
  if (std::all_of(sights.begin(), sights.end(), [](Sight s) { return s == Sight::Hidden; })) return 0;
  std::uint64_t observed = 0;
  for (int z = box.begin.z(); z < box.end.z(); ++z)
    for (int y = box.begin.y(); y < box.end.y(); ++y) {
      const Row row = prepared.row(y, z);
      TsdfVoxel* voxels = &volume.at(0, y, z);
      for (std::size_t b = 0, next = 0; b < sights.size(); b = next) {
        for (next = b + 1; next < sights.size() && sights[next] == sights[b];) ++next;
        if (sights[b] == Sight::Hidden) continue;
        const RowKernel kernel = sights[b] == Sight::Empty ? kernels.empty : kernels.project;
        observed += kernel(prepared.frame(), row, voxels, static_cast<int>(b) * kBrickX,
                           std::min(static_cast<int>(next) * kBrickX, end), changed);
      }
    }
  return observed;
}

}  // namespace

FusionResult fuseDepthOn(CpuPath path, TsdfVolume& volume, const DepthImage& depth,
                         const PinholeCamera& camera, const Pose& T_world_camera,
                         const FusionConfig& config) {
  PreparedFrame prepared(volume, depth, camera, T_world_camera, config);
  prepared.buildTiles();
  const Kernels kernels = kernelsFor(path);
  const Eigen::Vector3i count = volume.bricks().count;
  FusionResult result;
  result.changed = BrickSet(volume.bricks().total());
  std::vector<std::uint64_t> observed(static_cast<std::size_t>(count.y()) * count.z(), 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, observed.size()), [&](const auto& rows) {
    for (std::size_t r = rows.begin(); r < rows.end(); ++r) {
      const auto first = static_cast<std::uint32_t>(r * count.x());
      observed[r] = fuseBrickRow(volume, prepared, kernels, first, result.changed.flags().data() + first);
    }
  });
  result.voxels_updated = std::accumulate(observed.begin(), observed.end(), std::uint64_t{0});
  return result;
}

}  // namespace fusion

FusionResult fuseDepth(TsdfVolume& volume, const DepthImage& depth, const PinholeCamera& camera,
                       const Pose& T_world_camera, const FusionConfig& config) {
  return fusion::fuseDepthOn(bestCpuPath(), volume, depth, camera, T_world_camera, config);
}

FusionResult fuseDepthReference(TsdfVolume& volume, const DepthImage& depth, const PinholeCamera& camera,
                                const Pose& T_world_camera, const FusionConfig& config) {
  const fusion::PreparedFrame prepared(volume, depth, camera, T_world_camera, config);
  const Eigen::Vector3i size = volume.geometry().size;
  FusionResult result;
  result.changed = BrickSet(volume.bricks().total());
  for (int z = 0; z < size.z(); ++z)
    for (int y = 0; y < size.y(); ++y) {
      const fusion::Row row = prepared.row(y, z);
      for (int x = 0; x < size.x(); ++x) {
        float value = 0.0f;
        if (!fusion::measure(prepared.frame(), row, x, value)) continue;
        TsdfVoxel& voxel = volume.at(x, y, z);
        fusion::Voxel next{voxel.value, voxel.weight};
        if (fusion::observe(prepared.frame(), value, next))
          result.changed.insert(volume.bricks().brickOf({x, y, z}));
        voxel = {next.value, next.weight};
        ++result.voxels_updated;
      }
    }
  return result;
}

}  // namespace vantage
