#include "core/volume/free_radius.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "core/volume/state_grid.h"
#include "core/volume/tsdf_volume.h"

namespace vantage {
namespace {

// A voxel's radius is the number of erosions of the free space, by cubes of 3 voxels, that it survives. One
// bit a voxel: 64 voxels an operation, and a tile with its surroundings stays in the cache.
constexpr int kReach = StateGrid::kMaxRadius - 1;  // farthest voxel with an influence
constexpr int kWord = 64;
constexpr int kTile = 64;  // voxels in y and z

using Word = std::uint64_t;
constexpr Word kAllFree = ~Word{0};

/// Free voxels of a box of rows as bits; what the last word has beyond the grid is free.
class BitBox {
 public:
  BitBox(const Eigen::Vector3i& grid, const std::uint8_t* states, const Eigen::Vector3i& begin,
         const Eigen::Vector3i& end)
      : begin_(begin), size_(end - begin), words_(size_.x() / kWord) {
    bits_.assign(static_cast<std::size_t>(words_) * size_.y() * size_.z(), kAllFree);
    spare_ = bits_;
    for (int z = begin.z(); z < end.z(); ++z)
      for (int y = begin.y(); y < end.y(); ++y)
        load(states + (static_cast<std::size_t>(z) * grid.y() + y) * grid.x(), grid.x(), row(bits_, y, z));
  }

  const Word* row(int y, int z) const { return bits_.data() + offset(y, z); }

  /// One erosion by the 3^3 cube. What is wrong at the border of the box moves inward by one voxel.
  void erode() {
    const int rows = size_.y() * size_.z();
    for (int r = 0; r < rows; ++r) erodeRow(bits_.data() + static_cast<std::size_t>(r) * words_);
    const std::size_t slice = static_cast<std::size_t>(size_.y()) * words_;
    for (int z = 0; z < size_.z(); ++z) erodeAcross(bits_.data(), spare_.data(), z * slice, slice, words_);
    erodeAcross(spare_.data(), bits_.data(), 0, bits_.size(), slice);
  }

 private:
  std::size_t offset(int y, int z) const {
    return (static_cast<std::size_t>(z - begin_.z()) * size_.y() + (y - begin_.y())) * words_;
  }
  Word* row(std::vector<Word>& bits, int y, int z) const { return bits.data() + offset(y, z); }

  void load(const std::uint8_t* states, int count, Word* out) const {
    static_assert(static_cast<int>(VoxelState::Unknown) == 0 && static_cast<int>(VoxelState::Free) == 1 &&
                  static_cast<int>(VoxelState::Occupied) == 2);  // bit 0 of a state says free
    const int first = begin_.x(), last = std::min(begin_.x() + size_.x(), count);
    int x = first;
    for (; x < last && (x - begin_.x()) % 8 != 0; ++x) setBit(out, x, states[x]);
    for (; x + 8 <= last; x += 8) {
      Word bytes;
      std::memcpy(&bytes, states + x, 8);
      const Word eight = ((bytes & 0x0101010101010101u) * 0x0102040810204080u) >> 56;
      const int at = x - begin_.x();
      out[at / kWord] &= ~((eight ^ 0xffu) << (at % kWord));
    }
    for (; x < last; ++x) setBit(out, x, states[x]);
  }
  void setBit(Word* out, int x, std::uint8_t state) const {
    const int at = x - begin_.x();
    if (!(state & 1)) out[at / kWord] &= ~(Word{1} << (at % kWord));
  }

  void erodeRow(Word* w) const {
    Word before = kAllFree;
    for (int i = 0; i < words_; ++i) {
      const Word here = w[i], after = i + 1 < words_ ? w[i + 1] : kAllFree;
      w[i] = here & ((here << 1) | (before >> 63)) & ((here >> 1) | (after << 63));
      before = here;
    }
  }

  /// `count` words from `first` on, each with those `step` before and behind it among them.
  static void erodeAcross(const Word* from, Word* to, std::size_t first, std::size_t count,
                          std::size_t step) {
    from += first;
    to += first;
    if (count <= step) {  // one row alone
      std::copy(from, from + count, to);
      return;
    }
    for (std::size_t i = 0; i < step; ++i) to[i] = from[i] & from[i + step];
    for (std::size_t i = step; i < count - step; ++i) to[i] = from[i - step] & from[i] & from[i + step];
    for (std::size_t i = count - step; i < count; ++i) to[i] = from[i - step] & from[i];
  }

  Eigen::Vector3i begin_, size_;
  int words_;
  std::vector<Word> bits_, spare_;
};

/// Byte k of entry b is bit k of b.
constexpr std::array<Word, 256> makeSpread() {
  std::array<Word, 256> table{};
  for (int b = 0; b < 256; ++b)
    for (int k = 0; k < 8; ++k) table[b] |= static_cast<Word>((b >> k) & 1) << (8 * k);
  return table;
}
constexpr std::array<Word, 256> kSpread = makeSpread();

using Count = std::array<Word, 4>;  // a number 0..15 for each of 64 voxels, bit by bit

void increment(Count& count, Word carry) {
  for (Word& digit : count) {
    const Word next = digit & carry;
    digit ^= carry;
    carry = next;
  }
}

void store(const Count& count, int voxels, std::uint8_t* out) {
  for (int x = 0; x < voxels; x += 8) {
    const Word eight = kSpread[(count[0] >> x) & 0xff] | kSpread[(count[1] >> x) & 0xff] << 1 |
                       kSpread[(count[2] >> x) & 0xff] << 2 | kSpread[(count[3] >> x) & 0xff] << 3;
    std::memcpy(out + x, &eight, std::min(8, voxels - x));
  }
}

/// Box of the voxels of a tile that flagged bricks can influence; false if there is none.
bool influencedBox(const BrickLayout& bricks, std::span<const std::uint8_t> flags, Eigen::Vector3i& begin,
                   Eigen::Vector3i& end) {
  const Eigen::Vector3i reach = Eigen::Vector3i::Constant(kReach), brick(kBrickX, kBrickY, kBrickZ);
  const Eigen::Vector3i first = (begin - reach).cwiseMax(0).cwiseQuotient(brick);
  const Eigen::Vector3i last = (end + reach - Eigen::Vector3i::Ones())
                                   .cwiseMin(bricks.grid - Eigen::Vector3i::Ones())
                                   .cwiseQuotient(brick);
  Eigen::Vector3i low = end, high = begin;
  for (int z = first.z(); z <= last.z(); ++z)
    for (int y = first.y(); y <= last.y(); ++y)
      for (int x = first.x(); x <= last.x(); ++x) {
        const std::uint32_t id =
            (static_cast<std::uint32_t>(z) * bricks.count.y() + y) * bricks.count.x() + x;
        if (!flags[id]) continue;
        const BrickRange r = bricks.range(id);
        low = low.cwiseMin(r.begin - reach);
        high = high.cwiseMax(r.end + reach);
      }
  begin = begin.cwiseMax(low);
  end = end.cwiseMin(high);
  return (begin.array() < end.array()).all();
}

}  // namespace

void rebuildFreeRadius(const Eigen::Vector3i& grid, const std::uint8_t* states, const Eigen::Vector3i& begin,
                       const Eigen::Vector3i& end, std::uint8_t* radius) {
  const int first_word = begin.x() / kWord, last_word = (end.x() + kWord - 1) / kWord;
  const int words = last_word - first_word, grid_words = (grid.x() + kWord - 1) / kWord;
  // Nothing comes from beyond the grid, which is free.
  const int low_word = std::max(first_word - 1, 0), high_word = std::min(last_word + 1, grid_words);
  const Eigen::Vector3i low(low_word * kWord, std::max(begin.y() - kReach, 0),
                            std::max(begin.z() - kReach, 0));
  const Eigen::Vector3i high(high_word * kWord, std::min(end.y() + kReach, grid.y()),
                             std::min(end.z() + kReach, grid.z()));
  BitBox box(grid, states, low, high);
  const int before = first_word - low_word;
  const int rows = end.y() - begin.y();
  std::vector<Count> count(static_cast<std::size_t>(words) * rows * (end.z() - begin.z()), Count{});
  for (int r = 0; r <= kReach; ++r) {
    if (r > 0) box.erode();
    Count* c = count.data();
    for (int z = begin.z(); z < end.z(); ++z)
      for (int y = begin.y(); y < end.y(); ++y)
        for (int w = 0; w < words; ++w) increment(*c++, box.row(y, z)[w + before]);
  }
  const Count* c = count.data();
  for (int z = begin.z(); z < end.z(); ++z)
    for (int y = begin.y(); y < end.y(); ++y)
      for (int w = first_word; w < last_word; ++w)
        store(*c++, std::min(kWord, grid.x() - w * kWord),
              radius + (static_cast<std::size_t>(z) * grid.y() + y) * grid.x() +
                  static_cast<std::size_t>(w) * kWord);
}

void rebuildFreeRadiusNear(const Eigen::Vector3i& grid, const std::uint8_t* states,
                           std::span<const std::uint8_t> brick_flags, std::uint8_t* radius) {
  const BrickLayout bricks(grid);
  const int tiles_y = (grid.y() + kTile - 1) / kTile, tiles_z = (grid.z() + kTile - 1) / kTile;
  tbb::parallel_for(
      tbb::blocked_range<int>(0, tiles_y * tiles_z, 1), [&](const tbb::blocked_range<int>& range) {
        for (int t = range.begin(); t < range.end(); ++t) {
          Eigen::Vector3i begin(0, t % tiles_y * kTile, t / tiles_y * kTile);
          Eigen::Vector3i end = (begin + Eigen::Vector3i(grid.x(), kTile, kTile)).cwiseMin(grid);
          if (influencedBox(bricks, brick_flags, begin, end))
            rebuildFreeRadius(grid, states, begin, end, radius);
        }
      });
}

}  // namespace vantage
