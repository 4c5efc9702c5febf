#include "core/volume/tsdf_volume.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "core/volume/bulk_memory.h"

namespace vantage {

TsdfVolume::TsdfVolume(const GridGeometry& geometry) : geometry_(geometry), bricks_(geometry.size) {
  requireGridFits("TSDF volume", geometry, sizeof(TsdfVoxel));
  try {
    voxels_.resize(geometry.count());
  } catch (const std::bad_alloc&) {
    throwDoesNotFit("TSDF volume", geometry, sizeof(TsdfVoxel));
  }
}

std::vector<TsdfVoxel> TsdfVolume::brick(std::uint32_t brick) const {
  const BrickRange r = bricks_.range(brick);
  std::vector<TsdfVoxel> out;
  out.reserve((r.end - r.begin).prod());
  for (int k = r.begin.z(); k < r.end.z(); ++k)
    for (int j = r.begin.y(); j < r.end.y(); ++j) {
      const TsdfVoxel* row = voxels_.data() + geometry_.index(0, j, k);
      out.insert(out.end(), row + r.begin.x(), row + r.end.x());
    }
  return out;
}

void TsdfVolume::setBrick(std::uint32_t brick, std::span<const TsdfVoxel> voxels) {
  const BrickRange r = bricks_.range(brick);
  const std::size_t expected = (r.end - r.begin).prod();
  if (voxels.size() != expected) {
    std::ostringstream text;
    text << "brick " << brick << ": " << voxels.size() << " voxels given, it holds " << expected;
    throw std::invalid_argument(text.str());
  }
  auto from = voxels.begin();
  const int width = r.end.x() - r.begin.x();
  for (int k = r.begin.z(); k < r.end.z(); ++k)
    for (int j = r.begin.y(); j < r.end.y(); ++j, from += width)
      std::copy_n(from, width, voxels_.data() + geometry_.index(r.begin.x(), j, k));
}

BrickSet clearSphere(TsdfVolume& volume, const Eigen::Vector3d& center_world, double radius_m) {
  const GridGeometry& g = volume.geometry();
  BrickSet changed(volume.bricks().total());
  if (!(radius_m >= 0.0) || !center_world.allFinite()) return changed;
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(radius_m / g.voxel_size_m);
  const Eigen::Vector3d c = g.toGrid(center_world), top = (g.size - Eigen::Vector3i::Ones()).cast<double>();
  const Eigen::Vector3d low = (c - margin).cwiseMax(0.0), high = (c + margin).cwiseMin(top);
  if ((low.array() > high.array()).any()) return changed;
  const Eigen::Vector3i begin = low.array().floor().cast<int>(), end = high.array().ceil().cast<int>();
  for (int k = begin.z(); k <= end.z(); ++k)
    for (int j = begin.y(); j <= end.y(); ++j)
      for (int i = begin.x(); i <= end.x(); ++i) {
        const Eigen::Vector3i v(i, j, k);
        TsdfVoxel& voxel = volume.at(v);
        if (voxel.weight > 0 || (g.center(v) - center_world).norm() > radius_m) continue;
        voxel = {32767, 10};
        changed.insert(volume.bricks().brickOf(v));
      }
  return changed;
}

}  // namespace vantage
