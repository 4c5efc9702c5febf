#include "core/perception/depth_filters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <numbers>
#include <random>
#include <set>

#include "core/geometry/check.h"

namespace vantage {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kDegree = std::numbers::pi / 180.0;
const PinholeCamera kKinect;

DepthImage flat(float z, const PinholeCamera& camera = kKinect) {
  DepthImage depth(camera.width, camera.height);
  std::ranges::fill(depth.depth_m, z);
  return depth;
}

/// An object in front of a background: columns `first` to `last`, rows `top` to `bottom`.
DepthImage step(float near, float far, int first, int last, int top = 0, int bottom = kKinect.height - 1) {
  DepthImage depth = flat(far);
  for (int v = top; v <= bottom; ++v)
    for (int u = first; u <= last; ++u) depth.at(u, v) = near;
  return depth;
}

std::vector<std::uint8_t> maskOf(const DepthImage& depth, const DepthFilterConfig& config) {
  return filterDepth(depth, kKinect, config).mask;
}

DepthFilterConfig only(bool DepthFilterConfig::*filter) {
  DepthFilterConfig config;
  config.*filter = true;
  return config;
}
const DepthFilterConfig kShadowOnly = only(&DepthFilterConfig::shadow),
                        kVeilOnly = only(&DepthFilterConfig::veil);

/// Columns in which every row of the mask is set.
std::set<int> columns(const std::vector<std::uint8_t>& mask) {
  std::set<int> marked;
  for (int u = 0; u < kKinect.width; ++u) {
    int rows = 0;
    for (int v = 0; v < kKinect.height; ++v)
      rows += mask[static_cast<std::size_t>(v) * kKinect.width + u] != 0;
    EXPECT_TRUE(rows == 0 || rows == kKinect.height) << "column " << u;
    if (rows > 0) marked.insert(u);
  }
  return marked;
}

std::set<int> from(int first, int last) {
  std::set<int> all;
  for (int u = first; u <= last; ++u) all.insert(u);
  return all;
}

TEST(ShadowFilter, RemovesTheStripBesideAnObject) {  // 12.7
  EXPECT_EQ(columns(maskOf(step(1.0f, 2.5f, 236, 275), kShadowOnly)), from(276, 292));
  EXPECT_EQ(columns(maskOf(step(0.8f, 1.6f, 200, 260), kShadowOnly)), from(261, 278));
  EXPECT_EQ(columns(maskOf(step(1.0f, 1.2f, 236, 260), kShadowOnly)), from(261, 264));
}

TEST(ShadowFilter, MirrorsForAnEmitterOnTheRight) {  // 12.7, D-B20
  DepthFilterConfig right = kShadowOnly;
  right.emitter_side = EmitterSide::Right;
  EXPECT_EQ(columns(maskOf(step(1.0f, 2.5f, 236, 275), right)), from(219, 235));
}

TEST(ShadowFilter, InvalidPixelsInTheShadowChangeNothing) {  // 12.7, D-B21
  DepthImage depth = step(1.0f, 2.5f, 236, 275);
  const float invalid[] = {DepthImage::kInvalid, 0.0f, -1.0f, std::numeric_limits<float>::infinity()};
  for (int i = 0; i < 4; ++i) depth.at(280 + i, 100) = invalid[i];
  std::vector<std::uint8_t> mask = maskOf(depth, kShadowOnly);
  const std::size_t row = 100u * kKinect.width;
  for (int u = 280; u < 284; ++u) EXPECT_EQ(mask[row + u], depth_mask::kInvalid);
  for (int u = 280; u < 284; ++u) mask[row + u] = depth_mask::kShadow;
  EXPECT_EQ(columns(mask), from(276, 292));
}

TEST(VeilFilter, RemovesBothSidesOfAStep) {  // 12.8
  const std::vector<std::uint8_t> mask = maskOf(step(1.0f, 2.5f, 236, 275), kVeilOnly);
  EXPECT_THAT(columns(mask), ElementsAre(235, 236, 275, 276));
  EXPECT_EQ(countMask(mask).veil, 1696u);
}

TEST(DepthFilters, CountOfAnObjectWithAllItsSides) {  // 12.8
  DepthFilterConfig both = kShadowOnly;
  both.veil = true;
  const DepthImage depth = step(1.0f, 2.5f, 236, 275, 112, 311);
  const MaskCounts counts = countMask(maskOf(depth, both));
  EXPECT_EQ(counts.shadow + counts.both, 3400u);
  EXPECT_EQ(counts.veil + counts.both, 956u);
  EXPECT_EQ(counts.removed(), 4156u);
  EXPECT_EQ(counts.kept, 212932u);
}

/// Smallest step between a column and the next one at which the near and the far pixel go, mm.
std::pair<double, double> smallestSteps(float z, int column) {
  std::pair<double, double> smallest{0.0, 0.0};
  const int v = 211;
  for (double mm = 60.0; mm > 1.0; mm -= 0.1) {
    DepthImage depth = flat(z);
    for (int u = column + 1; u < kKinect.width; ++u) depth.at(u, v) = z + static_cast<float>(mm / 1000);
    // The rows above and below are steps too; the row alone has none.
    DepthImage row(kKinect.width, 1);
    PinholeCamera camera = kKinect;
    camera.height = 1;
    camera.cy = kKinect.cy - v;
    std::copy_n(depth.depth_m.begin() + static_cast<std::ptrdiff_t>(v) * depth.width, depth.width,
                row.depth_m.begin());
    const auto mask = filterDepth(row, camera, kVeilOnly).mask;
    if (mask[column]) smallest.first = mm;
    if (mask[column + 1]) smallest.second = mm;
  }
  return smallest;
}

TEST(VeilFilter, SmallestStepThatIsRemoved) {  // 12.8
  struct {
    float z;
    int column;
    double near_mm, far_mm;
  } const cases[] = {{1.0f, 255, 15.8, 15.5},
                     {1.0f, 300, 15.2, 15.0},
                     {1.0f, 400, 12.7, 12.5},
                     {1.0f, 500, 9.6, 9.4},
                     {2.5f, 255, 39.5, 38.8}};
  for (const auto& c : cases) {
    const auto [near_mm, far_mm] = smallestSteps(c.z, c.column);
    EXPECT_NEAR(near_mm, c.near_mm, 0.11) << c.z << " m, column " << c.column;
    EXPECT_NEAR(far_mm, c.far_mm, 0.11) << c.z << " m, column " << c.column;
  }
}

/// A plane through (0, 0, 1) whose normal is turned by `incidence` from the optical axis, about y.
DepthImage slanted(double incidence_rad) {
  DepthImage depth(kKinect.width, kKinect.height);
  for (int v = 0; v < depth.height; ++v)
    for (int u = 0; u < depth.width; ++u) {
      const double z = 1.0 / (1.0 - std::tan(incidence_rad) * (u - 255.0) / kKinect.fx);
      if (z > 0.0 && z < 8.0) depth.at(u, v) = static_cast<float>(z);
    }
  return depth;
}

TEST(VeilFilter, PlanesGoFromEightyDegreesOn) {  // 12.8
  PinholeCamera camera = kKinect;
  camera.cx = 255.0;
  const auto center = [&](double degrees) {
    return filterDepth(slanted(degrees * kDegree), camera, kVeilOnly).mask[211u * kKinect.width + 255];
  };
  EXPECT_EQ(center(79.9), 0);
  EXPECT_EQ(center(80.1), depth_mask::kVeil);
}

TEST(EdgeFilter, RemovesWhatHangsBetweenTheSidesAndNothingElse) {
  DepthImage depth = step(1.0f, 2.5f, 236, 275);
  for (int v = 0; v < depth.height; ++v) depth.at(276, v) = 1.7f;
  const auto mask = maskOf(depth, only(&DepthFilterConfig::edge_aware));
  EXPECT_THAT(columns(mask), ElementsAre(276));
  EXPECT_EQ(countMask(mask).edge, 424u);
}

TEST(BilateralFilter, SmoothsNoiseAndKeepsSteps) {
  DepthImage depth = step(1.0f, 2.5f, 236, 275);
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0.0f, 0.003f);
  for (float& z : depth.depth_m) z += noise(random);
  const DepthImage smooth = bilateralFiltered(depth, {});
  double before = 0.0, after = 0.0;
  for (int v = 10; v < 400; ++v)
    for (int u = 300; u < 500; ++u) {
      before += std::pow(depth.at(u, v) - 2.5, 2);
      after += std::pow(smooth.at(u, v) - 2.5, 2);
    }
  EXPECT_LT(after, 0.25 * before);
  for (int v = 10; v < 400; ++v) {
    EXPECT_NEAR(smooth.at(275, v), 1.0f, 0.015f);
    EXPECT_NEAR(smooth.at(276, v), 2.5f, 0.015f);
  }
}

TEST(BilateralFilter, InvalidPixelsStaySoAndHaveNoWeight) {
  DepthImage depth = flat(1.0f);
  std::mt19937 random(3);
  for (float& z : depth.depth_m)
    if (random() % 3 == 0) z = DepthImage::kInvalid;
  const DepthImage smooth = bilateralFiltered(depth, {});
  for (std::size_t i = 0; i < depth.depth_m.size(); ++i) {
    ASSERT_EQ(std::isnan(smooth.depth_m[i]), std::isnan(depth.depth_m[i]));
    if (std::isnan(depth.depth_m[i])) continue;
    ASSERT_NEAR(smooth.depth_m[i], 1.0f, 1e-5f);
  }
}

TEST(DepthFilters, AllInvalidStaysAllInvalid) {
  DepthFilterConfig all = paperDepthFilters();
  all.edge_aware = true;
  const FilteredDepth result = filterDepth(DepthImage(512, 424), kKinect, all);
  EXPECT_EQ(countMask(result.mask).invalid, 512u * 424u);
  for (const float z : result.depth.depth_m) ASSERT_TRUE(std::isnan(z));
}

TEST(DepthFilters, OneRowAndOnePixelAreImagesToo) {
  PinholeCamera line = kKinect;
  line.height = 1;
  line.cy = 0.0;
  DepthImage row(512, 1);
  for (int u = 0; u < 512; ++u) row.at(u, 0) = u >= 236 && u <= 275 ? 1.0f : 2.5f;
  DepthFilterConfig all = paperDepthFilters();
  all.edge_aware = true;
  const MaskCounts counts = countMask(filterDepth(row, line, all).mask);
  EXPECT_EQ(counts.shadow + counts.both, 17u);
  EXPECT_EQ(counts.veil + counts.both, 4u);
  PinholeCamera dot = line;
  dot.width = 1;
  dot.cx = 0.0;
  DepthImage pixel(1, 1);
  pixel.at(0, 0) = 1.0f;
  EXPECT_EQ(countMask(filterDepth(pixel, dot, all).mask).kept, 1u);
}

TEST(DepthFilters, NothingSwitchedOnChangesNothing) {
  const DepthImage depth = step(1.0f, 2.5f, 236, 275);
  const FilteredDepth result = filterDepth(depth, kKinect, {});
  EXPECT_EQ(result.depth.depth_m, depth.depth_m);
  EXPECT_EQ(countMask(result.mask).removed(), 0u);
  EXPECT_THAT(filterDepth({}, kKinect, paperDepthFilters()).mask, IsEmpty());
}

TEST(DepthFilters, AnyNumberOfThreadsGivesTheSame) {
  DepthImage depth = step(1.0f, 2.5f, 236, 275, 112, 311);
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0.0f, 0.01f);
  for (float& z : depth.depth_m) z = random() % 50 == 0 ? DepthImage::kInvalid : z + noise(random);
  DepthFilterConfig all = paperDepthFilters();
  all.edge_aware = true;
  const auto withThreads = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return filterDepth(depth, kKinect, all);
  };
  const FilteredDepth one = withThreads(1), four = withThreads(4);
  EXPECT_EQ(one.mask, four.mask);
  for (std::size_t i = 0; i < one.mask.size(); ++i)
    ASSERT_TRUE(one.depth.depth_m[i] == four.depth.depth_m[i] || std::isnan(one.depth.depth_m[i]));
}

TEST(DepthFilters, RefuseWhatCannotBe) {
  const DepthImage depth = flat(1.0f);
  PinholeCamera other = kKinect;
  other.width = 640;
  EXPECT_THROW(filterDepth(depth, other, {}), std::invalid_argument);
  PinholeCamera blind = kKinect;
  blind.fx = 0.0;
  EXPECT_THROW(filterDepth(depth, blind, {}), std::invalid_argument);
  DepthFilterConfig config = paperDepthFilters();
  config.emitter_offset_m = 0.0;
  EXPECT_THROW(filterDepth(depth, kKinect, config), OutOfRange);
  config = paperDepthFilters();
  config.veil_angle_rad = 2.0;
  EXPECT_THROW(filterDepth(depth, kKinect, config), OutOfRange);
}

}  // namespace
}  // namespace vantage
