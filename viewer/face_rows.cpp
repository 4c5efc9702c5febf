#include "viewer/face_rows.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vantage {
namespace {

/// Which states of a neighbour let a face be drawn.
struct NeighbourRule {
  std::uint8_t state;  ///< drawn if the neighbour has it, or, with `unless`, if it has another one
  bool unless;
};

/// Sets a bit where a voxel of the state has a neighbour that the rule asks for. Written to be vectorised.
void markRow(const std::uint8_t* row, const std::uint8_t* neighbours, int count, std::uint8_t of,
             NeighbourRule rule, std::uint8_t bit, std::uint8_t* flags) {
  if (rule.unless) {
    for (int n = 0; n < count; ++n)
      flags[n] |= static_cast<std::uint8_t>((row[n] == of) & (neighbours[n] != rule.state) ? bit : 0);
  } else {
    for (int n = 0; n < count; ++n)
      flags[n] |= static_cast<std::uint8_t>((row[n] == of) & (neighbours[n] == rule.state) ? bit : 0);
  }
}

/// The same at the end of the range.
void markBorder(const std::uint8_t* row, int count, std::uint8_t of, NeighbourRule rule, std::uint8_t bit,
                std::uint8_t* flags) {
  if (!rule.unless) return;
  for (int n = 0; n < count; ++n) flags[n] |= static_cast<std::uint8_t>(row[n] == of ? bit : 0);
}

}  // namespace

VoxelRange voxelsIn(const GridGeometry& grid, const Box& box) {
  VoxelRange range;
  if (grid.count() == 0 || box.isEmpty()) return range;
  const Eigen::Vector3d low = grid.toGrid(box.min()), high = grid.toGrid(box.max());
  for (int a = 0; a < 3; ++a) {
    range.begin[a] = static_cast<int>(std::clamp(std::ceil(low[a]), 0.0, static_cast<double>(grid.size[a])));
    range.end[a] =
        static_cast<int>(std::clamp(std::floor(high[a]) + 1.0, 0.0, static_cast<double>(grid.size[a])));
  }
  return range;
}

std::vector<VoxelFace> facesOfLayer(const StateGrid& grid, VoxelState of_state, FaceRule face_rule,
                                    const VoxelRange& range, int k) {
  const GridGeometry& geometry = grid.geometry();
  const auto of = static_cast<std::uint8_t>(of_state);
  const NeighbourRule rule = face_rule == FaceRule::TowardOther
                                 ? NeighbourRule{of, true}
                                 : NeighbourRule{static_cast<std::uint8_t>(VoxelState::Free), false};
  const std::uint8_t* states = grid.states().data();
  const int count = range.end.x() - range.begin.x();
  const auto row_stride = static_cast<std::ptrdiff_t>(geometry.size.x());
  const std::ptrdiff_t layer_stride = row_stride * geometry.size.y();
  std::vector<std::uint8_t> flags(static_cast<std::size_t>(count) + 8, 0);
  std::vector<VoxelFace> faces;
  for (int j = range.begin.y(); j < range.end.y(); ++j) {
    const std::uint8_t* row = states + geometry.index(range.begin.x(), j, k);
    std::fill(flags.begin(), flags.end(), 0);
    markRow(row + 1, row, count - 1, of, rule, 1 << 0, flags.data() + 1);
    markBorder(row, 1, of, rule, 1 << 0, flags.data());
    markRow(row, row + 1, count - 1, of, rule, 1 << 1, flags.data());
    markBorder(row + count - 1, 1, of, rule, 1 << 1, flags.data() + count - 1);
    const auto beside = [&](bool inside, std::ptrdiff_t offset, std::uint8_t bit) {
      if (inside)
        markRow(row, row + offset, count, of, rule, bit, flags.data());
      else
        markBorder(row, count, of, rule, bit, flags.data());
    };
    beside(j > range.begin.y(), -row_stride, 1 << 2);
    beside(j + 1 < range.end.y(), row_stride, 1 << 3);
    beside(k > range.begin.z(), -layer_stride, 1 << 4);
    beside(k + 1 < range.end.z(), layer_stride, 1 << 5);
    for (int n = 0; n < count; n += 8) {
      std::uint64_t eight;
      std::memcpy(&eight, flags.data() + n, 8);
      if (!eight) continue;
      for (int m = n; m < std::min(n + 8, count); ++m)
        for (int side = 0; flags[m] >> side; ++side)
          if (flags[m] >> side & 1) faces.push_back({range.begin.x() + m, j, side});
    }
  }
  return faces;
}

}  // namespace vantage
