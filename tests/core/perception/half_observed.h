#pragma once

#include <algorithm>
#include <cmath>

#include "core/volume/tsdf_volume.h"

namespace vantage::test {

inline constexpr double kVoxel = 3.0 / 512.0;
inline constexpr double kTruncationVoxels = 5.12;

inline TsdfVoxel tsdf(double value, int weight) {
  return {static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0, 1.0) * 32767.0)),
          static_cast<std::uint16_t>(weight)};
}

inline TsdfVolume emptyVolume(int nx, int ny, int nz, TsdfVoxel fill = {}) {
  GridGeometry geometry;
  geometry.voxel_size_m = kVoxel;
  geometry.size = {nx, ny, nz};
  TsdfVolume volume(geometry);
  std::fill(volume.voxels().begin(), volume.voxels().end(), fill);
  return volume;
}

/// Box seen by an orthographic sensor that looks along +z (12.1): front face at voxel z = 12, five occupied
/// voxels, unknown behind them; everything outside the footprint empty.
inline TsdfVolume halfObservedBox(int nx, int ny, int nz, int x0, int x1, int y0, int y1, int weight = 20) {
  TsdfVolume volume = emptyVolume(nx, ny, nz, tsdf(1.0, weight));
  for (int x = x0; x <= x1; ++x)
    for (int y = y0; y <= y1; ++y)
      for (int z = 0; z < nz; ++z)
        volume.at(x, y, z) = z >= 17 ? TsdfVoxel{} : tsdf((11.5 - z) / kTruncationVoxels, weight);
  return volume;
}

/// The box of 12.1: grid 40^3, footprint x 14..25, y 15..24.
inline TsdfVolume referenceBox(int weight = 20) {
  return halfObservedBox(40, 40, 40, 14, 25, 15, 24, weight);
}

/// Sphere of radius R voxels in 64^3 seen by the same sensor (12.2).
inline TsdfVolume halfObservedSphere(double radius) {
  const double c = 31.5;
  TsdfVolume volume = emptyVolume(64, 64, 64, tsdf(1.0, 20));
  for (int x = 0; x < 64; ++x)
    for (int y = 0; y < 64; ++y)
      for (int z = 0; z < 64; ++z) {
        const double rho = std::hypot(x - c, y - c);
        if (rho >= radius) continue;
        const double pen = (z - c) + std::sqrt(radius * radius - rho * rho);
        volume.at(x, y, z) = pen >= 5.0 ? TsdfVoxel{} : tsdf(-pen / kTruncationVoxels, 20);
      }
  return volume;
}

}  // namespace vantage::test
