#include "core/perception/segmentation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>

namespace vantage {
namespace {

using Eigen::Vector3f;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Vector3f tilted(double degrees) {
  const double a = degrees * std::numbers::pi / 180.0;
  return {static_cast<float>(std::sin(a)), 0.0f, static_cast<float>(std::cos(a))};
}

// ---- 12.6 LCCP edges

const Patch kFlat{{0, 0, 0}, {0, 0, 1}};

TEST(ConvexEdge, OutwardRightAngleMerges) {
  EXPECT_TRUE(convexEdge(kFlat, {{0.02f, 0, -0.02f}, {1, 0, 0}}, {}));
}
TEST(ConvexEdge, InwardRightAngleSplits) {
  EXPECT_FALSE(convexEdge(kFlat, {{0.02f, 0, 0.02f}, {-1, 0, 0}}, {}));
}
TEST(ConvexEdge, CoplanarPatchesMerge) {
  EXPECT_TRUE(convexEdge(kFlat, {{0.03f, 0, 0}, {0, 0, 1}}, {}));
}
TEST(ConvexEdge, StepOfTwoMillimetresSplits) {
  EXPECT_FALSE(convexEdge(kFlat, {{0.03f, 0, 0.002f}, {0, 0, 1}}, {}));
}
TEST(ConvexEdge, StepMergesWithoutTheSmoothnessCheck) {
  SegmentationConfig config;
  config.smoothness_check = false;
  EXPECT_TRUE(convexEdge(kFlat, {{0.03f, 0, 0.002f}, {0, 0, 1}}, config));
}
// A patch to the +x side that leans toward -x closes up: concave.
TEST(ConvexEdge, EightDegreesConcaveMerges) {
  EXPECT_TRUE(convexEdge(kFlat, {{0.03f, 0, 0.002f}, tilted(-8)}, {}));
}
TEST(ConvexEdge, TwelveDegreesConcaveSplits) {
  EXPECT_FALSE(convexEdge(kFlat, {{0.03f, 0, 0.003f}, tilted(-12)}, {}));
}
TEST(ConvexEdge, TableHoldsInBothDirectionsAndWithSanityOff) {
  for (const bool sanity : {true, false}) {
    SegmentationConfig config;
    config.sanity_check = sanity;
    EXPECT_TRUE(convexEdge({{0.02f, 0, -0.02f}, {1, 0, 0}}, kFlat, config));
    EXPECT_FALSE(convexEdge({{0.02f, 0, 0.02f}, {-1, 0, 0}}, kFlat, config));
    EXPECT_TRUE(convexEdge({{0.03f, 0, 0}, {0, 0, 1}}, kFlat, config));
    EXPECT_FALSE(convexEdge({{0.03f, 0, 0.002f}, {0, 0, 1}}, kFlat, config));
    EXPECT_TRUE(convexEdge({{0.03f, 0, 0.002f}, tilted(-8)}, kFlat, config));
    EXPECT_FALSE(convexEdge({{0.03f, 0, 0.003f}, tilted(-12)}, kFlat, config));
  }
}
TEST(ConvexEdge, SanityCheckRefusesPatchesBesideTheLineTheyMeetIn) {
  // Normals at right angles, but the patches lie along the line in which their planes meet.
  const Patch other{{0, 0.02f, 0}, {1, 0, 0}};
  SegmentationConfig lenient;
  lenient.sanity_check = false;
  EXPECT_TRUE(convexEdge(kFlat, other, lenient));
  EXPECT_FALSE(convexEdge(kFlat, other, {}));
}

// ---- Box on a table

struct Scene {
  SurfaceCloud cloud;
  std::vector<char> part;  ///< 't' table, 'b' box

  void add(const Vector3f& p, const Vector3f& n, char which) {
    cloud.points.push_back(p);
    cloud.normals.push_back(n);
    part.push_back(which);
  }
};

/// Box 12 x 10 x 16 cm on a table of 60 x 60 cm, sampled at the map's voxel spacing, off its lattice.
Scene boxOnTable() {
  Scene scene;
  const float step = 3.0f / 512.0f;
  const float x = 0.06f, y = 0.05f, h = 0.16f;
  for (int i = -51; i <= 51; ++i)
    for (int j = -51; j <= 51; ++j) {
      const Vector3f p(i * step + 0.001f, j * step - 0.002f, 0);
      if (std::abs(p.x()) > x || std::abs(p.y()) > y)
        scene.add(p, Vector3f::UnitZ(), 't');
      else
        scene.add({p.x(), p.y(), h}, Vector3f::UnitZ(), 'b');
    }
  for (float z = step / 2; z < h; z += step) {
    for (float a = -x + step / 2; a < x; a += step) {
      scene.add({a, -y, z}, -Vector3f::UnitY(), 'b');
      scene.add({a, y, z}, Vector3f::UnitY(), 'b');
    }
    for (float a = -y + step / 2; a < y; a += step) {
      scene.add({-x, a, z}, -Vector3f::UnitX(), 'b');
      scene.add({x, a, z}, Vector3f::UnitX(), 'b');
    }
  }
  return scene;
}

std::uint32_t tableLabel(const Scene& scene, const Labels& labels) {
  std::map<std::uint32_t, int> votes;
  for (std::size_t i = 0; i < scene.part.size(); ++i) votes[labels.of_point[i]] += scene.part[i] == 't';
  return std::max_element(votes.begin(), votes.end(), [](auto& a, auto& b) { return a.second < b.second; })
      ->first;
}

double shareOutsideTable(const Scene& scene, const Labels& labels) {
  const std::uint32_t table = tableLabel(scene, labels);
  int box = 0, apart = 0;
  for (std::size_t i = 0; i < scene.part.size(); ++i) {
    box += scene.part[i] == 'b';
    apart += scene.part[i] == 'b' && labels.of_point[i] != table;
  }
  return static_cast<double>(apart) / box;
}

TEST(SegmentSurface, KeepsTheBoxApartFromTheTableBeforeSmallSegmentsAreMerged) {
  const Scene scene = boxOnTable();
  SegmentationConfig config;
  config.min_segment_supervoxels = 0;
  EXPECT_GE(shareOutsideTable(scene, segmentSurface(scene.cloud, config)), 0.98);
}

TEST(SegmentSurface, KeepsTheBoxApartFromTheTableAfterMerging) {
  const Scene scene = boxOnTable();
  const Labels labels = segmentSurface(scene.cloud, {});
  EXPECT_GE(shareOutsideTable(scene, labels), 0.97);
  EXPECT_GE(labels.count, 2u);
  EXPECT_GT(labels.supervoxels, labels.count);
}

TEST(SegmentSurface, HasABoundaryAlongTheBase) {
  const Scene scene = boxOnTable();
  const Labels labels = segmentSurface(scene.cloud, {});
  int base = 0, differs = 0;
  for (std::size_t i = 0; i < scene.part.size(); ++i) {
    const Vector3f& p = scene.cloud.points[i];
    if (scene.part[i] != 'b' || p.z() > 0.03f || p.z() < 0.01f) continue;
    ++base;
    differs += labels.of_point[i] != tableLabel(scene, labels);
  }
  ASSERT_GT(base, 100);
  EXPECT_GE(static_cast<double>(differs) / base, 0.97);
}

TEST(SegmentSurface, JoinsTheBoxIntoOneConvexSegment) {
  const Scene scene = boxOnTable();
  const Labels labels = segmentSurface(scene.cloud, {});
  std::map<std::uint32_t, int> votes;
  int box = 0;
  for (std::size_t i = 0; i < scene.part.size(); ++i) {
    if (scene.part[i] == 'b') ++votes[labels.of_point[i]], ++box;
  }
  int largest = 0;
  for (const auto& [label, count] : votes) largest = std::max(largest, count);
  EXPECT_GE(largest, 0.9 * box);
}

TEST(SegmentSurface, NumbersSegmentsInTheOrderOfFirstAppearanceWithoutGaps) {
  const Scene scene = boxOnTable();
  SegmentationConfig config;
  config.min_segment_supervoxels = 0;
  const Labels labels = segmentSurface(scene.cloud, config);
  std::uint32_t highest = 0;
  for (const std::uint32_t label : labels.of_point) {
    ASSERT_LE(label, highest + 1);
    highest = std::max(highest, label);
  }
  EXPECT_EQ(highest, labels.count);
  EXPECT_GT(labels.count, 0u);
}

TEST(SegmentSurface, IsTheSameInEveryRunWhateverTheHeapHolds) {
  const Scene scene = boxOnTable();
  const Labels expected = segmentSurface(scene.cloud, {});
  std::mt19937 random(1);
  std::vector<std::vector<char>> clutter;
  for (int run = 0; run < 4; ++run) {
    for (int i = 0; i < 20000; ++i) clutter.emplace_back(random() % 400);
    std::shuffle(clutter.begin(), clutter.end(), random);
    clutter.resize(clutter.size() / 2);
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1 + run % 2);
    const Labels again = segmentSurface(scene.cloud, {});
    EXPECT_EQ(again.of_point, expected.of_point);
    EXPECT_EQ(again.supervoxels, expected.supervoxels);
  }
}

// ---- Odd clouds

TEST(SegmentSurface, AnEmptyCloudHasNoSegments) {
  const Labels labels = segmentSurface({}, {});
  EXPECT_TRUE(labels.of_point.empty());
  EXPECT_EQ(labels.count, 0u);
}

TEST(SegmentSurface, ASinglePointAndCoincidentPointsDoNotFail) {
  SurfaceCloud one;
  one.points = {{0.1f, 0.2f, 0.3f}};
  one.normals = {Vector3f::UnitZ()};
  EXPECT_EQ(segmentSurface(one, {}).of_point.size(), 1u);
  SurfaceCloud same;
  same.points.assign(1000, {0.1f, 0.2f, 0.3f});
  same.normals.assign(1000, Vector3f::UnitZ());
  const Labels labels = segmentSurface(same, {});
  EXPECT_EQ(std::set<std::uint32_t>(labels.of_point.begin(), labels.of_point.end()).size(), 1u);
}

TEST(SegmentSurface, PointsWithoutPositionOrNormalHaveNoLabelAndChangeNothing) {
  const Scene scene = boxOnTable();
  const Labels expected = segmentSurface(scene.cloud, {});
  SurfaceCloud holed = scene.cloud;
  const std::vector<std::pair<Vector3f, Vector3f>> bad = {{{kNaN, 0, 0}, Vector3f::UnitZ()},
                                                          {{0, 0, 0}, {0, kNaN, 0}},
                                                          {{0, 0, 0}, {0, 0, 0}},
                                                          {{INFINITY, 0, 0}, Vector3f::UnitZ()}};
  for (const auto& [p, n] : bad) {
    holed.points.insert(holed.points.begin() + 100, p);
    holed.normals.insert(holed.normals.begin() + 100, n);
  }
  Labels labels = segmentSurface(holed, {});
  for (int k = 0; k < 4; ++k) EXPECT_EQ(labels.of_point[100 + k], 0u);
  labels.of_point.erase(labels.of_point.begin() + 100, labels.of_point.begin() + 104);
  EXPECT_EQ(labels.of_point, expected.of_point);
}

TEST(SegmentSurface, OnlyUnusablePointsGiveNoSegments) {
  SurfaceCloud cloud;
  cloud.points.assign(5, {kNaN, kNaN, kNaN});
  cloud.normals.assign(5, {kNaN, kNaN, kNaN});
  EXPECT_THAT(segmentSurface(cloud, {}).of_point, testing::Each(0u));
}

TEST(SegmentSurface, RefusesCloudsFarBeyondTheOctree) {
  SurfaceCloud cloud;
  cloud.points = {{0, 0, 0}, {1e7f, 0, 0}};
  cloud.normals.assign(2, Vector3f::UnitZ());
  EXPECT_THROW(segmentSurface(cloud, {}), std::runtime_error);
}

TEST(SegmentSurface, RefusesACloudWithoutNormals) {
  SurfaceCloud cloud;
  cloud.points.assign(3, Vector3f::Zero());
  EXPECT_THROW(segmentSurface(cloud, {}), std::invalid_argument);
}

TEST(SegmentationConfig, RefusesASeedBelowTheVoxel) {
  SegmentationConfig config;
  config.seed_m = 0.005;
  try {
    config.validate();
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("seed_m = 0.005"));
  }
}

}  // namespace
}  // namespace vantage
