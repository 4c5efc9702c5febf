#include "core/volume/bricks.h"

#include <algorithm>

namespace vantage {

BrickLayout::BrickLayout(const Eigen::Vector3i& grid_size) : grid(grid_size) {
  const auto bricksFor = [](int voxels, int brick) { return voxels / brick + (voxels % brick != 0); };
  count = {bricksFor(grid.x(), kBrickX), bricksFor(grid.y(), kBrickY), bricksFor(grid.z(), kBrickZ)};
}

BrickRange BrickLayout::range(std::uint32_t brick) const {
  const int bx = static_cast<int>(brick % count.x());
  const std::uint32_t row = brick / count.x();
  const int by = static_cast<int>(row % count.y()), bz = static_cast<int>(row / count.y());
  BrickRange r;
  r.begin = {bx * kBrickX, by * kBrickY, bz * kBrickZ};
  r.end = (r.begin + Eigen::Vector3i(kBrickX, kBrickY, kBrickZ)).cwiseMin(grid);
  return r;
}

std::uint32_t BrickLayout::brickOf(const Eigen::Vector3i& voxel) const {
  return (static_cast<std::uint32_t>(voxel.z() / kBrickZ) * count.y() + voxel.y() / kBrickY) * count.x() +
         voxel.x() / kBrickX;
}

void BrickSet::merge(const BrickSet& other) {
  if (other.member_.size() > member_.size()) member_.resize(other.member_.size(), 0);
  for (std::size_t i = 0; i < other.member_.size(); ++i) member_[i] |= other.member_[i];
}

bool BrickSet::empty() const {
  return std::none_of(member_.begin(), member_.end(), [](std::uint8_t m) { return m != 0; });
}

std::vector<std::uint32_t> BrickSet::list() const {
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i < member_.size(); ++i)
    if (member_[i]) out.push_back(static_cast<std::uint32_t>(i));
  return out;
}

}  // namespace vantage
