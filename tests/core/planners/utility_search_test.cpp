#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <stdexcept>

#include "tests/core/planners/half_known_block.h"

namespace vantage {
namespace {

using Eigen::Vector3d;
using test::HalfKnownBlock;

/// A search over the half known block from a chosen place.
struct Bench {
  HalfKnownBlock block;
  HierarchicalPlannerConfig config = block.config();
  Pose current = lookAt(Vector3d(-1.0, 0.03, 0.02), Vector3d::Zero());
  std::vector<ViewCandidate> candidates = icosphereViews(block.object_box.center(), 1.0, 1);

  UtilitySearch search(const ReachPose& reach = test::reachAll, const RunControl& control = {}) const {
    const StatePyramid pyramid = block.pyramid();
    const RayTree tree(config.sensor, HalfKnownBlock::kVoxel_m, 3);
    return searchUtility({pyramid, tree, block.object_box, candidates, current}, config, reach, control);
  }
};

TEST(UtilitySearch, RanksSurvivorsByUtilityAndTakesTheBest) {
  const Bench bench;
  const UtilitySearch found = bench.search();
  ASSERT_EQ(found.views.size(), 80u);
  ASSERT_GT(found.ranking.size(), 10u);
  for (std::size_t r = 1; r < found.ranking.size(); ++r) {
    const double before = found.views[found.ranking[r - 1]].utility;
    const double here = found.views[found.ranking[r]].utility;
    EXPECT_TRUE(before > here || (before == here && found.ranking[r - 1] < found.ranking[r]));
  }
  for (const std::uint32_t n : found.ranking) EXPECT_EQ(found.views[n].rejection, ViewRejection::None);
  ASSERT_TRUE(found.chosen.has_value());
  const ViewUtility& best = found.views[found.ranking.front()];
  EXPECT_EQ(found.chosen->id, best.id);
  EXPECT_EQ(found.chosen->gain, best.unknown);
  EXPECT_EQ(found.chosen->T_world_camera.matrix(), best.T_world_camera.matrix());
  EXPECT_EQ(best.reachability, Reachability::Reachable);
  EXPECT_EQ(chosenUtility(found), &best);
}

TEST(UtilitySearch, EquallyGoodViewsGoToTheLowerIndex) {
  Bench bench;
  const Pose view = lookAt(Vector3d(0.03, -1.0, 0.02), Vector3d::Zero());
  bench.candidates = test::candidatesOf({lookAt({-1, 0.03, 0}, Vector3d::Zero()), view, view, view});
  const UtilitySearch found = bench.search();
  ASSERT_GE(found.ranking.size(), 3u);
  EXPECT_EQ(found.ranking[0], 1u);
  EXPECT_EQ(found.ranking[1], 2u);
  EXPECT_EQ(found.ranking[2], 3u);
}

TEST(UtilitySearch, CountsItsWork) {
  Bench bench;
  bench.candidates.push_back({80, lookAt(Vector3d(0.1, 0, 0), Vector3d(1, 0, 0))});  // in unknown space
  bench.candidates.push_back({81, lookAt(Vector3d(-1, 0, 0), Vector3d(-2, 0, 0))});  // looks away
  const UtilitySearch found = bench.search();
  std::uint64_t rays = 0, visited = 0, finest = 0, above = 0, position = 0, registration = 0;
  double best = 0.0;
  for (const ViewUtility& view : found.views) {
    rays += view.rays.rays_cast;
    visited += view.rays.visited;
    finest += view.rays.finest_rays_cast;
    position += view.rejection == ViewRejection::Position;
    registration += view.rejection == ViewRejection::Registration;
    if (view.rejection != ViewRejection::None) continue;
    above += view.unknown >= bench.config.stop_gain;
    best = std::max(best, view.unknown);
  }
  EXPECT_EQ(found.counts.poses_generated, 82u);
  EXPECT_EQ(position, 1u);
  EXPECT_GE(registration, 1u);
  EXPECT_EQ(found.rejected_position, position);
  EXPECT_EQ(found.rejected_registration, registration);
  EXPECT_EQ(found.counts.poses_scored, 81u);
  EXPECT_EQ(found.counts.poses_above_threshold, above);
  EXPECT_EQ(found.counts.rays, rays);
  EXPECT_EQ(found.counts.voxels_visited, visited);
  EXPECT_EQ(found.finest_rays_cast, finest);
  EXPECT_EQ(found.counts.paths_planned, 1u);
  EXPECT_EQ(found.box_unknown, 12u * 12 * 6);
  EXPECT_EQ(found.box_occupied, 12u * 12 * 6);
  EXPECT_EQ(found.best_unknown, best);
  EXPECT_GT(rays, 0u);
}

TEST(UtilitySearch, TakesTheFirstViewInRankOrderThatCanBeReachedAndKeepsTheOtherVerdicts) {
  const Bench bench;
  int asked = 0;
  const UtilitySearch found = bench.search([&](const Pose&) {
    MotionPlan plan;
    plan.verdict = ++asked == 1 ? Reachability::OutOfReach
                   : asked == 2 ? Reachability::NoPath
                                : Reachability::Reachable;
    return plan;
  });
  ASSERT_GE(found.ranking.size(), 4u);
  ASSERT_TRUE(found.chosen.has_value());
  EXPECT_EQ(asked, 3);
  EXPECT_EQ(found.chosen->id, found.views[found.ranking[2]].id);
  EXPECT_EQ(found.views[found.ranking[0]].reachability, Reachability::OutOfReach);
  EXPECT_EQ(found.views[found.ranking[1]].reachability, Reachability::NoPath);
  EXPECT_EQ(found.views[found.ranking[3]].reachability, Reachability::NotChecked);
  EXPECT_EQ(found.counts.poses_unreachable, 2u);
  EXPECT_EQ(found.counts.paths_planned, 3u);
}

TEST(UtilitySearch, ChoosesNothingIfNothingCanBeReached) {
  const UtilitySearch found = Bench().search([](const Pose&) {
    MotionPlan plan;
    plan.verdict = Reachability::InCollision;
    return plan;
  });
  EXPECT_FALSE(found.chosen.has_value());
  EXPECT_GT(found.counts.poses_unreachable, 0u);
}

// Section 10.6.
TEST(UtilitySearch, EndsAtTheFirstEvaluationIfTheBoxIsFree) {
  Bench bench;
  for (std::size_t n = 0; n < bench.block.states.geometry().count(); ++n)
    bench.block.states.set(bench.block.states.geometry().voxel(n), VoxelState::Free);
  bench.block.states.rebuildFreeRadius();
  for (const double min_occupied : {10.0, 0.0}) {
    bench.config.min_occupied = min_occupied;
    const UtilitySearch found = bench.search();
    EXPECT_FALSE(found.chosen.has_value());
    EXPECT_TRUE(found.literal_stop);
    EXPECT_EQ(found.box_unknown, 0u);
    EXPECT_EQ(found.best_unknown, 0.0);
    EXPECT_EQ(found.counts.paths_planned, 0u);
  }
}

// D-A18: a poor view nearby has the highest utility, a far one is worth a scan.
TEST(UtilitySearch, GoesOnWhileAnySurvivorIsWorthAScanAndSaysWhereTheLiteralRuleStops) {
  Bench bench;
  const Pose rich = lookAt(Vector3d(0.03, -1.0, 0.02), Vector3d::Zero());
  const Pose poor = lookAt(Vector3d(-0.8, -0.9, 0.02), Vector3d(-0.25, 0.1, 0));
  bench.candidates = test::candidatesOf({rich, poor});
  bench.current = poor;
  bench.config.min_occupied = 0;
  bench.config.rotation_weight_m_per_rad = 100;  // far away
  const UtilitySearch free_choice = bench.search();
  const double least = free_choice.views[1].unknown, most = free_choice.views[0].unknown;
  ASSERT_GT(least, 0.0);
  ASSERT_GT(most, least);
  ASSERT_EQ(free_choice.ranking.front(), 1u);

  bench.config.stop_gain = least;
  EXPECT_FALSE(bench.search().literal_stop);
  bench.config.stop_gain = most;
  const UtilitySearch goes_on = bench.search();
  EXPECT_TRUE(goes_on.literal_stop);
  EXPECT_TRUE(goes_on.chosen.has_value());
  bench.config.stop_gain = most + 1;
  const UtilitySearch stops = bench.search();
  EXPECT_TRUE(stops.literal_stop);
  EXPECT_FALSE(stops.chosen.has_value());
  EXPECT_EQ(stops.ranking.size(), 2u) << "the ranking is kept for whoever asks";
}

TEST(UtilitySearch, GainVoxelsAreDistinctAtFullResolution) {
  Bench bench;
  StateGrid& grid = bench.block.states;
  const GridGeometry& g = grid.geometry();
  for (std::size_t n = 0; n < g.count(); ++n) grid.set(g.voxel(n), VoxelState::Free);
  grid.set({30, 30, 30}, VoxelState::Unknown);
  grid.rebuildFreeRadius();
  bench.candidates = test::candidatesOf({lookAt(Vector3d(-1, 0.01, 0.02), g.center({30, 30, 30}))});
  bench.config.min_occupied = 0;
  bench.config.stop_gain = 1;
  const UtilitySearch found = bench.search();
  ASSERT_TRUE(found.chosen.has_value());
  EXPECT_GT(found.chosen->gain, 1.0);
  EXPECT_EQ(found.chosen->gain_voxels, 1u);
}

TEST(UtilitySearch, IsTheSameForAnyNumberOfThreads) {
  for (const int levels : {0, 2}) {
    Bench bench;
    bench.config.coarse_levels = levels;
    const auto searchWith = [&](int threads) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      return bench.search();
    };
    const UtilitySearch one = searchWith(1), two = searchWith(2);
    EXPECT_EQ(one.ranking, two.ranking);
    ASSERT_EQ(one.views.size(), two.views.size());
    ASSERT_FALSE(one.views.empty());
    for (std::size_t n = 0; n < one.views.size(); ++n) {
      EXPECT_EQ(one.views[n].rays, two.views[n].rays);
      EXPECT_EQ(one.views[n].utility, two.views[n].utility);
      EXPECT_EQ(one.views[n].rejection, two.views[n].rejection);
    }
    ASSERT_EQ(one.chosen.has_value(), two.chosen.has_value());
    EXPECT_EQ(one.chosen->id, two.chosen->id);
  }
}

TEST(UtilitySearch, OfNoCandidatesChoosesNothing) {
  Bench bench;
  bench.candidates.clear();
  const UtilitySearch found = bench.search();
  EXPECT_FALSE(found.chosen.has_value());
  EXPECT_EQ(chosenUtility(found), nullptr);
  EXPECT_TRUE(found.literal_stop);
}

TEST(UtilitySearch, RefusesInputsThatDoNotBelongTogether) {
  const Bench bench;
  const HalfKnownBlock& block = bench.block;
  const StatePyramid pyramid = block.pyramid(1);
  const RayTree tree = block.tree(1);
  const auto searchWith = [&](const StatePyramid& map, const RayTree& rays, const Box& box,
                              const HierarchicalPlannerConfig& config) {
    searchUtility({map, rays, box, bench.candidates, bench.current}, config, test::reachAll, {});
  };
  EXPECT_NO_THROW(searchWith(pyramid, tree, block.object_box, bench.config));
  HierarchicalPlannerConfig coarser = bench.config;
  coarser.coarse_levels = 2;
  EXPECT_THROW(searchWith(pyramid, block.tree(2), block.object_box, coarser), std::invalid_argument);
  EXPECT_THROW(searchWith(block.pyramid(2), tree, block.object_box, coarser), std::invalid_argument);
  EXPECT_THROW(searchWith(StatePyramid(), tree, block.object_box, bench.config), std::invalid_argument);
  EXPECT_THROW(searchWith(pyramid, RayTree(), block.object_box, bench.config), std::invalid_argument);
  EXPECT_THROW(searchWith(pyramid, RayTree(bench.config.sensor, 0.04, 1), block.object_box, bench.config),
               std::invalid_argument);
  HierarchicalPlannerConfig other = bench.config;
  other.sensor.max_range_m = 1.5;
  EXPECT_THROW(searchWith(pyramid, tree, block.object_box, other), std::invalid_argument);
  EXPECT_THROW(searchWith(pyramid, tree, Box(), bench.config), std::invalid_argument);
}

TEST(UtilitySearch, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  RunControl control;
  control.stop = stop.get_token();
  EXPECT_THROW(Bench().search(test::reachAll, control), Cancelled);
}

}  // namespace
}  // namespace vantage
