#include "core/volume/tsdf_fusion_kernel.h"

namespace vantage::fusion {
namespace {

std::uint32_t projectRow(const Frame& frame, const Row& row, void* row_voxels, int x0, int x1,
                         std::uint8_t* brick_changed) {
  auto* voxels = static_cast<Voxel*>(row_voxels);
  std::uint32_t observed = 0;
  for (int x = x0; x < x1; ++x) {
    float value = 0.0f;
    if (!measure(frame, row, x, value)) continue;
    ++observed;
    if (observe(frame, value, voxels[x])) brick_changed[x >> 4] = 1;
  }
  return observed;
}

std::uint32_t emptyRow(const Frame& frame, const Row&, void* row_voxels, int x0, int x1,
                       std::uint8_t* brick_changed) {
  auto* voxels = static_cast<Voxel*>(row_voxels);
  for (int x = x0; x < x1; ++x)
    if (observe(frame, kFull, voxels[x])) brick_changed[x >> 4] = 1;
  return static_cast<std::uint32_t>(x1 - x0);
}

}  // namespace

Kernels portableKernels() {
  return {projectRow, emptyRow};
}

}  // namespace vantage::fusion
