#include "core/volume/pyramid_rules.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace vantage::pyramid {
namespace {

using Eigen::Vector3i;

// The max rule in bits of VoxelState: occupied is bit 1 of the union, free is bit 0 of the intersection.
static_assert(static_cast<int>(VoxelState::Unknown) == 0 && static_cast<int>(VoxelState::Free) == 1 &&
              static_cast<int>(VoxelState::Occupied) == 2);

constexpr int kBlock = 4;  ///< nodes derived at a time

using ChildRows = std::array<const std::uint8_t*, 4>;

Difference store(std::uint8_t& out, std::uint8_t state) {
  const Difference difference = out ^ state;
  out = state;
  return difference;
}

/// A node that may lie on the border of the grid; `x` is its first child.
std::uint8_t oneNode(const ChildRows& rows, int x, int size_x) {
  std::uint8_t any = 0, all = 1;
  for (const std::uint8_t* row : rows)
    for (int at = std::max(x, 0); at < std::min(x + 2, size_x); ++at) {
      any |= row[at];
      all &= row[at];
    }
  return static_cast<std::uint8_t>((any & 2) | (all & 1));
}

/// kBlock nodes all of whose children exist, from eight voxels of each row.
Difference block(const ChildRows& rows, int x, std::uint8_t* out) {
  std::uint64_t any = 0, all = ~std::uint64_t{0};
  for (const std::uint8_t* row : rows) {
    std::uint64_t eight;
    std::memcpy(&eight, row + x, 8);
    any |= eight;
    all &= eight;
  }
  any |= any >> 8;
  all &= all >> 8;
  const std::uint64_t four = (any & 0x0002000200020002u) | (all & 0x0001000100010001u);
  Difference difference = 0;
  for (int n = 0; n < kBlock; ++n) difference |= store(out[n], static_cast<std::uint8_t>(four >> (16 * n)));
  return difference;
}

Difference refreshRow(const LevelPair& levels, int j, int k, int begin, int end) {
  const GridGeometry& fine = levels.finer.geometry();
  const Vector3i first = 2 * Vector3i(begin, j, k) - levels.phase;
  ChildRows rows{};
  int count = 0;
  for (int z = first.z(); z < first.z() + 2; ++z)
    for (int y = first.y(); y < first.y() + 2; ++y)
      if (y >= 0 && y < fine.size.y() && z >= 0 && z < fine.size.z())
        rows[count++] = levels.finer.states().data() + fine.index(0, y, z);
  for (; count < 4; ++count) rows[count] = rows[0];  // every node has a child, and twice is as good as once
  std::uint8_t* out = levels.coarser.editStates().data() + levels.coarser.geometry().index(0, j, k);
  Difference difference = 0;
  int i = begin;
  while (i < end) {
    const int x = 2 * i - levels.phase.x();
    const bool whole = x >= 0 && x + 2 * kBlock <= fine.size.x() && i + kBlock <= end;
    difference |= whole ? block(rows, x, out + i) : store(out[i], oneNode(rows, x, fine.size.x()));
    i += whole ? kBlock : 1;
  }
  return difference;
}

/// Finest voxels of the grid within a node, along one axis.
int voxelsAlong(const MeanLevels& m, int level, int offset, int axis, int node) {
  const int begin = (node << level) - offset, end = begin + (1 << level);
  return std::min(end, m.grid[axis]) - std::max(begin, 0);
}

}  // namespace

Difference refreshByMax(const LevelPair& levels, const BrickRange& box) {
  Difference difference = 0;
  for (int k = box.begin.z(); k < box.end.z(); ++k)
    for (int j = box.begin.y(); j < box.end.y(); ++j)
      difference |= refreshRow(levels, j, k, box.begin.x(), box.end.x());
  return difference;
}

Difference refreshByMean(const LevelPair& levels, const MeanLevels& m, const OccupancyConfig& config,
                         const BrickRange& box) {
  const GridGeometry &fine = levels.finer.geometry(), &coarse = levels.coarser.geometry();
  const int level = m.coarse_level;
  const auto voxels = [&](const Vector3i& child) {
    double count = 1;
    for (int a = 0; a < 3; ++a)
      count *= voxelsAlong(m, level - 1, m.offset[a] - (levels.phase[a] << (level - 1)), a, child[a]);
    return count;
  };
  Difference difference = 0;
  for (int k = box.begin.z(); k < box.end.z(); ++k)
    for (int j = box.begin.y(); j < box.end.y(); ++j)
      for (int i = box.begin.x(); i < box.end.x(); ++i) {
        double sum = 0, count = 0;
        for (int n = 0; n < 8; ++n) {
          const Vector3i child =
              2 * Vector3i(i, j, k) - levels.phase + Vector3i(n & 1, n >> 1 & 1, n >> 2 & 1);
          if (!fine.contains(child)) continue;
          const double in_child = voxels(child);
          sum += in_child * m.finer[fine.index(child)];
          count += in_child;
        }
        const std::size_t at = coarse.index(i, j, k);
        m.coarser[at] = static_cast<float>(sum / count);
        difference |= store(levels.coarser.editStates()[at],
                            static_cast<std::uint8_t>(occupancyLabel(logOddsOf(sum / count), config)));
      }
  return difference;
}

std::vector<std::uint8_t> parentBricks(const LevelPair& levels, std::span<const std::uint8_t> flags) {
  const BrickLayout finer(levels.finer.geometry().size), coarser(levels.coarser.geometry().size);
  std::vector<std::uint8_t> parents(coarser.total(), 0);
  const auto half = [](int v) { return v >> 1; };
  for (std::uint32_t b = 0; b < flags.size(); ++b) {
    if (!flags[b]) continue;
    const BrickRange r = finer.range(b);
    const Vector3i brick(kBrickX, kBrickY, kBrickZ);
    const Vector3i low = (r.begin + levels.phase).unaryExpr(half).cwiseQuotient(brick);
    const Vector3i high = (r.end + levels.phase - Vector3i::Ones()).unaryExpr(half).cwiseQuotient(brick);
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x)
          parents[(static_cast<std::size_t>(z) * coarser.count.y() + y) * coarser.count.x() + x] = 1;
  }
  return parents;
}

}  // namespace vantage::pyramid
