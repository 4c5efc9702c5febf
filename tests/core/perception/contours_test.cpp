#include "core/perception/contours.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <functional>
#include <numbers>
#include <random>
#include <set>

#include "tests/core/perception/contour_reference.h"
#include "tests/core/perception/half_observed.h"

namespace vantage {
namespace {

using namespace test;

constexpr double kDegree = std::numbers::pi / 180.0;

std::vector<Eigen::Vector3i> indices(const Contours& contours) {
  std::vector<Eigen::Vector3i> result;
  for (const ContourVoxel& v : contours.voxels) result.push_back(v.voxel);
  return result;
}

const ContourVoxel& at(const Contours& contours, int x, int y, int z) {
  for (const ContourVoxel& v : contours.voxels)
    if (v.voxel == Eigen::Vector3i(x, y, z)) return v;
  throw std::out_of_range("no contour voxel there");
}

double angleDeg(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return std::acos(std::clamp<double>(a.cast<double>().normalized().dot(b.cast<double>().normalized()), -1.0,
                                      1.0)) /
         kDegree;
}

void expectVector(const Eigen::Vector3f& v, double x, double y, double z, double tolerance) {
  EXPECT_NEAR(v.x(), x, tolerance);
  EXPECT_NEAR(v.y(), y, tolerance);
  EXPECT_NEAR(v.z(), z, tolerance);
}

// ---- 12.1 Half-observed box

TEST(HalfObservedBox, Has44ContourVoxelsInTheRingAroundTheFootprintWithoutItsCorners) {
  const Contours contours = extractContours(referenceBox(), {});
  ASSERT_EQ(contours.voxels.size(), 44u);
  for (const ContourVoxel& v : contours.voxels) {
    const int x = v.voxel.x(), y = v.voxel.y();
    EXPECT_EQ(v.voxel.z(), 17);
    const bool beside_x = (x == 13 || x == 26) && y >= 15 && y <= 24;
    const bool beside_y = (y == 14 || y == 25) && x >= 14 && x <= 25;
    EXPECT_TRUE(beside_x != beside_y) << x << ' ' << y;
  }
}

TEST(HalfObservedBox, SixNeighboursForOccupiedFindNothing) {
  ContourConfig config;
  config.occupied_six_neighbours = true;
  EXPECT_EQ(extractContours(referenceBox(), config).voxels.size(), 0u);
}

TEST(HalfObservedBox, TwentySixNeighboursForOccupiedFindTheSame44) {
  const TsdfVolume box = referenceBox();
  EXPECT_EQ(referenceContourVoxels(box, 5, N6, N26), indices(extractContours(box, {})));
}

TEST(HalfObservedBox, EighteenNeighboursForUnknownDoubleTheThickness) {
  ContourConfig config;
  config.unknown_eighteen_neighbours = true;
  EXPECT_EQ(extractContours(referenceBox(), config).voxels.size(), 88u);
}

TEST(HalfObservedBox, WeightFourEverywhereGivesNoContour) {
  EXPECT_EQ(extractContours(referenceBox(4), {}).voxels.size(), 0u);
}

TEST(HalfObservedBox, RawNormalBesideAFaceFollowsTheObservationWeight) {
  for (const auto& [weight, raw] :
       {std::pair{5, 30.689}, {7, 42.965}, {10, 61.378}, {20, 61.378}, {128, 61.378}}) {
    const Contours contours = extractContours(referenceBox(weight), {});
    const ContourVoxel& v = at(contours, 26, 20, 17);
    expectVector(v.raw_normal, raw, 0, 0, 1e-3);
    expectVector(v.normal, 1, 0, 0, 1e-6);
  }
}

TEST(HalfObservedBox, NormalsPointAwayFromEveryFace) {
  const Contours contours = extractContours(referenceBox(), {});
  expectVector(at(contours, 13, 20, 17).normal, -1, 0, 0, 1e-6);
  expectVector(at(contours, 19, 25, 17).normal, 0, 1, 0, 1e-6);
}

TEST(HalfObservedBox, NormalNextToACornerLeansOutward) {
  const Contours contours = extractContours(referenceBox(), {});
  expectVector(at(contours, 26, 24, 17).raw_normal, 42.760, 18.618, 0, 1e-3);
  expectVector(at(contours, 26, 24, 17).normal, 0.9169, 0.3992, 0, 1e-4);
}

TEST(HalfObservedBox, SurfaceNormalInsideTheFaceIsAtRightAnglesToAll44FrontierNormals) {
  const TsdfVolume box = referenceBox();
  const Eigen::Vector3f surface = tsdfGradient(box, {19, 20, 12}).normalized();
  expectVector(surface, 0, 0, -1, 1e-6);
  const Contours contours = extractContours(box, {});
  ASSERT_EQ(contours.voxels.size(), 44u);
  for (const ContourVoxel& v : contours.voxels) EXPECT_NEAR(angleDeg(surface, v.normal), 90.0, 1e-3);
}

TEST(HalfObservedBox, SurfaceNormalAtTheRimIsBentOutward) {
  const TsdfVolume box = referenceBox();
  expectVector(tsdfGradient(box, {25, 20, 12}).normalized(), 0.942, 0, -0.335, 1e-3);
  expectVector(tsdfGradient(box, {25, 20, 16}, false).normalized(), 0.940, 0, 0.342, 1e-3);
}

TEST(HalfObservedBox, SurfaceNormalIgnoresUnknownNeighboursByDefault) {
  // One-sided in z: (16 - 15) / -5.12 doubled, so that both axes span two voxels.
  const Eigen::Vector3f n = tsdfGradient(referenceBox(), {25, 20, 16});
  expectVector(n, 1.0 + 4.5 / 5.12, 0, -2.0 / 5.12, 1e-4);
}

TEST(HalfObservedBox, ViewBLooksAgainstTheSurfaceAtTheClosestOccupiedVoxel) {
  const TsdfVolume box = referenceBox();
  ContourConfig config;
  config.normal = ContourNormal::Surface;
  const Contours contours = extractContours(box, config);
  EXPECT_EQ(indices(contours), indices(extractContours(box, {})));
  ASSERT_EQ(contours.voxels.size(), 44u);
  expectVector(at(contours, 26, 20, 17).raw_normal, 1.0 + 4.5 / 5.12, 0, -2.0 / 5.12, 1e-4);
  for (const ContourVoxel& v : contours.voxels) {
    EXPECT_NEAR(v.normal.norm(), 1.0, 1e-5);
    // Bent back toward the first view, against 0 of the frontier normals.
    EXPECT_LT(v.normal.z(), -0.1);
  }
}

TEST(HalfObservedBox, OfTwoOccupiedNeighboursTheCloserOneGivesTheNormal) {
  TsdfVolume box = referenceBox();
  const Eigen::Vector3i beside(26, 20, 16);  // shares a face with (26, 20, 17); (25, 20, 16) only an edge
  box.at(beside) = TsdfVoxel{-6000, 20};
  ContourConfig config;
  config.normal = ContourNormal::Surface;
  const ContourVoxel& voxel = at(extractContours(box, config), 26, 20, 17);
  const Eigen::Vector3f expected = tsdfGradient(box, beside);
  expectVector(voxel.raw_normal, expected.x(), expected.y(), expected.z(), 1e-6);
}

// ---- 12.2 Rounded object

struct RoundedCase {
  double radius;
  std::size_t voxels;
  double mean_deg, max_deg;
};
class RoundedObject : public testing::TestWithParam<RoundedCase> {};

TEST_P(RoundedObject, FrontierNormalsStayNearTheRadialDirection) {
  const Contours contours = extractContours(halfObservedSphere(GetParam().radius), {});
  ASSERT_EQ(contours.voxels.size(), GetParam().voxels);
  double sum = 0.0, max = 0.0;
  for (const ContourVoxel& v : contours.voxels) {
    const double angle = angleDeg(v.normal, v.voxel.cast<float>() - Eigen::Vector3f::Constant(31.5f));
    sum += angle;
    max = std::max(max, angle);
  }
  EXPECT_NEAR(sum / contours.voxels.size(), GetParam().mean_deg, 0.5);
  EXPECT_NEAR(max, GetParam().max_deg, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Spec, RoundedObject,
                         testing::Values(RoundedCase{10, 92, 17.1, 26.5}, RoundedCase{20, 228, 11.8, 20.7},
                                         RoundedCase{25, 336, 9.7, 18.7}));

// ---- 12.3 Reduction

struct ReductionCase {
  double distance_m, angle_deg;
  std::size_t points;
};
class Reduction : public testing::TestWithParam<ReductionCase> {};

TEST_P(Reduction, OfTheReferenceBox) {
  ContourConfig config;
  config.group_distance_m = GetParam().distance_m;
  config.group_angle_rad = GetParam().angle_deg * kDegree;
  EXPECT_EQ(extractContours(referenceBox(), config).points.size(), GetParam().points);
}

INSTANTIATE_TEST_SUITE_P(Spec, Reduction,
                         testing::Values(ReductionCase{0.02, 30, 12}, ReductionCase{0.03, 30, 8},
                                         ReductionCase{0.02, 15, 18}, ReductionCase{0.012, 30, 16}));

TEST(ReductionOfTheReferenceBox, TransitiveGrowthWouldLeaveOnlyFourPoints) {
  const Contours contours = extractContours(referenceBox(), {});
  EXPECT_EQ(transitiveGroups(contours.voxels, kVoxel, {}), 4);
  EXPECT_EQ(contours.points.size(), 12u);
}

TEST(ReductionOfALargerBox, Gives28PointsFrom108Voxels) {
  const Contours contours = extractContours(halfObservedBox(70, 60, 40, 18, 51, 20, 39), {});
  EXPECT_EQ(contours.voxels.size(), 108u);
  EXPECT_EQ(contours.points.size(), 28u);
}

TEST(ReductionOfTheReferenceBox, LiteralEquationSevenIsNotWhatHappens) {
  // |n1.n2| < cos 30 deg would reject identical normals, so every voxel would be a point of its own.
  const Contours contours = extractContours(referenceBox(), {});
  bool identical_normals_share_a_point = false;
  for (const ContourVoxel& a : contours.voxels)
    for (const ContourVoxel& b : contours.voxels)
      if (a.voxel != b.voxel && a.group == b.group && a.normal.dot(b.normal) > 0.999999f)
        identical_normals_share_a_point = true;
  EXPECT_TRUE(identical_normals_share_a_point);
}

TEST(Reduction, PointsAreTheMeansOfTheirGroups) {
  const TsdfVolume sphere = halfObservedSphere(20);
  const Contours contours = extractContours(sphere, {});
  ASSERT_FALSE(contours.points.empty());
  std::vector<Eigen::Vector3d> position(contours.points.size(), Eigen::Vector3d::Zero()), normal = position;
  std::vector<std::uint32_t> count(contours.points.size(), 0);
  for (const ContourVoxel& v : contours.voxels) {
    ASSERT_LT(v.group, contours.points.size());
    position[v.group] += sphere.geometry().center(v.voxel);
    normal[v.group] += v.normal.cast<double>();
    ++count[v.group];
  }
  for (std::size_t i = 0; i < contours.points.size(); ++i) {
    EXPECT_EQ(contours.points[i].voxels, count[i]);
    EXPECT_LT((contours.points[i].position_m - position[i] / count[i]).norm(), 1e-12);
    EXPECT_LT((contours.points[i].normal - normal[i].normalized()).norm(), 1e-12);
  }
}

TEST(Reduction, NoVoxelIsFartherFromItsSeedThanTheLimits) {
  const TsdfVolume sphere = halfObservedSphere(25);
  const ContourConfig config;
  const Contours contours = extractContours(sphere, config);
  std::vector<const ContourVoxel*> seed(contours.points.size(), nullptr);
  for (const ContourVoxel& v : contours.voxels) {
    if (!seed[v.group]) seed[v.group] = &v;  // the lowest index of a group is its seed
    const double distance = kVoxel * (v.voxel - seed[v.group]->voxel).cast<double>().norm();
    EXPECT_LT(distance, config.group_distance_m);
    EXPECT_LT(angleDeg(v.normal, seed[v.group]->normal), 30.0 + 1e-4);
  }
}

// ---- Fast pass against the plain one

TsdfVolume randomVolume(int nx, int ny, int nz, unsigned seed) {
  TsdfVolume volume = emptyVolume(nx, ny, nz);
  std::mt19937 random(seed);
  for (TsdfVoxel& v : volume.voxels()) {
    const unsigned kind = random() % 8;
    const int weight = kind == 0 ? static_cast<int>(random() % 5) : static_cast<int>(5 + random() % 30);
    v = tsdf(static_cast<int>(random() % 5) / 2.0 - (kind == 1 ? 2.0 : 0.0), weight);
  }
  return volume;
}

TEST(ExtractContours, AgreesWithThePlainLoopOnRandomVolumesOfAnyWidth) {
  std::size_t total = 0;
  for (const int nx : {3, 4, 17, 63, 64, 65, 66, 127, 128, 129, 130}) {
    const TsdfVolume volume = randomVolume(nx, 9, 7, 100 + nx);
    const auto expected = referenceContourVoxels(volume, 5);
    EXPECT_EQ(indices(extractContours(volume, {})), expected) << nx;
    total += expected.size();

    ContourConfig ablation;
    ablation.occupied_six_neighbours = true;
    EXPECT_EQ(indices(extractContours(volume, ablation)), referenceContourVoxels(volume, 5, N6, N6)) << nx;
    ablation.unknown_eighteen_neighbours = true;
    EXPECT_EQ(indices(extractContours(volume, ablation)), referenceContourVoxels(volume, 5, N18, N6)) << nx;
  }
  EXPECT_GT(total, 100u);
}

TEST(ExtractContours, LeavesOutTheOuterVoxelLayer) {
  const TsdfVolume volume = randomVolume(20, 20, 20, 7);
  const Contours contours = extractContours(volume, {});
  ASSERT_FALSE(contours.voxels.empty());
  for (const ContourVoxel& v : contours.voxels) {
    EXPECT_GE(v.voxel.minCoeff(), 1);
    EXPECT_LE(v.voxel.maxCoeff(), 18);
  }
}

TEST(ExtractContours, DropsVoxelsWhoseNormalCancels) {
  // Unknown and occupied placed symmetrically about the empty centre.
  TsdfVolume volume = emptyVolume(3, 3, 3, tsdf(1.0, 5));
  volume.at(0, 1, 1) = volume.at(2, 1, 1) = TsdfVoxel{};
  volume.at(1, 0, 1) = volume.at(1, 2, 1) = tsdf(-1.0, 20);
  ASSERT_EQ(referenceContourVoxels(volume, 5).size(), 1u);
  EXPECT_TRUE(extractContours(volume, {}).voxels.empty());
}

TEST(ExtractContours, IsTheSameForOneAndTwoThreads) {
  const TsdfVolume volume = randomVolume(70, 40, 30, 3);
  std::vector<Contours> results;
  for (const int threads : {1, 2, 2}) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(extractContours(volume, {}));
  }
  for (const Contours& other : results) {
    ASSERT_EQ(indices(other), indices(results[0]));
    ASSERT_EQ(other.points.size(), results[0].points.size());
    for (std::size_t i = 0; i < other.points.size(); ++i) {
      EXPECT_EQ(other.points[i].position_m, results[0].points[i].position_m);
      EXPECT_EQ(other.points[i].normal, results[0].points[i].normal);
    }
  }
}

TEST(ExtractContours, FindsNothingInAnUnknownOrTinyMap) {
  EXPECT_TRUE(extractContours(emptyVolume(20, 20, 20), {}).voxels.empty());
  EXPECT_TRUE(extractContours(emptyVolume(2, 2, 2), {}).points.empty());
  EXPECT_TRUE(extractContours(TsdfVolume(), {}).points.empty());
}

TEST(ContourConfig, RefusesValuesOutOfRangeByName) {
  for (const auto& [field, change] : std::vector<std::pair<std::string, std::function<void(ContourConfig&)>>>{
           {"weight_threshold", [](auto& c) { c.weight_threshold = 0; }},
           {"group_distance_m", [](auto& c) { c.group_distance_m = 0.0; }},
           {"group_angle_rad", [](auto& c) { c.group_angle_rad = 4.0; }},
           {"group_distance_m", [](auto& c) { c.group_distance_m = std::nan(""); }}}) {
    ContourConfig config;
    change(config);
    try {
      extractContours(emptyVolume(4, 4, 4), config);
      FAIL() << field;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(field));
    }
  }
}

TEST(TsdfGradient, IsOneSidedAtTheBorderOfTheVolume) {
  TsdfVolume volume = emptyVolume(4, 4, 4);
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) volume.at(i, j, k) = tsdf(0.1 * i - 0.2, 9);
  for (int i = 0; i < 4; ++i) expectVector(tsdfGradient(volume, {i, 0, 3}), 0.2, 0, 0, 1e-4);
}

}  // namespace
}  // namespace vantage
