#pragma once

#include <vector>

#include "core/volume/tsdf_volume.h"

namespace vantage::benchmarks {

/// Table, boxes, a ball and a back panel in a closed room, seen by the contour planner's camera.
DepthImage tabletopDepth(const PinholeCamera& camera, const Pose& T_world_camera);

/// The mapped volume of the contour planner's scene: 512 x 341 x 200 voxels of 3/512 m, 34.9 M.
GridGeometry tabletopGeometry();
/// Work item W1: 345 x 228 x 207 voxels of 5.8 mm, 16.3 M.
GridGeometry w1Geometry();

/// Poses of the initial scan: an arc of 0.6 m at 1 m from the scene's centre.
std::vector<Pose> scanPoses(int count);

/// The tabletop volume after an initial scan of 30 frames.
const TsdfVolume& scannedTabletop();

/// Poses around the objects at 0.8 m, as the planner scores them.
std::vector<Pose> tabletopViews();

}  // namespace vantage::benchmarks
