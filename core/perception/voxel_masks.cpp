#include "core/perception/voxel_masks.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>

namespace vantage {

namespace {

/// Gathers the lowest bits of 64 bytes that are 0 or 1.
std::uint64_t packBits(const std::uint8_t* bytes) {
  std::uint64_t bits = 0;
  for (int k = 0; k < 8; ++k) {
    std::uint64_t eight;
    std::memcpy(&eight, bytes + 8 * k, 8);
    bits |= ((eight * 0x0102040810204080ULL) >> 56) << (8 * k);
  }
  return bits;
}

void packRow(const TsdfVoxel* row, int size, std::uint16_t threshold, std::uint64_t* known,
             std::uint64_t* positive) {
  alignas(64) std::uint8_t is_known[64], is_positive[64];
  for (int begin = 0, word = 0; begin < size; begin += 64, ++word) {
    const int count = std::min(64, size - begin);
    if (count < 64) {
      std::memset(is_known, 0, sizeof is_known);
      std::memset(is_positive, 0, sizeof is_positive);
    }
    for (int i = 0; i < count; ++i) {
      is_known[i] = row[begin + i].weight >= threshold;
      is_positive[i] = row[begin + i].value > 0;
    }
    known[word] = packBits(is_known);
    positive[word] = packBits(is_positive);
  }
}

}  // namespace

VoxelMasks::VoxelMasks(const TsdfVolume& volume, int weight_threshold)
    : size_(volume.geometry().size), words_((size_.x() + 63) / 64) {
  const std::size_t rows = static_cast<std::size_t>(size_.y()) * size_.z();
  known_.assign(1 + rows * (words_ + 1), 0);
  positive_.assign(known_.size(), 0);
  const auto threshold = static_cast<std::uint16_t>(std::clamp(weight_threshold, 0, 65535));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows, 64), [&](const auto& range) {
    for (std::size_t row = range.begin(); row != range.end(); ++row) {
      const std::size_t at = 1 + row * (words_ + 1);
      packRow(volume.voxels().data() + row * size_.x(), size_.x(), threshold, known_.data() + at,
              positive_.data() + at);
    }
  });
}

}  // namespace vantage
