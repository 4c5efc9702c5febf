#include "core/volume/occupancy_octree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "core/volume/octree_nodes.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using Vector = Eigen::Vector3d;
using Voxel = Eigen::Vector3i;

const OccupancyConfig kConfig;
const float kHit = static_cast<float>(logOddsOf(0.7)), kMiss = static_cast<float>(logOddsOf(0.4));

/// A cube of n^3 voxels of 10 cm whose corner is the world's origin, so that nodes lie at its multiples.
GridGeometry cube(int n) {
  return OccupancyOctree::gridAround(Box(Vector::Zero(), Vector::Constant(0.1 * n)), 0.1);
}

/// Everything unknown and not stored.
OccupancyOctree emptyMap(int n, OccupancyConfig config = {}) {
  return {cube(n), Box(), VoxelState::Unknown, config};
}

TEST(OccupancyLabel, FollowsHitsAndMissesOfSection103) {
  EXPECT_NEAR(probabilityOf(kHit + kMiss), 0.6087, 5e-5);
  EXPECT_EQ(occupancyLabel(kHit + kMiss, kConfig), VoxelState::Occupied);
  EXPECT_NEAR(probabilityOf(kHit + 2 * kMiss), 0.5091, 5e-5);
  EXPECT_EQ(occupancyLabel(kHit + 2 * kMiss, kConfig), VoxelState::Unknown);
  EXPECT_NEAR(probabilityOf(kHit + 3 * kMiss), 0.4088, 5e-5);
  EXPECT_EQ(occupancyLabel(kHit + 3 * kMiss, kConfig), VoxelState::Free);
  EXPECT_GE(5 * kHit, logOddsOf(kConfig.clamp_max));
  EXPECT_LT(4 * kHit, logOddsOf(kConfig.clamp_max));
  EXPECT_LE(5 * kMiss, logOddsOf(kConfig.clamp_min));
  EXPECT_GT(4 * kMiss, logOddsOf(kConfig.clamp_min));
}

TEST(OccupancyLabel, UsesTheBandSoThatOneHalfIsUnknown) {  // D-A7
  EXPECT_EQ(occupancyLabel(0.0, kConfig), VoxelState::Unknown);
  EXPECT_EQ(occupancyLabel(kHit, kConfig), VoxelState::Occupied);
  EXPECT_EQ(occupancyLabel(kMiss, kConfig), VoxelState::Free);
  EXPECT_EQ(occupancyLabel(logOddsOf(0.52), kConfig), VoxelState::Occupied);
  EXPECT_EQ(occupancyLabel(logOddsOf(0.5199), kConfig), VoxelState::Unknown);
  EXPECT_EQ(occupancyLabel(logOddsOf(0.48), kConfig), VoxelState::Unknown);
  EXPECT_EQ(occupancyLabel(logOddsOf(0.4799), kConfig), VoxelState::Free);
  EXPECT_EQ(OccupancyBand(kConfig).label(std::numeric_limits<float>::quiet_NaN()), VoxelState::Unknown);
}

TEST(OccupancyConfig, NamesTheFieldThatIsOutOfRange) {
  const auto expectNamed = [](OccupancyConfig config, const char* field) {
    try {
      config.validate();
      ADD_FAILURE() << "accepted " << field;
    } catch (const std::invalid_argument& e) {
      EXPECT_THAT(e.what(), HasSubstr(field));
    }
  };
  EXPECT_NO_THROW(kConfig.validate());
  OccupancyConfig c;
  c.hit_probability = 0.5;
  expectNamed(c, "hit_probability");
  c = {};
  c.miss_probability = std::numeric_limits<double>::quiet_NaN();
  expectNamed(c, "miss_probability");
  c = {};
  c.unknown_low = 0.51;
  expectNamed(c, "unknown_low");
  c = {};
  c.unknown_high = 0.5;
  expectNamed(c, "unknown_high");
  c = {};
  c.clamp_max = 1.0;
  expectNamed(c, "clamp_max");
  c = {};
  c.insert_range_m = 0.0;
  expectNamed(c, "insert_range_m");
}

/// Label of a node of eight voxels of which `count` have one value and the others another.
VoxelState labelOfEight(InnerRule rule, int count, double p, std::optional<double> p_others) {
  OccupancyConfig config;
  config.inner = rule;
  OccupancyOctree map = emptyMap(2, config);
  for (int n = 0; n < 8; ++n) {
    const std::optional<double> value = n < count ? p : p_others;
    if (value) map.set({n & 1, n >> 1 & 1, n >> 2}, static_cast<float>(logOddsOf(*value)));
  }
  return map.label({1, 0, 1}, 1);
}

TEST(OccupancyOctree, MeanRuleFollowsTheTableOfSection103) {
  const auto mean = [](int count, double p, double p_others) {
    return labelOfEight(InnerRule::Mean, count, p, p_others);
  };
  EXPECT_EQ(mean(3, 0.971, 0.1192), VoxelState::Free);
  EXPECT_EQ(mean(4, 0.971, 0.1192), VoxelState::Occupied);
  EXPECT_EQ(mean(7, 0.5, 0.1192), VoxelState::Free);
  EXPECT_EQ(mean(8, 0.5, 0.1192), VoxelState::Unknown);
  EXPECT_EQ(mean(2, 0.7, 0.4), VoxelState::Free);
  EXPECT_EQ(mean(3, 0.7, 0.4), VoxelState::Unknown);
  EXPECT_EQ(mean(4, 0.7, 0.4), VoxelState::Occupied);
  // What is not stored counts as 0.5.
  EXPECT_EQ(labelOfEight(InnerRule::Mean, 1, 0.1192, std::nullopt), VoxelState::Free);
  EXPECT_EQ(labelOfEight(InnerRule::Mean, 1, 0.45, std::nullopt), VoxelState::Unknown);
}

TEST(OctreeNodes, MeansAreThoseOfSection103) {
  const auto mean = [](int count, double p, double p_others) {
    octree::OctreeNodes nodes(0.1);
    const Voxel corner = Voxel::Constant(octree::kKeys / 2);
    for (int n = 0; n < 8; ++n) {
      const Voxel at = corner + Voxel(n & 1, n >> 1 & 1, n >> 2);
      nodes.fill({at, at + Voxel::Ones()}, static_cast<float>(logOddsOf(n < count ? p : p_others)));
    }
    return nodes.probabilitySum({corner, corner + Voxel::Constant(2)}) / 8;
  };
  EXPECT_NEAR(mean(3, 0.971, 0.1192), 0.4386, 5e-5);
  EXPECT_NEAR(mean(4, 0.971, 0.1192), 0.5451, 5e-5);
  EXPECT_NEAR(mean(7, 0.5, 0.1192), 0.4524, 5.1e-5);
  EXPECT_NEAR(mean(8, 0.5, 0.1192), 0.5, 5e-5);
  EXPECT_NEAR(mean(2, 0.7, 0.4), 0.475, 5e-5);
  EXPECT_NEAR(mean(3, 0.7, 0.4), 0.5125, 5e-5);
  EXPECT_NEAR(mean(4, 0.7, 0.4), 0.55, 5e-5);
}

TEST(OccupancyOctree, MaxRuleIsFreeOnlyIfAllOfTheNodeIs) {
  const auto max = [](int count, double p, std::optional<double> p_others) {
    return labelOfEight(InnerRule::Max, count, p, p_others);
  };
  EXPECT_EQ(max(8, 0.1192, std::nullopt), VoxelState::Free);
  EXPECT_EQ(max(1, 0.7, 0.1192), VoxelState::Occupied);
  EXPECT_EQ(max(1, 0.7, 0.5), VoxelState::Occupied);
  EXPECT_EQ(max(7, 0.1192, 0.5), VoxelState::Unknown);
  EXPECT_EQ(max(1, 0.1192, std::nullopt), VoxelState::Unknown);  // D-A6: OctoMap says free
  EXPECT_EQ(max(7, 0.1192, std::nullopt), VoxelState::Unknown);
  EXPECT_EQ(max(1, 0.7, std::nullopt), VoxelState::Occupied);
}

TEST(OccupancyOctree, OnlyVoxelsOfTheGridCountInANode) {
  OccupancyOctree map = emptyMap(3);  // nodes of 2 and 4 voxels reach beyond the grid
  for (int n = 0; n < 27; ++n) map.set({n % 3, n / 3 % 3, n / 9}, kMiss);
  EXPECT_EQ(map.label({2, 2, 2}, 1), VoxelState::Free);
  EXPECT_EQ(map.label({0, 0, 0}, 2), VoxelState::Free);
  EXPECT_EQ(map.label({0, 0, 0}, 15), VoxelState::Free);
  map.set({2, 1, 0}, 0.0f);
  EXPECT_EQ(map.label({2, 0, 1}, 1), VoxelState::Unknown);
  EXPECT_EQ(map.label({0, 0, 0}, 1), VoxelState::Free);
  EXPECT_EQ(map.label({0, 0, 0}, 2), VoxelState::Unknown);
}

TEST(OccupancyOctree, NodesBeginAtMultiplesOfTheirSizeInTheWorld) {
  const GridGeometry g = OccupancyOctree::gridAround(Box(Vector(-0.3, 0.1, 0.2), Vector(0.5, 0.9, 1.0)), 0.1);
  OccupancyOctree map(g, Box(), VoxelState::Free, {});
  map.set(g.voxelAt({-0.05, 0.45, 0.65}), kHit);  // its node of 4 voxels: -0.4..0, 0.4..0.8, 0.4..0.8
  for (std::size_t n = 0; n < g.count(); ++n) {
    const Vector p = g.center(g.voxel(n));
    const bool inside = p.x() < 0.0 && p.y() > 0.4 && p.y() < 0.8 && p.z() > 0.4 && p.z() < 0.8;
    EXPECT_EQ(map.label(g.voxel(n), 2), inside ? VoxelState::Occupied : VoxelState::Free) << p.transpose();
  }
}

TEST(OccupancyOctree, StartsUnknownInTheObjectsBoxAndAsAskedOutside) {  // D-A10
  const GridGeometry g = OccupancyOctree::gridAround(Box(Vector(-0.7, -0.5, 0), Vector(0.9, 0.6, 0.8)), 0.02);
  const Box object(Vector(-0.211, -0.1, 0.2), Vector(0.3, 0.13, 0.4));
  for (const VoxelState outside : {VoxelState::Free, VoxelState::Unknown}) {
    const OccupancyOctree map(g, object, outside, {});
    std::size_t in_box = 0;
    for (std::size_t n = 0; n < g.count(); ++n) {
      const Voxel v = g.voxel(n);
      if (object.contains(g.center(v))) {
        ++in_box;
        ASSERT_EQ(map.logOdds(v), 0.0f);
      } else if (outside == VoxelState::Free) {
        ASSERT_EQ(map.logOdds(v), static_cast<float>(logOddsOf(kConfig.clamp_min)));
      } else {
        ASSERT_EQ(map.logOdds(v), std::nullopt);
      }
    }
    EXPECT_GT(in_box, 2000u);
    EXPECT_LT(map.nodeCount(), g.count() / 4);
  }
}

/// Random values in clusters, some voxels not stored.
OccupancyOctree randomMap(std::mt19937_64& random, const GridGeometry& g, InnerRule rule = InnerRule::Max) {
  OccupancyConfig config;
  config.inner = rule;
  const Vector third = g.bounds().sizes() / 3;
  OccupancyOctree map(g, Box(g.bounds().min() + third, g.bounds().max() - third),
                      random() % 2 ? VoxelState::Free : VoxelState::Unknown, config);
  const std::array<float, 6> values = {kHit,  kMiss, 0.0f,
                                       -2.0f, 3.5f,  std::numeric_limits<float>::quiet_NaN()};
  for (int n = 0; n < 12; ++n) {
    const Voxel center = g.voxel(random() % g.count());
    const int radius = static_cast<int>(random() % 6);
    const float value = values[random() % values.size()];
    for (std::size_t at = 0; at < g.count(); ++at)
      if ((g.voxel(at) - center).cwiseAbs().maxCoeff() <= radius) map.set(g.voxel(at), value);
  }
  return map;
}

TEST(OccupancyOctree, LabelsOfNodesAgreeWithThoseOfTheirVoxels) {
  std::mt19937_64 random(11);
  std::array<int, 3> labels{};
  for (int n = 0; n < 6; ++n) {
    const InnerRule rule = n % 2 ? InnerRule::Mean : InnerRule::Max;
    const GridGeometry g =
        OccupancyOctree::gridAround(Box(Vector(-0.7, -1.1, 0.3), Vector(1.2, 0.6, 1.9)), 0.1);
    const OccupancyOctree map = randomMap(random, g, rule);
    for (int level = 0; level <= 4; ++level)
      for (int sample = 0; sample < 200; ++sample) {
        const Voxel v = g.voxel(random() % g.count());
        const Eigen::Array3d low =
            (g.center(v).array() / (0.1 * (1 << level))).floor() * (0.1 * (1 << level));
        const Box node(low.matrix(), (low + 0.1 * (1 << level)).matrix());
        double sum = 0;
        int count = 0, free = 0, occupied = 0;
        for (std::size_t at = 0; at < g.count(); ++at) {
          if (!node.contains(g.center(g.voxel(at)))) continue;
          const auto value = map.logOdds(g.voxel(at));
          const VoxelState state = occupancyLabel(value.value_or(0.0f), map.config());
          ++count;
          sum += probabilityOf(value.value_or(0.0f));
          free += state == VoxelState::Free;
          occupied += state == VoxelState::Occupied;
        }
        VoxelState expected = occupied        ? VoxelState::Occupied
                              : free == count ? VoxelState::Free
                                              : VoxelState::Unknown;
        if (rule == InnerRule::Mean) expected = occupancyLabel(logOddsOf(sum / count), map.config());
        ASSERT_EQ(map.label(v, level), expected) << "level " << level << " at " << v.transpose();
        ++labels[static_cast<int>(expected)];
      }
  }
  for (const int count : labels) EXPECT_GT(count, 100);
}

TEST(OccupancyOctree, BricksRebuildAMap) {
  std::mt19937_64 random(5);
  const GridGeometry g =
      OccupancyOctree::gridAround(Box(Vector(-0.53, -1.1, 0.3), Vector(3.1, 1.7, 2.0)), 0.1);
  for (int n = 0; n < 4; ++n) {
    const OccupancyOctree map = randomMap(random, g);
    OccupancyOctree copy(g, Box(), n % 2 ? VoxelState::Free : VoxelState::Unknown, {});
    for (std::uint32_t b = 0; b < map.bricks().total(); ++b) {
      const BrickRange r = map.bricks().range(b);
      std::vector<float> values((r.end - r.begin).prod());
      map.readBrick(b, values);
      copy.setBrick(b, values);
      std::size_t at = 0;
      for (int k = r.begin.z(); k < r.end.z(); ++k)
        for (int j = r.begin.y(); j < r.end.y(); ++j)
          for (int i = r.begin.x(); i < r.end.x(); ++i, ++at) {
            const auto value = map.logOdds({i, j, k});
            ASSERT_EQ(value.has_value(), !std::isnan(values[at]));
            if (value) {
              ASSERT_EQ(*value, values[at]);
            }
          }
    }
    for (std::size_t at = 0; at < g.count(); ++at)
      ASSERT_EQ(map.logOdds(g.voxel(at)), copy.logOdds(g.voxel(at)));
    std::vector<float> wrong(3);
    EXPECT_THROW(copy.setBrick(0, wrong), std::invalid_argument);
    EXPECT_THROW(copy.readBrick(0, wrong), std::invalid_argument);
  }
}

TEST(OccupancyOctree, ABrickReplacesWhateverWasThere) {
  std::mt19937_64 random(6);
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  const std::array<float, 4> values = {kHit, kMiss, nothing, nothing};
  OccupancyOctree map = emptyMap(40);
  const GridGeometry& g = map.geometry();
  std::vector<float> expected(g.count(), nothing);
  for (int n = 0; n < 400; ++n) {
    const auto brick = static_cast<std::uint32_t>(random() % map.bricks().total());
    const BrickRange r = map.bricks().range(brick);
    std::vector<float> brick_values;
    std::array<float, 1024> drawn;
    for (float& value : drawn) value = values[random() % values.size()];
    const int shift = static_cast<int>(random() % 2);  // 1: cubes of two voxels have one value
    for (int k = r.begin.z(); k < r.end.z(); ++k)
      for (int j = r.begin.y(); j < r.end.y(); ++j)
        for (int i = r.begin.x(); i < r.end.x(); ++i) {
          const int cell = (k >> shift) % 8 * 128 + (j >> shift) % 8 * 16 + (i >> shift) % 16;
          brick_values.push_back(drawn[cell]);
          expected[g.index(i, j, k)] = drawn[cell];
        }
    map.setBrick(brick, brick_values);
  }
  for (std::size_t at = 0; at < g.count(); ++at) {
    const std::optional<float> value = map.logOdds(g.voxel(at));
    ASSERT_EQ(value.has_value(), !std::isnan(expected[at])) << g.voxel(at).transpose();
    if (value) {
      ASSERT_EQ(*value, expected[at]);
    }
  }
}

TEST(OccupancyOctree, RemovingEverythingLeavesNoNode) {
  OccupancyOctree map = emptyMap(20);
  map.set({3, 4, 5}, kHit);
  map.set({19, 19, 19}, kHit);
  EXPECT_GT(map.nodeCount(), 20u);
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  map.set({3, 4, 5}, nothing);
  EXPECT_EQ(map.logOdds({3, 4, 5}), std::nullopt);
  EXPECT_EQ(map.logOdds({19, 19, 19}), kHit);
  map.set({19, 19, 19}, nothing);
  EXPECT_EQ(map.nodeCount(), 0u);
}

TEST(OccupancyOctree, EqualVoxelsArePruned) {
  OccupancyOctree map = emptyMap(8);
  for (int n = 0; n < 512; ++n) map.set({n % 8, n / 8 % 8, n / 64}, kHit);
  EXPECT_EQ(map.nodeCount(), 14u);  // the root and one node a level down to the 8 voxels
}

TEST(OccupancyOctree, ClearSphereFreesUnknownVoxelsAndKeepsTheOthers) {
  const GridGeometry g = OccupancyOctree::gridAround(Box(Vector(-0.4, -0.3, 0), Vector(0.4, 0.3, 0.5)), 0.02);
  OccupancyOctree map(g, Box(Vector(0, -1, -1), Vector(1, 1, 1)), VoxelState::Unknown, {});
  const Vector center(0.013, 0.021, 0.222);
  const Voxel wall = g.voxelAt(center + Vector(0.05, 0, 0));
  map.set(wall, kHit);
  BrickSet expected(map.bricks().total());
  const BrickSet changed = map.clearSphere(center, 0.1);
  std::size_t inside = 0;
  for (std::size_t n = 0; n < g.count(); ++n) {
    const Voxel v = g.voxel(n);
    if (v == wall) {
      EXPECT_EQ(map.logOdds(v), kHit);
    } else if ((g.center(v) - center).norm() <= 0.1) {
      EXPECT_EQ(map.label(v, 0), VoxelState::Free);
      expected.insert(map.bricks().brickOf(v));
      ++inside;
    } else {
      EXPECT_EQ(map.label(v, 0), VoxelState::Unknown);
    }
  }
  EXPECT_GT(inside, 300u);
  EXPECT_EQ(changed.list(), expected.list());
  EXPECT_TRUE(map.clearSphere(center, 0.1).empty());
  EXPECT_TRUE(map.clearSphere(Vector(9, 9, 9), 0.1).empty());
}

TEST(OccupancyOctree, RecutForgetsWhatLiesOutside) {
  std::mt19937_64 random(8);
  const GridGeometry g = cube(21);
  const OccupancyOctree before = randomMap(random, g);
  std::mt19937_64 again(8);
  OccupancyOctree map = randomMap(again, g);
  const GridGeometry small =
      OccupancyOctree::gridAround(Box(Vector(0.3, 0.5, 0.2), Vector(1.7, 1.2, 1.9)), 0.1);
  map.recut(small, Box());
  ASSERT_EQ(map.geometry(), small);
  map.recut(g, Box());
  std::size_t kept = 0;
  for (std::size_t n = 0; n < g.count(); ++n) {
    const Voxel v = g.voxel(n);
    const bool inside = small.bounds().contains(g.center(v));
    ASSERT_EQ(map.logOdds(v), inside ? before.logOdds(v) : std::nullopt);
    kept += inside && before.logOdds(v);
  }
  EXPECT_GT(kept, 300u);
  EXPECT_THROW(map.recut(OccupancyOctree::gridAround(small.bounds(), 0.2), Box()), std::invalid_argument);
}

TEST(OccupancyOctree, GridsAreAlignedAndRoundedOutward) {
  const GridGeometry g =
      OccupancyOctree::gridAround(Box(Vector(-0.4, 0.43, 0.011), Vector(0.4, 0.95, 0.029)), 0.01);
  EXPECT_EQ(g.size, Voxel(80, 52, 2));
  EXPECT_TRUE(g.bounds().min().isApprox(Vector(-0.4, 0.43, 0.01), 1e-9));
  EXPECT_THROW(OccupancyOctree::gridAround(Box(), 0.01), std::invalid_argument);
  EXPECT_THROW(OccupancyOctree::gridAround(g.bounds(), 0.0), std::invalid_argument);
  EXPECT_THROW(OccupancyOctree::gridAround(Box(Vector::Zero(), Vector::Constant(1e9)), 0.01),
               std::invalid_argument);
}

TEST(OccupancyOctree, RefusesGridsThatAreMisalignedTooLargeOrTooFar) {
  const auto expectRefused = [](const GridGeometry& g, const char* part) {
    try {
      OccupancyOctree map(g, Box(), VoxelState::Unknown, {});
      ADD_FAILURE() << "accepted " << g.size.transpose();
    } catch (const std::exception& e) {
      EXPECT_THAT(e.what(), HasSubstr(part));
    }
  };
  GridGeometry g = cube(8);
  g.origin_m.y() += 0.03;
  expectRefused(g, "multiple of the voxel size");
  g = cube(8);
  g.size.z() = 0;
  expectRefused(g, "size along z");
  g = cube(8);
  g.origin_m.x() += 3276.8;
  expectRefused(g, "OctoMap's limit");
  g = cube(8);
  g.size = {3000, 3000, 3000};
  expectRefused(g, "does not fit in memory");
}

}  // namespace
}  // namespace vantage
