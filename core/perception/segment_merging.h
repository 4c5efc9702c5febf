#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace vantage {

inline constexpr std::uint32_t kNoSegment = std::numeric_limits<std::uint32_t>::max();

/// Two adjacent supervoxels and whether LCCP joins them.
struct SupervoxelLink {
  std::uint32_t a = 0, b = 0;
  bool convex = false;
};

/// Segments of a supervoxel graph: supervoxels joined by convex links, then every segment of at most
/// `min_supervoxels` supervoxels that has neighbours joins the one with the most supervoxels, smallest
/// segments first, ties by the lower label (D-B34). Each join leaves one segment fewer, so it ends; a segment
/// with no neighbour stays whatever its size. 0 = no joining.
/// `exists` tells which labels 0..n-1 are in use. Returns for each label the lowest label of its segment,
/// kNoSegment for labels not in use. Independent of the order of `links`.
std::vector<std::uint32_t> groupSupervoxels(const std::vector<std::uint8_t>& exists,
                                            const std::vector<SupervoxelLink>& links, int min_supervoxels);

}  // namespace vantage
