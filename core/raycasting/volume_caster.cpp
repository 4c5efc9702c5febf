#include "core/raycasting/volume_caster.h"

#include <algorithm>
#include <cmath>

#include "core/raycasting/bundle.h"

namespace vantage {
namespace {

using casting::Bundle;
using casting::PlainRay;

/// A set of voxels of a grid, as bits.
class VoxelSet {
 public:
  explicit VoxelSet(std::size_t voxels) : bits_((voxels + 63) / 64, 0) {}
  void insert(std::size_t voxel) {
    std::uint64_t& word = bits_[voxel / 64];
    const std::uint64_t bit = std::uint64_t{1} << (voxel % 64);
    count_ += (word & bit) == 0;
    word |= bit;
  }
  std::uint64_t count() const { return count_; }

 private:
  std::vector<std::uint64_t> bits_;
  std::uint64_t count_ = 0;
};

class VolumeCaster {
 public:
  VolumeCaster(const StateGrid& grid, const Bundle& bundle)
      : grid_(grid), bundle_(bundle), seen_(grid.geometry().count()) {}

  void cast(PlainRay<float> ray, float length) {
    const float near = bundle_.min_range_m / length;
    bool meets = false;
    ++counts_.rays;
    ray.end = std::min(ray.end, leavesRegion(ray));
    if (ray.end < near) return;
    const auto walked = casting::walkPlainly(bundle_.grid.size, ray, [&](int i, int j, int k, float t) {
      const VoxelState state = grid_.at(i, j, k);
      if (state == VoxelState::Unknown && t >= near && inRegion({i, j, k})) {
        seen_.insert(grid_.geometry().index(i, j, k));
        meets = true;
      }
      return state == VoxelState::Occupied;
    });
    counts_.visited += walked.visited;
    counts_.unknown += meets;
    counts_.occupied += walked.hit && walked.t >= near && inRegion(walked.voxel);
  }

  VisibilityCounts counts() const {
    VisibilityCounts counts = counts_;
    counts.unknown_voxels = seen_.count();
    return counts;
  }

 private:
  /// Parameter from which on a ray meets no voxel of the ball; negative if it never does.
  float leavesRegion(const PlainRay<float>& ray) const {
    const casting::Region& region = bundle_.region;
    if (std::isinf(region.radius2)) return region.radius2;
    if (region.radius2 < 0.0f) return -1.0f;
    double along = 0.0, direction2 = 0.0, distance2 = 0.0;
    for (int a = 0; a < 3; ++a) {
      const double to_center = region.center[a] + 0.5 - ray.origin[a];  // voxel i covers [i, i + 1)
      along += to_center * ray.direction[a];
      direction2 += double(ray.direction[a]) * ray.direction[a];
      distance2 += to_center * to_center;
    }
    const double radius = std::sqrt(region.radius2) + 1.0;  // to the far corner of its outermost voxels
    const double root = along * along - direction2 * (distance2 - radius * radius);
    return root < 0.0 ? -1.0f : static_cast<float>((along + std::sqrt(root)) / direction2);
  }

  bool inRegion(const int (&v)[3]) const {
    return casting::withinBounds(bundle_.region, v) &&
           casting::squaredDistance(bundle_.region, v) <= bundle_.region.radius2;
  }

  const StateGrid& grid_;
  const Bundle& bundle_;
  VoxelSet seen_;
  VisibilityCounts counts_;
};

}  // namespace

VisibilityCounts castThroughUnknown(const StateGrid& grid, const PinholeCamera& camera,
                                    const Pose& T_world_camera, const VisibilityQuery& query) {
  Bundle bundle;
  if (!casting::makeBundle(grid, camera, T_world_camera, query, bundle)) {
    VisibilityCounts none;
    none.rays = static_cast<std::uint64_t>(camera.width) * camera.height;
    return none;
  }
  VolumeCaster caster(grid, bundle);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      float length = 1.0f;
      const PlainRay<float> ray =
          casting::plainRay(bundle, casting::slopeX(camera, u), casting::slopeY(camera, v), length);
      caster.cast(ray, length);
    }
  }
  return caster.counts();
}

}  // namespace vantage
