#pragma once

#include "core/volume/cpu_path.h"
#include "core/volume/tsdf_volume.h"

namespace vantage::fusion {

/// fuseDepth() on a chosen path; for tests and benchmarks.
FusionResult fuseDepthOn(CpuPath path, TsdfVolume& volume, const DepthImage& depth,
                         const PinholeCamera& camera, const Pose& T_world_camera, const FusionConfig& config);

}  // namespace vantage::fusion
