#include "core/raycasting/first_hits.h"

#include "core/raycasting/bundle.h"

namespace vantage {

std::vector<FirstHit> firstHits(const StateGrid& grid, const PinholeCamera& camera,
                                const Pose& T_world_camera, const VisibilityQuery& query) {
  using namespace casting;
  std::vector<FirstHit> hits;
  Bundle bundle;
  if (!makeBundle(grid, camera, T_world_camera, query, bundle)) return hits;
  const auto inRegion = [&](const int(&v)[3]) {
    return withinBounds(bundle.region, v) && squaredDistance(bundle.region, v) <= bundle.region.radius2;
  };
  const auto stops = [&](int i, int j, int k) {
    const VoxelState state = grid.at(i, j, k);
    if (state == VoxelState::Free) return false;
    return !(bundle.transparent && state == VoxelState::Unknown && !inRegion({i, j, k}));
  };
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      float length = 1.0f;
      const auto ray = plainRay(bundle, slopeX(camera, u), slopeY(camera, v), length);
      const auto end = walkPlainly(bundle.grid.size, ray, stops);
      if (!end.hit) continue;
      FirstHit hit{u, v, static_cast<double>(end.t * length)};
      hit.voxel = grid.geometry().index(end.voxel[0], end.voxel[1], end.voxel[2]);
      hit.state = grid.at(end.voxel[0], end.voxel[1], end.voxel[2]);
      hit.too_near = end.t < bundle.min_range_m / length;
      hit.counts = !hit.too_near && inRegion(end.voxel);
      hits.push_back(hit);
    }
  }
  return hits;
}

}  // namespace vantage
