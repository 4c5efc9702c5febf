#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <tuple>
#include <vector>

#include "core/perception/contours.h"

namespace vantage::test {

/// Neighbourhoods as eq. (2) names them: the greatest number of axes in which a neighbour may differ.
enum Neighbourhood { N6 = 1, N18 = 2, N26 = 3 };

template <class Predicate>
bool anyNeighbour(const TsdfVolume& volume, int x, int y, int z, Neighbourhood n, Predicate predicate) {
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dz = -1; dz <= 1; ++dz) {
        const int axes = std::abs(dx) + std::abs(dy) + std::abs(dz);
        if (axes >= 1 && axes <= n && predicate(volume.at(x + dx, y + dy, z + dz))) return true;
      }
  return false;
}

/// Eq. (2) one voxel at a time, ascending (x, y, z).
inline std::vector<Eigen::Vector3i> referenceContourVoxels(const TsdfVolume& volume, int threshold,
                                                           Neighbourhood unknown = N6,
                                                           Neighbourhood occupied = N18) {
  std::vector<Eigen::Vector3i> found;
  const Eigen::Vector3i size = volume.geometry().size;
  for (int x = 1; x < size.x() - 1; ++x)
    for (int y = 1; y < size.y() - 1; ++y)
      for (int z = 1; z < size.z() - 1; ++z) {
        const TsdfVoxel& e = volume.at(x, y, z);
        if (e.weight < threshold || e.value <= 0) continue;
        const auto is_unknown = [&](const TsdfVoxel& v) { return v.weight < threshold; };
        const auto is_occupied = [&](const TsdfVoxel& v) { return v.weight >= threshold && v.value <= 0; };
        if (!anyNeighbour(volume, x, y, z, unknown, is_unknown)) continue;
        if (anyNeighbour(volume, x, y, z, occupied, is_occupied)) found.emplace_back(x, y, z);
      }
  return found;
}

/// Number of groups if growth compares each voxel with the voxel it was reached from: the reading that D-B4
/// rejects.
inline int transitiveGroups(const std::vector<ContourVoxel>& voxels, double voxel_m,
                            const ContourConfig& config) {
  std::map<std::tuple<int, int, int>, std::size_t> index;
  const auto key = [](const Eigen::Vector3i& v) { return std::tuple(v.x(), v.y(), v.z()); };
  for (std::size_t i = 0; i < voxels.size(); ++i) index[key(voxels[i].voxel)] = i;
  std::vector<bool> grouped(voxels.size(), false);
  int groups = 0;
  for (std::size_t seed = 0; seed < voxels.size(); ++seed) {
    if (grouped[seed]) continue;
    ++groups;
    std::deque<std::size_t> queue{seed};
    grouped[seed] = true;
    while (!queue.empty()) {
      const std::size_t from = queue.front();
      queue.pop_front();
      for (int d = 0; d < 27; ++d) {
        const auto it =
            index.find(key(voxels[from].voxel + Eigen::Vector3i(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1)));
        if (it == index.end() || grouped[it->second]) continue;
        const ContourVoxel &a = voxels[from], &b = voxels[it->second];
        if (voxel_m * (a.voxel - b.voxel).cast<double>().norm() >= config.group_distance_m) continue;
        if (std::acos(std::clamp(a.normal.dot(b.normal), -1.0f, 1.0f)) >= config.group_angle_rad) continue;
        grouped[it->second] = true;
        queue.push_back(it->second);
      }
    }
  }
  return groups;
}

}  // namespace vantage::test
