// Acceptance check 10.4, toy table: exact counts of hierarchical ray tracing.
#include <gtest/gtest.h>

#include "tests/core/raycasting/toy_scene.h"

namespace vantage {
namespace {

using testing::kToyVoxel;
using testing::toyLabel;
using testing::toyPose;
using testing::toyPyramid;
using testing::toySensor;

struct Entry {
  std::uint64_t occupied, unknown, visited;
  bool operator==(const Entry&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Entry& e) {
  return out << "(" << e.occupied << ", " << e.unknown << ", " << e.visited << ")";
}

constexpr Entry kTable[5][4] = {
    {{0, 336, 5358}, {0, 336, 756}, {0, 336, 104}, {0, 336, 17}},
    {{336, 0, 5358}, {336, 0, 6114}, {336, 0, 6218}, {336, 0, 6235}},
    {{108, 0, 8112}, {108, 0, 4272}, {108, 0, 4156}, {108, 0, 4173}},
    {{160, 176, 5358}, {144, 192, 3179}, {144, 192, 2953}, {80, 256, 1734}},
    {{108, 148, 6752}, {108, 180, 3542}, {108, 196, 3418}, {108, 196, 3435}},
};

Entry entryOf(const RayCounts& counts) {
  EXPECT_FALSE(counts.sensor_blocked);
  EXPECT_EQ(counts.rays, 336u);
  return {counts.occupied, counts.unknown, counts.visited};
}

class HierarchicalToy : public ::testing::TestWithParam<int> {};

TEST_P(HierarchicalToy, MeetsTheTableExactly) {
  const int scene = GetParam();
  const StatePyramid pyramid = toyPyramid([&](const auto& p) { return toyLabel(scene, p); }, 3);
  const RayTree tree(toySensor(), kToyVoxel, 3);
  HierarchicalQuery query;
  query.start = ChildStart::Restart;
  for (int m = 0; m <= 3; ++m) {
    SCOPED_TRACE(m);
    EXPECT_EQ(entryOf(castHierarchical(pyramid, tree, m, toyPose(), query)), kTable[scene][m]);
    EXPECT_EQ(entryOf(castHierarchicalReference(pyramid, tree, m, toyPose(), query)), kTable[scene][m]);
  }
  EXPECT_EQ(entryOf(castUniformRays(pyramid.finest(), tree, toyPose(), query)), kTable[scene][0]);
}

INSTANTIATE_TEST_SUITE_P(Scenes, HierarchicalToy, ::testing::Range(0, 5));

}  // namespace
}  // namespace vantage
