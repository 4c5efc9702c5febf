#pragma once

#include <cstdint>
#include <vector>

#include "core/volume/tsdf_volume.h"

namespace vantage {

/// What contours and surface need to know of a volume, one bit a voxel: rows along x are packed into 64-bit
/// words, so that a neighbourhood test of 64 voxels is a handful of shifts.
class VoxelMasks {
 public:
  /// Reads a volume once. A voxel is known if its weight reaches `weight_threshold`.
  VoxelMasks(const TsdfVolume& volume, int weight_threshold);

  const Eigen::Vector3i& size() const { return size_; }
  /// Words of a row. Word -1 and word wordsPerRow() of every row exist and are zero.
  int wordsPerRow() const { return words_; }
  /// Bits of row (y, z): weight reaches the threshold.
  const std::uint64_t* known(int y, int z) const { return known_.data() + offset(y, z); }
  /// Bits of row (y, z): value above zero, whatever the weight.
  const std::uint64_t* positive(int y, int z) const { return positive_.data() + offset(y, z); }

 private:
  std::size_t offset(int y, int z) const {
    return 1 + (static_cast<std::size_t>(z) * size_.y() + y) * (words_ + 1);
  }

  Eigen::Vector3i size_;
  int words_ = 0;
  std::vector<std::uint64_t> known_, positive_;
};

/// Bit x of the result is bit x+1 of the row.
inline std::uint64_t fromNext(const std::uint64_t* row, int word) {
  return (row[word] >> 1) | (row[word + 1] << 63);
}
/// Bit x of the result is bit x-1 of the row.
inline std::uint64_t fromPrevious(const std::uint64_t* row, int word) {
  return (row[word] << 1) | (row[word - 1] >> 63);
}

}  // namespace vantage
