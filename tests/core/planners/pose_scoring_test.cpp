#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

#include "core/planners/contour_planner.h"
#include "core/raycasting/volume_caster.h"
#include "tests/core/planners/two_blocks.h"

namespace vantage {
namespace {

using test::TwoBlocks;

Pose poseOf(const TwoBlocks& world, std::uint32_t id) {
  const int rolls = world.config.views.rolls;
  return rolledPose(world.positions[id / rolls], static_cast<int>(id % rolls), world.config.views);
}

/// Both blocks, and specks of unknown and occupied around them.
TwoBlocks speckledWorld() {
  TwoBlocks world;
  std::mt19937 random(23);
  for (int n = 0; n < 3000; ++n) {
    const Eigen::Vector3i v(random() % 100, 20 + random() % 80, random() % 100);
    world.states.set(v, n % 2 ? VoxelState::Unknown : VoxelState::Occupied);
  }
  world.states.rebuildFreeRadius();
  return world;
}

SegmentSearch scored(const TwoBlocks& world, std::int32_t segment, SearchCounts& counts) {
  SegmentSearch search;
  search.segment = segment;
  if (segment >= 0)
    search.contour_points = {static_cast<std::uint32_t>(segment)};
  else
    search.contour_points = {0, 1};
  scoreSegment(world.input(), world.config, search, counts, {});
  return search;
}

VisibilityQuery sphereQuery(const TwoBlocks& world, std::int32_t segment, double margin) {
  VisibilityQuery query;
  query.sphere =
      Sphere{world.saliency.segments[segment].center_m, world.saliency.segments[segment].radius_m + margin};
  query.outside = world.config.gain.outside;
  return query;
}

TEST(ScoreSegment, TwoCastsServeEightRolls) {
  const TwoBlocks world = speckledWorld();
  ASSERT_TRUE(sharesQuarterTurnGrid(world.camera));
  SearchCounts counts;
  const SegmentSearch search = scored(world, 1, counts);
  ASSERT_EQ(search.scores.size(), 40u);
  EXPECT_EQ(search.histograms.size(), 20u);  // four distinct ones a position
  for (const PoseScore& score : search.scores) {
    const VisibilityCounts one = castUniform(world.states, world.camera, poseOf(world, score.id),
                                             sphereQuery(world, 1, world.config.gain.sphere_margin_m));
    EXPECT_EQ(score.unknown, one.unknown) << score.id;
    EXPECT_EQ(score.occupied, one.occupied) << score.id;
    EXPECT_EQ(score.gain, static_cast<double>(one.unknown));
    EXPECT_GT(score.unknown, 100u);
  }
  EXPECT_LT(counts.rays, 5u * 4u * 128u * 106u);  // less than four casts a position
  EXPECT_GE(counts.rays, 5u * 2u * 128u * 106u);
  std::uint64_t rays = 0, visited = 0;
  for (int n = 5; n < 10; ++n)  // the positions of point 1
    for (const int roll : {0, 1}) {
      const QuarterTurnCounts shared = castQuarterTurns(
          world.states, world.camera, rolledPose(world.positions[n], roll, world.config.views),
          sphereQuery(world, 1, world.config.gain.sphere_margin_m));
      rays += shared.rays_cast;
      visited += shared.visited;
      EXPECT_LT(shared.visited, shared.upright.visited + shared.sideways.visited);
      EXPECT_GT(shared.visited, std::max(shared.upright.visited, shared.sideways.visited));
    }
  EXPECT_EQ(counts.rays, rays);
  EXPECT_EQ(counts.voxels_visited, visited);
}

TEST(ScoreSegment, CastsEachRollWhereTheyShareNothing) {
  for (const bool centred : {true, false}) {
    TwoBlocks world = speckledWorld();
    world.camera.height = 105;  // even and odd: no common grid
    world.camera.cy = centred ? 52.0 : 50.0;
    ASSERT_FALSE(sharesQuarterTurnGrid(world.camera));
    SearchCounts counts;
    const SegmentSearch search = scored(world, 0, counts);
    ASSERT_EQ(search.scores.size(), 40u);
    EXPECT_EQ(search.histograms.size(), centred ? 20u : 40u);
    EXPECT_EQ(counts.rays, search.histograms.size() * 128u * 105u);
    for (const PoseScore& score : search.scores)
      EXPECT_EQ(score.unknown, castUniform(world.states, world.camera, poseOf(world, score.id),
                                           sphereQuery(world, 0, world.config.gain.sphere_margin_m))
                                   .unknown)
          << score.id;
  }
}

TEST(ScoreSegment, AnyNumberOfRollsEqualsSeparateCasts) {
  for (const int rolls : {1, 2, 3, 4, 6, 12}) {
    TwoBlocks world = speckledWorld();
    world.config.views.rolls = rolls;
    world.generate();
    SearchCounts counts;
    const SegmentSearch search = scored(world, 1, counts);
    ASSERT_EQ(search.scores.size(), static_cast<std::size_t>(5 * rolls));
    for (const PoseScore& score : search.scores)
      EXPECT_EQ(score.unknown, castUniform(world.states, world.camera, poseOf(world, score.id),
                                           sphereQuery(world, 1, world.config.gain.sphere_margin_m))
                                   .unknown)
          << rolls << " rolls, pose " << score.id;
  }
}

TEST(ScoreSegment, GainIsScaledToFullResolution) {
  TwoBlocks world;
  SearchCounts full_counts, quarter_counts;
  const SegmentSearch full = scored(world, 1, full_counts);
  world.config.gain.reduction = 2;
  const SegmentSearch half = scored(world, 1, quarter_counts);
  EXPECT_EQ(half.scores.front().gain, 4.0 * half.scores.front().unknown);
  EXPECT_NEAR(half.scores.front().gain / full.scores.front().gain, 1.0, 0.1);
  EXPECT_LT(quarter_counts.rays, full_counts.rays);
}

TEST(ScoreSegment, GainsInVoxelsCountEachVoxelOnce) {
  for (const GainMeasure count : {GainMeasure::Voxels, GainMeasure::Volume}) {
    for (const std::int32_t segment : {1, -1}) {  // -1: the baseline
      TwoBlocks world = speckledWorld();
      world.config.gain.count = count;
      world.config.gain.reduction = 2;
      world.config.segment_by_segment = segment >= 0;
      SearchCounts counts;
      const SegmentSearch search = scored(world, segment, counts);
      EXPECT_TRUE(search.histograms.empty());
      VisibilityQuery query;
      query.bounds = world.workspace;
      if (segment >= 0) query = sphereQuery(world, segment, world.config.gain.sphere_margin_m);
      query.distinct_voxels = true;
      const auto cast = count == GainMeasure::Volume ? castThroughUnknown : castUniform;
      double previous = std::numeric_limits<double>::infinity();
      for (const PoseScore& score : search.scores) {
        const VisibilityCounts one =
            cast(world.states, world.camera.reduced(2), poseOf(world, score.id), query);
        EXPECT_EQ(score.gain, static_cast<double>(one.unknown_voxels)) << score.id;
        EXPECT_LE(score.gain, previous);
        previous = score.gain;
      }
      ASSERT_FALSE(search.scores.empty());
      EXPECT_GT(search.scores.front().gain, 50.0);
    }
  }
}

TEST(ScoreSegment, VolumeLooksIntoABlockOfUnknownOnWhichRaysEnd) {
  TwoBlocks world;
  SearchCounts counts;
  const auto best = [&](GainMeasure count) {
    world.config.gain.count = count;
    return scored(world, 1, counts).scores.front().gain;
  };
  // 10 x 10 x 10 voxels, seen about face-on.
  EXPECT_NEAR(best(GainMeasure::Voxels), 100, 40);
  EXPECT_NEAR(best(GainMeasure::Volume), 1000, 10);
}

TEST(ScoreSegment, RanksByGainThenId) {
  const TwoBlocks world;
  SearchCounts counts;
  const SegmentSearch search = scored(world, 1, counts);
  int ties = 0;
  for (std::size_t n = 1; n < search.scores.size(); ++n) {
    const PoseScore &a = search.scores[n - 1], &b = search.scores[n];
    EXPECT_TRUE(a.gain > b.gain || (a.gain == b.gain && a.id < b.id));
    ties += a.gain == b.gain;
  }
  EXPECT_GE(ties, 20);  // each pose ties with its half turn
  EXPECT_EQ(counts.poses_scored, 40u);
}

TEST(ScoreSegment, HistogramAnswersForEveryMargin) {
  const TwoBlocks world = speckledWorld();
  SearchCounts counts;
  const SegmentSearch search = scored(world, 1, counts);
  int grew = 0;
  for (const int margin_cm : {0, 5, 20, 37, 50}) {
    for (const PoseScore& score : search.scores) {
      ASSERT_GE(score.histogram, 0);
      const std::vector<std::uint32_t>& bins = search.histograms[score.histogram];
      ASSERT_EQ(bins.size(), static_cast<std::size_t>(kHistogramBins));
      const auto sum = std::accumulate(bins.begin(), bins.begin() + margin_cm + 1, 0u);
      const VisibilityCounts cast = castUniform(world.states, world.camera, poseOf(world, score.id),
                                                sphereQuery(world, 1, margin_cm * 0.01));
      EXPECT_EQ(sum, cast.unknown) << "margin " << margin_cm << " cm, pose " << score.id;
      if (margin_cm == 20) {
        EXPECT_EQ(sum, score.unknown);
      }
      grew += margin_cm == 50 && sum > score.unknown;
    }
  }
  EXPECT_GT(grew, 0);
}

TEST(ScoreSegment, RegionIsTheSegmentsSphereAndTheMargin) {
  const TwoBlocks world;
  SearchCounts counts;
  const SegmentSearch search = scored(world, 0, counts);
  EXPECT_EQ(search.sphere.center, world.saliency.segments[0].center_m);
  EXPECT_DOUBLE_EQ(search.sphere.radius, 0.1 + 0.2);
  EXPECT_TRUE(search.scored);
  EXPECT_EQ(search.poses_generated, 40u);
}

TEST(ScoreSegment, UnknownInFrontOfTheSphereHidesItUnlessTransparent) {
  TwoBlocks world;
  SearchCounts counts;
  const double before = scored(world, 1, counts).scores.front().gain;
  // A curtain of unknown, outside the sphere and beyond the minimum range.
  for (int x = 0; x < 100; ++x)
    for (int z = 0; z < 100; ++z) world.states.set({x, 33, z}, VoxelState::Unknown);
  world.states.rebuildFreeRadius();
  EXPECT_EQ(scored(world, 1, counts).scores.front().gain, 0.0);
  world.config.gain.outside = OutsideUnknown::Transparent;
  EXPECT_EQ(scored(world, 1, counts).scores.front().gain, before);
}

TEST(ScoreSegment, SameForOneAndTwoThreads) {
  const TwoBlocks world = speckledWorld();
  const auto run = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    SearchCounts counts;
    SegmentSearch search = scored(world, -1, counts);
    return std::pair(std::move(search), counts);
  };
  const auto [one, one_counts] = run(1);
  const auto [two, two_counts] = run(2);
  ASSERT_EQ(one.scores.size(), 80u);
  for (std::size_t n = 0; n < one.scores.size(); ++n) {
    EXPECT_EQ(one.scores[n].id, two.scores[n].id);
    EXPECT_EQ(one.scores[n].unknown, two.scores[n].unknown);
    EXPECT_EQ(one.scores[n].occupied, two.scores[n].occupied);
    EXPECT_EQ(one.scores[n].histogram, two.scores[n].histogram);
  }
  EXPECT_EQ(one.histograms, two.histograms);
  EXPECT_EQ(one_counts.rays, two_counts.rays);
  EXPECT_EQ(one_counts.voxels_visited, two_counts.voxels_visited);
}

}  // namespace
}  // namespace vantage
