#include "core/perception/segment_merging.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace vantage {
namespace {

using testing::ElementsAre;

std::vector<std::uint8_t> labels(std::size_t count) {
  return std::vector<std::uint8_t>(count, 1);
}

TEST(GroupSupervoxels, JoinsAlongConvexLinksOnly) {
  EXPECT_THAT(groupSupervoxels(labels(5), {{3, 4, true}, {0, 1, true}, {1, 2, false}}, 0),
              ElementsAre(0, 0, 2, 3, 3));
}

TEST(GroupSupervoxels, LabelsNotInUseHaveNoSegment) {
  EXPECT_THAT(groupSupervoxels({0, 1, 0, 1}, {{1, 3, false}}, 0), ElementsAre(kNoSegment, 1, kNoSegment, 3));
  EXPECT_TRUE(groupSupervoxels({}, {}, 4).empty());
}

TEST(GroupSupervoxels, SmallSegmentsJoinTheirLargestNeighbour) {
  // {0,1,2} and {3,4,5,6} are larger than 2; 7 touches both.
  const std::vector<SupervoxelLink> links = {{0, 1, true}, {1, 2, true},  {3, 4, true}, {4, 5, true},
                                             {5, 6, true}, {2, 7, false}, {7, 3, false}};
  EXPECT_THAT(groupSupervoxels(labels(8), links, 2), ElementsAre(0, 0, 0, 3, 3, 3, 3, 3));
}

TEST(GroupSupervoxels, TiesGoToTheLowerLabel) {
  EXPECT_THAT(groupSupervoxels(labels(5), {{0, 1, true}, {2, 3, true}, {1, 4, false}, {4, 2, false}}, 1),
              ElementsAre(0, 0, 2, 2, 0));
}

TEST(GroupSupervoxels, ASegmentWithoutNeighboursStays) {
  EXPECT_THAT(groupSupervoxels(labels(3), {{0, 1, true}}, 4), ElementsAre(0, 0, 2));
}

TEST(GroupSupervoxels, EndsWhereEveryNeighbourIsSmaller) {
  // The case in which PCL's own loop never ends: a small segment whose neighbours are all smaller than
  // itself.
  EXPECT_THAT(groupSupervoxels(labels(4), {{0, 1, true}, {1, 2, true}, {2, 3, false}}, 4),
              ElementsAre(0, 0, 0, 0));
  // And a graph in which everything is small.
  std::vector<SupervoxelLink> ring;
  for (std::uint32_t i = 0; i < 100; ++i) ring.push_back({i, (i + 1) % 100, false});
  const auto segments = groupSupervoxels(labels(100), ring, 4);
  std::map<std::uint32_t, int> size;
  for (const auto s : segments) ++size[s];
  for (const auto& [segment, count] : size) EXPECT_GT(count, 4);
}

TEST(GroupSupervoxels, DoesNotDependOnTheOrderOfTheLinks) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<SupervoxelLink> links;
    for (int i = 0; i < 90; ++i) {
      const std::uint32_t a = random() % 60, b = random() % 60;
      if (a != b) links.push_back({a, b, random() % 3 == 0});
    }
    const auto expected = groupSupervoxels(labels(60), links, 4);
    std::shuffle(links.begin(), links.end(), random);
    for (auto& link : links) {
      if (random() % 2) std::swap(link.a, link.b);
    }
    ASSERT_EQ(groupSupervoxels(labels(60), links, 4), expected);
  }
}

TEST(GroupSupervoxels, LeavesNoSmallSegmentThatHasANeighbour) {
  std::mt19937 random(8);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<SupervoxelLink> links;
    for (int i = 0; i < 70; ++i)
      links.push_back({static_cast<std::uint32_t>(random() % 80), static_cast<std::uint32_t>(random() % 80),
                       random() % 2 == 0});
    const auto segment = groupSupervoxels(labels(80), links, 3);
    std::map<std::uint32_t, int> size;
    for (const auto s : segment) ++size[s];
    for (const auto& link : links) {
      if (segment[link.a] == segment[link.b]) continue;
      EXPECT_GT(size[segment[link.a]], 3);
      EXPECT_GT(size[segment[link.b]], 3);
    }
  }
}

}  // namespace
}  // namespace vantage
