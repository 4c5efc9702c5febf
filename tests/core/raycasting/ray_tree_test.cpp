#include "core/raycasting/ray_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "tests/core/raycasting/toy_scene.h"

namespace vantage {
namespace {

RaySensor kinect() {
  return {};
}

RaySensor timeOfFlight() {
  RaySensor sensor;
  sensor.horizontal_fov_rad = 0.77;
  sensor.vertical_fov_rad = 0.61;
  return sensor;
}

/// Smallest and largest leaf count of a level.
std::pair<std::uint32_t, std::uint32_t> leafRange(const RayLevel& level) {
  std::uint32_t low = level.leaves(0, 0), high = low;
  for (std::uint32_t j = 0; j < level.rows.count(); ++j)
    for (std::uint32_t k = 0; k < level.columns.count(); ++k) {
      low = std::min(low, level.leaves(j, k));
      high = std::max(high, level.leaves(j, k));
    }
  return {low, high};
}

std::uint64_t sumOfLeaves(const RayLevel& level) {
  std::uint64_t sum = 0;
  for (std::uint32_t j = 0; j < level.rows.count(); ++j)
    for (std::uint32_t k = 0; k < level.columns.count(); ++k) sum += level.leaves(j, k);
  return sum;
}

// Acceptance check 10.1.
TEST(RayTree, GridsOfTheKinectAreExact) {
  const RayTree tree(kinect(), 0.01, 4);
  const double step_mrad[] = {3.5714, 7.1429, 14.2862, 28.5753, 57.1740};
  const unsigned rows[] = {211, 106, 53, 27, 14}, columns[] = {279, 140, 70, 35, 18};
  const unsigned rays[] = {58869, 14840, 3710, 945, 252};
  for (int i = 0; i <= 4; ++i) {
    EXPECT_NEAR(tree.level(i).step_rad * 1e3, step_mrad[i], 5e-5);
    EXPECT_EQ(tree.level(i).rows.count(), rows[i]);
    EXPECT_EQ(tree.level(i).columns.count(), columns[i]);
    EXPECT_EQ(tree.level(i).count(), rays[i]);
  }
}

TEST(RayTree, GridsOfTheOtherSensorsAreExact) {
  const RayTree tof(timeOfFlight(), 0.01, 4);
  const unsigned tof_rays[] = {36936, 9288, 2322, 594, 154};
  for (int i = 0; i <= 4; ++i) EXPECT_EQ(tof.level(i).count(), tof_rays[i]);
  const RayTree toy(testing::toySensor(), testing::kToyVoxel, 3);
  const unsigned rows[] = {16, 8, 4, 2}, columns[] = {21, 11, 6, 3};
  for (int i = 0; i <= 3; ++i) {
    EXPECT_EQ(toy.level(i).rows.count(), rows[i]);
    EXPECT_EQ(toy.level(i).columns.count(), columns[i]);
  }
}

// Acceptance check 10.1, leaf counts.
TEST(RayTree, LeafCountsOfTheToySensorAreExact) {
  const RayTree toy(testing::toySensor(), testing::kToyVoxel, 3);
  EXPECT_EQ(leafRange(toy.level(0)), (std::pair{1u, 1u}));
  EXPECT_EQ(leafRange(toy.level(1)), (std::pair{2u, 6u}));
  EXPECT_EQ(leafRange(toy.level(2)), (std::pair{4u, 28u}));
  EXPECT_EQ(leafRange(toy.level(3)), (std::pair{40u, 88u}));
}

struct Case {
  RaySensor sensor;
  double voxel_m;
  int levels;
  std::uint64_t rays;
};
const Case kCases[] = {{kinect(), 0.01, 4, 58869},
                       {timeOfFlight(), 0.01, 4, 36936},
                       {testing::toySensor(), testing::kToyVoxel, 3, 336}};

// Acceptance check 10.2.
TEST(RayTree, LeavesOfEveryLevelAddUpToTheFinestRays) {
  for (const auto& [sensor, voxel, levels, rays] : kCases) {
    const RayTree tree(sensor, voxel, levels);
    for (int i = 0; i <= levels; ++i) EXPECT_EQ(sumOfLeaves(tree.level(i)), rays);
  }
}

void expectWholeFamilies(const RayTree& tree) {
  for (int i = 1; i <= tree.coarseLevels(); ++i) {
    const RayLevel &coarse = tree.level(i), &fine = tree.level(i - 1);
    const std::vector<std::uint32_t>& order = fine.families.ray;
    std::vector<int> parents(fine.count(), 0);
    ASSERT_EQ(coarse.families.family.size(), coarse.count());
    ASSERT_EQ(order.size(), fine.count());
    for (std::uint32_t n = 0; n < coarse.count(); ++n) {
      const RayFamily& family = coarse.families.family[n];
      const std::uint32_t j = coarse.families.ray[n] / coarse.columns.count();
      const std::uint32_t k = coarse.families.ray[n] % coarse.columns.count();
      ASSERT_GE(family.children, 1u);
      ASSERT_LE(family.children, coarse.families.most_children);
      EXPECT_EQ(family.leaves, coarse.leaves(j, k));
      for (std::uint32_t c = family.first_child; c < family.first_child + family.children; ++c) {
        ++parents[order[c]];
        EXPECT_EQ(fine.rows.parent[order[c] / fine.columns.count()], j);
        EXPECT_EQ(fine.columns.parent[order[c] % fine.columns.count()], k);
      }
    }
    EXPECT_EQ(std::count(parents.begin(), parents.end(), 1), static_cast<int>(fine.count()));
  }
}

TEST(RayTree, EveryRayHasOneParentAndEveryInnerRayAChild) {
  for (const Case& c : kCases)
    for (const RayAnchor anchor : {RayAnchor::Centered, RayAnchor::Literal}) {
      RaySensor sensor = c.sensor;
      sensor.anchor = anchor;
      expectWholeFamilies(RayTree(sensor, c.voxel_m, c.levels));
    }
}

// Acceptance check 10.2, literal anchoring.
TEST(RayTree, LiteralAnchorHasAtMostFourToTheMLeaves) {
  RaySensor sensor = kinect();
  sensor.anchor = RayAnchor::Literal;
  const RayTree tree(sensor, 0.01, 4);
  const unsigned most[] = {1, 4, 16, 64, 256};
  for (int i = 0; i <= 4; ++i) {
    const RayLevel& level = tree.level(i);
    EXPECT_EQ(leafRange(level).second, most[i]);
    EXPECT_DOUBLE_EQ(level.columns.angle_rad.front(), -sensor.horizontal_fov_rad / 2);
    EXPECT_DOUBLE_EQ(level.rows.angle_rad.front(), -sensor.vertical_fov_rad / 2);
    if (i == 0) continue;
    for (const RayAxis* axis : {&level.rows, &level.columns})
      for (std::uint32_t n = 0; n < axis->count(); ++n) {
        EXPECT_GE(axis->first_child[n + 1] - axis->first_child[n], 1u);
        EXPECT_LE(axis->first_child[n + 1] - axis->first_child[n], 2u);
      }
  }
}

/// Parents by the smallest angle between rays over the whole coarser level; rays within rounding of each
/// other are tied.
std::vector<std::uint32_t> parentsByBruteForce(const RayLevel& coarse, const RayLevel& fine) {
  std::vector<double> x, y, z;
  for (std::uint32_t j = 0; j < coarse.rows.count(); ++j)
    for (std::uint32_t k = 0; k < coarse.columns.count(); ++k) {
      const Eigen::Vector3d d = coarse.direction(j, k);
      x.push_back(d.x()), y.push_back(d.y()), z.push_back(d.z());
    }
  std::vector<std::uint32_t> parents;
  for (std::uint32_t j = 0; j < fine.rows.count(); ++j)
    for (std::uint32_t k = 0; k < fine.columns.count(); ++k) {
      const Eigen::Vector3d d = fine.direction(j, k);
      std::uint32_t best = 0;
      double best_cosine = -2.0;
      for (std::uint32_t i = 0; i < x.size(); ++i) {
        const double cosine = d.x() * x[i] + d.y() * y[i] + d.z() * z[i];
        if (cosine > best_cosine + 1e-14) best = i, best_cosine = cosine;
      }
      parents.push_back(best);
    }
  return parents;
}

TEST(RayTree, ParentsPerAxisAreTheNearestRaysOfAll) {
  const RayTree tree(kinect(), 0.01, 4);
  for (int i = 2; i <= 4; ++i) {
    const RayLevel &coarse = tree.level(i), &fine = tree.level(i - 1);
    const std::vector<std::uint32_t> expected = parentsByBruteForce(coarse, fine);
    std::vector<std::uint32_t> parents;
    for (const std::uint32_t row : fine.rows.parent)
      for (const std::uint32_t column : fine.columns.parent) parents.push_back(coarse.index(row, column));
    EXPECT_EQ(parents, expected) << "level " << i;
  }
}

TEST(RayTree, DirectionsAreUnitVectorsSymmetricAboutTheDirectorRayAndMatchTheSlopes) {
  const RayTree tree(kinect(), 0.01, 3);
  for (int i = 0; i <= 3; ++i) {
    const RayLevel& level = tree.level(i);
    const std::uint32_t rows = level.rows.count(), columns = level.columns.count();
    for (std::uint32_t j = 0; j < rows; ++j)
      for (std::uint32_t k = 0; k < columns; ++k) {
        const Eigen::Vector3d d = level.direction(j, k);
        EXPECT_NEAR(d.norm(), 1.0, 1e-15);
        const Eigen::Vector3d mirrored = level.direction(rows - 1 - j, columns - 1 - k);
        EXPECT_EQ(Eigen::Vector3d(-d.x(), -d.y(), d.z()), mirrored);
        EXPECT_FLOAT_EQ(level.slope_x[level.index(j, k)], static_cast<float>(d.x() / d.z()));
        EXPECT_FLOAT_EQ(level.slope_y[level.index(j, k)], static_cast<float>(d.y() / d.z()));
      }
    // Neighbours are one voxel apart at the end of the range.
    const double apart = 2.8 * std::sin(level.columns.angle_rad[1] - level.columns.angle_rad[0]);
    EXPECT_NEAR(apart, level.voxel_size_m, 1e-12);
  }
}

TEST(RayTree, TilesHoldEveryRayOnce) {
  const RayTree tree(kinect(), 0.01, 4);
  for (int i = 0; i <= 4; ++i) {
    const RayLevel& level = tree.level(i);
    std::vector<int> times(level.count(), 0);
    for (std::size_t n = 0; n < level.tiles.ray.size(); ++n) {
      const std::uint32_t ray = level.tiles.ray[n];
      EXPECT_EQ(level.tiles.slope_x[n], level.slope_x[ray]);
      EXPECT_EQ(level.tiles.slope_y[n], level.slope_y[ray]);
      const std::uint32_t place = level.tiles.place[n];
      EXPECT_EQ(level.families.ray[place], ray);
      EXPECT_EQ(level.families.slope_x[place], level.slope_x[ray]);
      EXPECT_EQ(level.families.slope_y[place], level.slope_y[ray]);
      times[ray] += (level.tiles.lanes[n / 16] >> (n % 16)) & 1;
    }
    EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<int>(level.count()));
  }
}

TEST(RayTree, RefusesLevelsWithoutTwoRaysPerAxis) {
  // 2.8 m sin(43 deg) = 1.91 m: 1.28 m is the largest.
  EXPECT_EQ(maxCoarseLevels(kinect(), 0.01), 7);
  EXPECT_NO_THROW(RayTree(kinect(), 0.01, 7));
  EXPECT_THROW(RayTree(kinect(), 0.01, 8), std::invalid_argument);
  EXPECT_THROW(RayTree(kinect(), 0.01, -1), std::invalid_argument);
  const RayTree two(kinect(), 1.9, 0);
  EXPECT_EQ(two.level(0).rows.count(), 2u);
  EXPECT_EQ(maxCoarseLevels(kinect(), 2.0), -1);
  EXPECT_THROW(RayTree(kinect(), 2.0, 0), std::invalid_argument);
  EXPECT_THROW(RayTree(kinect(), 0.0, 0), std::invalid_argument);
}

TEST(RayTree, RefusesSensorsOutOfRange) {
  const auto broken = [](auto change) {
    RaySensor sensor;
    change(sensor);
    return sensor;
  };
  EXPECT_THROW(broken([](RaySensor& s) { s.horizontal_fov_rad = std::numbers::pi; }).validate(),
               std::invalid_argument);
  EXPECT_THROW(broken([](RaySensor& s) { s.vertical_fov_rad = 0; }).validate(), std::invalid_argument);
  EXPECT_THROW(broken([](RaySensor& s) { s.min_range_m = -0.1; }).validate(), std::invalid_argument);
  EXPECT_THROW(broken([](RaySensor& s) { s.max_range_m = s.min_range_m; }).validate(), std::invalid_argument);
  EXPECT_THROW(broken([](RaySensor& s) { s.max_range_m = std::nan(""); }).validate(), std::invalid_argument);
  EXPECT_THROW(RayTree(broken([](RaySensor& s) { s.max_range_m = 900; }), 0.01, 0), std::invalid_argument);
  EXPECT_NO_THROW(RaySensor{}.validate());
}

}  // namespace
}  // namespace vantage
