#pragma once

#include <vector>

#include "core/raycasting/cast_kernel.h"
#include "core/raycasting/plain_caster.h"
#include "core/raycasting/uniform_caster.h"
#include "core/volume/cpu_path.h"

namespace vantage::casting {

/// Half-open rectangle of pixels; may reach beyond the image.
struct PixelRectangle {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;
};

/// Sideways metres a metre of depth of the ray through a pixel.
inline float slopeX(const PinholeCamera& c, int u) {
  return static_cast<float>((u - c.cx) / c.fx);
}
inline float slopeY(const PinholeCamera& c, int v) {
  return static_cast<float>((v - c.cy) / c.fy);
}

/// Voxels whose centre counts for a query, in the indices of a grid.
Region makeRegion(const GridGeometry& geometry, const VisibilityQuery& query);

/// Rays of a pose through a grid. \return false if the origin is too far away for any ray to meet it
bool makeBundle(const StateGrid& grid, const PinholeCamera& camera, const Pose& T_world_camera,
                const VisibilityQuery& query, Bundle& bundle);

/// The same for any sensor, without the region.
bool makeBundle(const StateGrid& grid, const Pose& T_world_camera, double min_range_m, double max_range_m,
                Bundle& bundle);

CastRow castRowFor(CpuPath path);
CastList castListFor(CpuPath path);

/// Different numbers in a list.
std::uint64_t countDistinct(std::vector<std::int32_t> voxels);

float squaredDistance(const Region& region, const int (&voxel)[3]);
bool withinBounds(const Region& region, const int (&voxel)[3]);
/// A ray for the plain walk; `length` becomes the ray length of a metre of depth.
PlainRay<float> plainRay(const Bundle& bundle, float slope_x, float slope_y, float& length);

/// Counts first hits over one or more casts of rays that share a query.
class HitCounter {
 public:
  HitCounter(const VisibilityQuery& query, const GridGeometry& geometry);

  void cast(CpuPath path, const StateGrid& grid, const PinholeCamera& camera, const Pose& T_world_camera,
            const PixelRectangle& pixels);
  /// The same, one voxel at a time.
  void castPlainly(const StateGrid& grid, const PinholeCamera& camera, const Pose& T_world_camera,
                   const PixelRectangle& pixels);
  VisibilityCounts counts() const;

 private:
  bool wantsHits() const { return query_.distinct_voxels || !histogram_.empty(); }
  void take(Totals& totals, const PixelRectangle& pixels);
  void addToHistogram(float center2_voxels);

  VisibilityQuery query_;
  double voxel_m_;
  VisibilityCounts counts_;
  std::vector<float> edge2_voxels_;  ///< upper border of each bin, squared
  std::vector<std::uint32_t> histogram_;
  std::vector<std::int32_t> seen_unknown_, seen_occupied_;
};

/// castUniform() of part of an image on a chosen path.
VisibilityCounts castRectangle(CpuPath path, const StateGrid& grid, const PinholeCamera& camera,
                               const Pose& T_world_camera, const VisibilityQuery& query,
                               const PixelRectangle& pixels);

}  // namespace vantage::casting
