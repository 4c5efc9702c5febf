#include "core/planners/search_again.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "tests/core/planners/two_blocks.h"

namespace vantage {
namespace {

using test::alwaysReachable;
using test::TwoBlocks;
using test::verdict;

/// Both blocks among specks of unknown and occupied, six contour points: two on each block, two without a
/// segment.
TwoBlocks crowdedWorld() {
  TwoBlocks world;
  world.camera = cameraFromFov(64, 54, 1.2);
  std::mt19937 random(7);
  for (int n = 0; n < 3000; ++n) {
    const Eigen::Vector3i v(random() % 100, 20 + random() % 80, random() % 100);
    world.states.set(v, n % 2 ? VoxelState::Unknown : VoxelState::Occupied);
  }
  world.states.rebuildFreeRadius();
  const Eigen::Vector3d front = world.toward_front;
  world.points.push_back({{-0.31, -0.09, 0.97}, (front + Eigen::Vector3d(0.3, 0.1, 0.2)).normalized(), 4});
  world.points.push_back({{0.03, -0.1013, 0.9071}, front, 5});
  world.points.push_back({{0.31, -0.11, 0.83}, (front - Eigen::Vector3d(0.2, 0.0, -0.1)).normalized(), 4});
  world.points.push_back({{0.07, -0.0713, 1.1071}, front, 5});
  world.labels = {1, 2, 1, 0, 2, 0};
  world.config.gain.reduction = 2;
  world.generate();
  return world;
}

/// A verdict for each position, drawn by the seed.
ReachPose moodyRobot(std::uint32_t seed) {
  return [seed](const Pose& pose) {
    const Eigen::Vector3d p = 1e4 * pose.translation();
    std::seed_seq sequence{static_cast<int>(seed), static_cast<int>(p.x()), static_cast<int>(p.y()),
                           static_cast<int>(p.z())};
    std::mt19937 random(sequence);
    constexpr Reachability kVerdicts[] = {Reachability::Reachable, Reachability::InCollision,
                                          Reachability::NoPath, Reachability::OutOfReach};
    return verdict(kVerdicts[random() % 4]);
  };
}

/// Scores of every group.
ScoredGroups scoreAll(const TwoBlocks& world) {
  const ViewSearch search = searchView(world.input(), world.config, alwaysReachable, {});
  ScoredGroups groups(search, world.config);
  for (const std::uint32_t s : groups.pendingIn(search))
    groups.add(scoreGroup(world.input(), world.config, search.segments[s], {}));
  return groups;
}

void expectSameGroup(const SegmentSearch& fresh, const SegmentSearch& again, bool same_margin) {
  EXPECT_EQ(again.segment, fresh.segment);
  EXPECT_EQ(again.saliency, fresh.saliency);
  EXPECT_EQ(again.contour_points, fresh.contour_points);
  EXPECT_EQ(again.sphere.center, fresh.sphere.center);
  EXPECT_EQ(again.sphere.radius, fresh.sphere.radius);
  EXPECT_EQ(again.poses_generated, fresh.poses_generated);
  EXPECT_EQ(again.scored, fresh.scored);
  ASSERT_EQ(again.scores.size(), fresh.scores.size());
  for (std::size_t r = 0; r < fresh.scores.size(); ++r) {
    const PoseScore &a = again.scores[r], &f = fresh.scores[r];
    ASSERT_EQ(a.id, f.id) << "rank " << r;
    EXPECT_EQ(a.gain, f.gain);
    EXPECT_EQ(a.unknown, f.unknown);
    EXPECT_EQ(a.reachability, f.reachability);
    EXPECT_EQ(a.executed_before, f.executed_before);
    if (same_margin) {
      EXPECT_EQ(a.occupied, f.occupied);
    }
  }
}

void expectSameSearch(const ViewSearch& fresh, const ViewSearch& again, bool same_margin) {
  ASSERT_EQ(again.segments.size(), fresh.segments.size());
  for (std::size_t s = 0; s < fresh.segments.size(); ++s)
    expectSameGroup(fresh.segments[s], again.segments[s], same_margin);
  ASSERT_EQ(again.chosen.has_value(), fresh.chosen.has_value());
  if (fresh.chosen) {
    EXPECT_EQ(again.chosen->id, fresh.chosen->id);
    EXPECT_EQ(again.chosen->search, fresh.chosen->search);
    EXPECT_EQ(again.chosen->rank, fresh.chosen->rank);
    EXPECT_EQ(again.chosen->contour_point, fresh.chosen->contour_point);
    EXPECT_EQ(again.chosen->gain, fresh.chosen->gain);
    EXPECT_EQ(again.chosen->T_world_camera.matrix(), fresh.chosen->T_world_camera.matrix());
    EXPECT_EQ(again.chosen->path.verdict, fresh.chosen->path.verdict);
  }
  EXPECT_EQ(again.counts.poses_generated, fresh.counts.poses_generated);
  EXPECT_EQ(again.counts.poses_scored, fresh.counts.poses_scored);
  EXPECT_EQ(again.counts.poses_above_threshold, fresh.counts.poses_above_threshold);
  EXPECT_EQ(again.counts.poses_unreachable, fresh.counts.poses_unreachable);
  EXPECT_EQ(again.counts.poses_executed_before, fresh.counts.poses_executed_before);
  EXPECT_EQ(again.counts.paths_planned, fresh.counts.paths_planned);
}

/// Changes everything that a search from kept scores may change.
void shake(TwoBlocks& world, std::mt19937& random) {
  GainConfig& gain = world.config.gain;
  gain.gain_threshold = random() % 400;
  gain.sphere_margin_m = random() % 51 * 0.01;
  gain.exclude_executed = random() % 2 == 0;
  gain.executed_distance_m = random() % 10 * 0.02;
  gain.executed_angle_rad = random() % 10 * 0.1;
  for (Segment& segment : world.saliency.segments) segment.saliency = random() % 3 * 0.25;
  world.executed.clear();
  for (int n = 0; n < 8; ++n)
    world.executed.push_back(
        rolledPose(world.positions[random() % world.positions.size()], random() % 8, world.config.views));
}

TEST(SearchAgain, EqualsAFreshSearchForRandomConfigurations) {
  TwoBlocks world = crowdedWorld();
  const ScoredGroups groups = scoreAll(world);
  std::mt19937 random(11);
  int chosen = 0, unreachable = 0, executed = 0, second = 0;
  for (int n = 0; n < 60; ++n) {
    SCOPED_TRACE(n);
    shake(world, random);
    const ReachPose reach = moodyRobot(random());
    const ViewSearch fresh = searchView(world.input(), world.config, reach, {});
    const SearchAgain again = searchAgain(world.input(), world.config, groups, reach);
    EXPECT_FALSE(again.pending);
    expectSameSearch(fresh, again.search,
                     world.config.gain.sphere_margin_m == groups.scoredWith().gain.sphere_margin_m);
    chosen += fresh.chosen.has_value();
    second += fresh.chosen && fresh.chosen->search > 0;
    unreachable += fresh.counts.poses_unreachable > 0;
    executed += fresh.counts.poses_executed_before > 0;
  }
  // Every kind of end was met.
  EXPECT_GT(chosen, 10);
  EXPECT_LT(chosen, 60);
  EXPECT_GT(second, 3);
  EXPECT_GT(unreachable, 10);
  EXPECT_GT(executed, 3);
}

TEST(SearchAgain, CastsNothingAndLeavesTheDiagnosticToItsCaller) {
  const TwoBlocks world = crowdedWorld();
  const ViewSearch fresh = searchView(world.input(), world.config, alwaysReachable, {});
  const SearchAgain again =
      searchAgain(world.input(), world.config, ScoredGroups(fresh, world.config), alwaysReachable);
  ASSERT_TRUE(fresh.chosen && again.search.chosen);
  EXPECT_EQ(again.search.counts.rays, 0u);
  EXPECT_EQ(again.search.chosen->gain_voxels, 0u);
  ASSERT_GT(fresh.chosen->gain_voxels, 0u);
  EXPECT_EQ(countVoxels(world.input(), world.config, again.search.segments[again.search.chosen->search],
                        again.search.chosen->T_world_camera),
            fresh.chosen->gain_voxels);
}

TEST(SearchAgain, SaysWhichGroupMustBeScoredFirst) {
  TwoBlocks world = crowdedWorld();
  const ViewSearch first = searchView(world.input(), world.config, alwaysReachable, {});
  ASSERT_TRUE(first.chosen);
  ASSERT_EQ(first.chosen->search, 0u);  // the others were never scored
  ScoredGroups groups(first, world.config);
  EXPECT_EQ(groups.pendingIn(first), (std::vector<std::uint32_t>{1, 2}));
  EXPECT_FALSE(searchAgain(world.input(), world.config, groups, alwaysReachable).pending);

  std::swap(world.saliency.segments[0].saliency, world.saliency.segments[1].saliency);
  const SearchAgain waiting = searchAgain(world.input(), world.config, groups, alwaysReachable);
  ASSERT_EQ(waiting.pending, 0u);
  EXPECT_FALSE(waiting.search.chosen);
  EXPECT_EQ(waiting.search.segments[0].segment, 0);
  EXPECT_FALSE(waiting.search.segments[0].scored);
  EXPECT_EQ(waiting.search.segments.size(), 3u);
  EXPECT_EQ(groups.pendingIn(waiting.search), (std::vector<std::uint32_t>{0, 2}));

  groups.add(scoreGroup(world.input(), world.config, waiting.search.segments[*waiting.pending], {}));
  const SearchAgain answer = searchAgain(world.input(), world.config, groups, alwaysReachable);
  EXPECT_FALSE(answer.pending);
  expectSameSearch(searchView(world.input(), world.config, alwaysReachable, {}), answer.search, true);
}

TEST(SearchAgain, GroupsWithOtherContourPointsArePending) {
  TwoBlocks world = crowdedWorld();
  const ScoredGroups groups = scoreAll(world);
  world.labels[2] = 0;  // leaves block A
  world.config.gain.gain_threshold = 1e6;
  const SearchAgain again = searchAgain(world.input(), world.config, groups, alwaysReachable);
  EXPECT_EQ(again.pending, 1u);
  EXPECT_EQ(groups.pendingIn(again.search), (std::vector<std::uint32_t>{1, 2}));
}

TEST(SearchAgain, FillsTheScoresOfGroupsThatItDidNotReach) {
  TwoBlocks world = crowdedWorld();
  const ScoredGroups groups = scoreAll(world);
  world.config.gain.sphere_margin_m = 0.07;
  world.config.gain.gain_threshold = 10;
  SearchAgain again = searchAgain(world.input(), world.config, groups, alwaysReachable);
  ASSERT_TRUE(again.search.chosen);
  ASSERT_EQ(again.search.chosen->search, 0u);
  SegmentSearch& last = again.search.segments[2];
  EXPECT_TRUE(last.scores.empty());
  ASSERT_TRUE(fillScores(world.input(), world.config, groups, last));
  world.config.gain.gain_threshold = 1e6;  // a fresh search reaches all
  const ViewSearch fresh = searchView(world.input(), world.config, alwaysReachable, {});
  expectSameGroup(fresh.segments[2], last, false);
  SegmentSearch unknown = last;
  unknown.segment = 5;
  EXPECT_FALSE(fillScores(world.input(), world.config, groups, unknown));
}

TEST(SearchAgain, BaselineAnswersForEveryThresholdWhateverTheMargin) {
  TwoBlocks world = crowdedWorld();
  world.config.segment_by_segment = false;
  const ScoredGroups groups = scoreAll(world);
  int chosen = 0;
  for (const double threshold : {0.0, 200.0, 500.0, 1500.0, 1e6}) {
    world.config.gain.gain_threshold = threshold;
    world.config.gain.sphere_margin_m = 0.123;
    const SearchAgain again = searchAgain(world.input(), world.config, groups, moodyRobot(3));
    expectSameSearch(searchView(world.input(), world.config, moodyRobot(3), {}), again.search, true);
    chosen += again.search.chosen.has_value();
  }
  EXPECT_GT(chosen, 0);
  EXPECT_LT(chosen, 5);
}

TEST(SearchAgain, AnswersForGainsInVoxelsUnderTheirOwnMarginAlone) {
  for (const GainMeasure count : {GainMeasure::Voxels, GainMeasure::Volume}) {
    TwoBlocks world = crowdedWorld();
    world.config.gain.count = count;
    const ScoredGroups groups = scoreAll(world);
    ContourPlannerConfig wanted = world.config;
    wanted.gain.gain_threshold = 40;
    const ViewSearch fresh = searchView(world.input(), wanted, moodyRobot(3), {});
    ASSERT_TRUE(fresh.chosen);
    const SearchAgain again = searchAgain(world.input(), wanted, groups, moodyRobot(3));
    EXPECT_FALSE(again.pending);
    ASSERT_TRUE(again.search.chosen);
    EXPECT_EQ(again.search.chosen->id, fresh.chosen->id);
    EXPECT_EQ(again.search.chosen->gain, fresh.chosen->gain);
    GainConfig wider = wanted.gain;
    wider.sphere_margin_m = 0.3;
    EXPECT_FALSE(canSearchAgain(wanted.gain, wider));
  }
}

TEST(SearchAgain, RefusesWhatTheScoresDoNotAnswerFor) {
  const GainConfig have;
  const auto allowed = [&](auto change, bool segments = true) {
    GainConfig wanted = have;
    change(wanted);
    return canSearchAgain(have, wanted, segments);
  };
  EXPECT_TRUE(allowed([](GainConfig&) {}));
  EXPECT_TRUE(allowed([](GainConfig& g) { g.gain_threshold = 3; }));
  EXPECT_TRUE(allowed([](GainConfig& g) { g.sphere_margin_m = 0.0; }));
  EXPECT_TRUE(allowed([](GainConfig& g) { g.sphere_margin_m = 0.29; }));
  EXPECT_TRUE(allowed([](GainConfig& g) { g.sphere_margin_m = 0.50; }));
  EXPECT_TRUE(allowed([](GainConfig& g) { g.executed_distance_m = 0.3; }));
  EXPECT_TRUE(allowed([](GainConfig& g) { g.disappointing_distance_m = 0.3; }));  // it is off
  EXPECT_FALSE(allowed([](GainConfig& g) { g.sphere_margin_m = 0.155; }));
  EXPECT_FALSE(allowed([](GainConfig& g) { g.sphere_margin_m = 0.51; }));
  EXPECT_TRUE(allowed([](GainConfig& g) { g.sphere_margin_m = 0.155; }, false));
  EXPECT_FALSE(allowed([](GainConfig& g) { g.reduction = 2; }));
  EXPECT_FALSE(allowed([](GainConfig& g) { g.outside = OutsideUnknown::Transparent; }));
  EXPECT_FALSE(allowed([](GainConfig& g) { g.count = GainMeasure::Voxels; }));
  EXPECT_FALSE(allowed([](GainConfig& g) { g.count = GainMeasure::Volume; }));
  EXPECT_FALSE(allowed([](GainConfig& g) { g.exclude_disappointing = true; }));
  GainConfig transparent, wider;
  transparent.outside = wider.outside = OutsideUnknown::Transparent;
  wider.sphere_margin_m = 0.3;
  EXPECT_TRUE(canSearchAgain(transparent, transparent));
  EXPECT_FALSE(canSearchAgain(transparent, wider));

  TwoBlocks world = crowdedWorld();
  const ScoredGroups groups = scoreAll(world);
  world.config.gain.sphere_margin_m = 0.155;
  EXPECT_THROW(searchAgain(world.input(), world.config, groups, alwaysReachable), std::invalid_argument);
  world.config = groups.scoredWith();
  world.config.segment_by_segment = false;
  EXPECT_THROW(searchAgain(world.input(), world.config, groups, alwaysReachable), std::invalid_argument);
}

TEST(SearchAgain, AnOddMarginOfTheScoresStaysAnswered) {
  TwoBlocks world = crowdedWorld();
  world.config.gain.sphere_margin_m = 0.155;
  const ScoredGroups groups = scoreAll(world);
  for (const double margin_m : {0.155, 0.10}) {
    world.config.gain.sphere_margin_m = margin_m;
    expectSameSearch(searchView(world.input(), world.config, moodyRobot(5), {}),
                     searchAgain(world.input(), world.config, groups, moodyRobot(5)).search,
                     margin_m == 0.155);
  }
}

TEST(SearchAgain, ScoringStopsWhenAskedTo) {
  const TwoBlocks world = crowdedWorld();
  const ViewSearch first = searchView(world.input(), world.config, alwaysReachable, {});
  std::stop_source source;
  source.request_stop();
  RunControl control;
  control.stop = source.get_token();
  EXPECT_THROW(scoreGroup(world.input(), world.config, first.segments[1], control), Cancelled);
}

TEST(MarginBins, AreWholeCentimetresUpToHalfAMetre) {
  for (int k = 0; k <= 50; ++k) EXPECT_EQ(marginBins(k / 100.0), k);
  EXPECT_EQ(marginBins(0.004), std::nullopt);
  EXPECT_EQ(marginBins(0.51), std::nullopt);
  EXPECT_EQ(marginBins(-0.01), std::nullopt);
  EXPECT_EQ(marginBins(std::nan("")), std::nullopt);
}

}  // namespace
}  // namespace vantage
