#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace vantage {

/// Size of the blocks in which changes of a volume are tracked, voxels. Blocks at the upper borders are cut.
inline constexpr int kBrickX = 16, kBrickY = 8, kBrickZ = 8;

/// Half-open range of voxels [begin, end) of one brick.
struct BrickRange {
  Eigen::Vector3i begin, end;
};

/// The bricks of a grid, numbered with x fastest.
struct BrickLayout {
  Eigen::Vector3i grid = Eigen::Vector3i::Zero();   ///< size of the grid, voxels
  Eigen::Vector3i count = Eigen::Vector3i::Zero();  ///< bricks per axis

  BrickLayout() = default;
  explicit BrickLayout(const Eigen::Vector3i& grid_size);
  std::size_t total() const { return static_cast<std::size_t>(count.x()) * count.y() * count.z(); }
  BrickRange range(std::uint32_t brick) const;
  std::uint32_t brickOf(const Eigen::Vector3i& voxel) const;
};

/// Bricks of a grid as a set: cheap to merge, iterated in ascending order.
class BrickSet {
 public:
  BrickSet() = default;
  explicit BrickSet(std::size_t total) : member_(total, 0) {}
  void insert(std::uint32_t brick) { member_[brick] = 1; }
  void merge(const BrickSet& other);
  bool contains(std::uint32_t brick) const { return member_[brick] != 0; }
  bool empty() const;
  std::vector<std::uint32_t> list() const;
  /// One flag a brick; distinct bricks may be set from several threads.
  std::span<std::uint8_t> flags() { return member_; }
  std::size_t total() const { return member_.size(); }

 private:
  std::vector<std::uint8_t> member_;
};

}  // namespace vantage
