#include "core/raycasting/uniform_caster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/raycasting/bundle.h"
#include "core/raycasting/plain_caster.h"

namespace vantage {
namespace casting {

CastRow castRowFor(CpuPath path) {
#ifdef VANTAGE_X86_KERNELS
  if (path == CpuPath::Avx512) return castRowAvx512;
  if (path == CpuPath::Avx2) return castRowAvx2;
#endif
  static_cast<void>(path);
  return castRowPortable;
}

CastList castListFor(CpuPath path) {
#ifdef VANTAGE_X86_KERNELS
  if (path == CpuPath::Avx512) return castListAvx512;
  if (path == CpuPath::Avx2) return castListAvx2;
#endif
  static_cast<void>(path);
  return castListPortable;
}

VisibilityCounts castRectangle(CpuPath path, const StateGrid& grid, const PinholeCamera& camera,
                               const Pose& T_world_camera, const VisibilityQuery& query,
                               const PixelRectangle& pixels) {
  HitCounter counter(query, grid.geometry());
  counter.cast(path, grid, camera, T_world_camera, pixels);
  return counter.counts();
}

}  // namespace casting

VisibilityCounts castUniform(const StateGrid& grid, const PinholeCamera& camera, const Pose& T_world_camera,
                             const VisibilityQuery& query) {
  return casting::castRectangle(bestCpuPath(), grid, camera, T_world_camera, query,
                                {0, 0, camera.width, camera.height});
}

bool sharesQuarterTurnGrid(const PinholeCamera& camera) {
  return camera.fx == camera.fy && 2.0 * camera.cx == camera.width - 1.0 &&
         2.0 * camera.cy == camera.height - 1.0 && (camera.width - camera.height) % 2 == 0;
}

QuarterTurnCounts castQuarterTurns(const StateGrid& grid, const PinholeCamera& camera,
                                   const Pose& T_world_camera, const VisibilityQuery& query) {
  if (!sharesQuarterTurnGrid(camera))
    throw std::invalid_argument(
        "castQuarterTurns: the camera needs square pixels, a centred principal point and "
        "width and height of equal parity");
  // The two bundles share a square; what only one of them has is two strips beside or above it.
  const int grow = (camera.width - camera.height) / 2, w = camera.width, h = camera.height;
  const int cut_x = std::max(grow, 0), cut_y = std::max(-grow, 0);
  const casting::PixelRectangle square{cut_x, cut_y, w - cut_x, h - cut_y};
  const CpuPath path = bestCpuPath();
  casting::HitCounter upright(query, grid.geometry());
  upright.cast(path, grid, camera, T_world_camera, square);
  casting::HitCounter sideways = upright;
  const std::uint64_t shared_rays = upright.counts().rays, shared_visits = upright.counts().visited;
  casting::HitCounter& wide = grow > 0 ? upright : sideways;
  casting::HitCounter& tall = grow > 0 ? sideways : upright;
  const int beside = std::abs(grow);
  const casting::PixelRectangle& s = square;
  wide.cast(path, grid, camera, T_world_camera, {s.u0 - beside, s.v0, s.u0, s.v1});
  wide.cast(path, grid, camera, T_world_camera, {s.u1, s.v0, s.u1 + beside, s.v1});
  tall.cast(path, grid, camera, T_world_camera, {s.u0, s.v0 - beside, s.u1, s.v0});
  tall.cast(path, grid, camera, T_world_camera, {s.u0, s.v1, s.u1, s.v1 + beside});
  QuarterTurnCounts result{upright.counts(), sideways.counts(), 0, 0};
  result.rays_cast = result.upright.rays + result.sideways.rays - shared_rays;
  result.visited = result.upright.visited + result.sideways.visited - shared_visits;
  return result;
}

VisibilityCounts castUniformReference(const StateGrid& grid, const PinholeCamera& camera,
                                      const Pose& T_world_camera, const VisibilityQuery& query) {
  casting::HitCounter counter(query, grid.geometry());
  counter.castPlainly(grid, camera, T_world_camera, {0, 0, camera.width, camera.height});
  return counter.counts();
}

std::optional<RayHit> castRay(const StateGrid& grid, const Eigen::Vector3d& origin_world,
                              const Eigen::Vector3d& direction_world, double max_length_m) {
  const GridGeometry& g = grid.geometry();
  const double length = direction_world.norm();
  const Eigen::Vector3d origin = g.toGrid(origin_world) + Eigen::Vector3d::Constant(0.5);
  if (!(length > 0.0) || !(origin.cwiseAbs().maxCoeff() < casting::kFarthestOrigin)) return std::nullopt;
  const Eigen::Vector3d direction = direction_world / (length * g.voxel_size_m);
  casting::PlainRay<double> ray{};
  Eigen::Vector3d::Map(ray.origin) = origin;
  Eigen::Vector3d::Map(ray.direction) = direction;
  ray.end = max_length_m;
  const int size[3] = {g.size.x(), g.size.y(), g.size.z()};
  const auto walked = casting::walkPlainly(
      size, ray, [&](int i, int j, int k) { return grid.at(i, j, k) != VoxelState::Free; });
  if (!walked.hit) return std::nullopt;
  const Eigen::Vector3i voxel(walked.voxel[0], walked.voxel[1], walked.voxel[2]);
  return RayHit{voxel, walked.t, grid.at(voxel)};
}

}  // namespace vantage
