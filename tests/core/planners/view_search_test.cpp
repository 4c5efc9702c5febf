#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <set>
#include <string>

#include "core/planners/contour_planner.h"
#include "tests/core/planners/two_blocks.h"

namespace vantage {
namespace {

using test::alwaysReachable;
using test::TwoBlocks;
using test::verdict;

ViewSearch search(const TwoBlocks& world, const ReachPose& reach = alwaysReachable) {
  return searchView(world.input(), world.config, reach, {});
}

Pose poseOf(const TwoBlocks& world, std::uint32_t id) {
  const int rolls = world.config.views.rolls;
  return rolledPose(world.positions[id / rolls], static_cast<int>(id % rolls), world.config.views);
}

TEST(SearchView, StopsAtTheBestPoseOfTheMostSalientSegment) {
  const TwoBlocks world;
  const ViewSearch result = search(world);
  ASSERT_EQ(result.segments.size(), 2u);
  EXPECT_EQ(result.segments[0].segment, 1);
  EXPECT_EQ(result.segments[0].saliency, 0.5);
  EXPECT_EQ(result.segments[0].contour_points, std::vector<std::uint32_t>{1});
  EXPECT_TRUE(result.segments[0].scored);
  // The second one is listed, not scored.
  EXPECT_EQ(result.segments[1].segment, 0);
  EXPECT_FALSE(result.segments[1].scored);
  EXPECT_TRUE(result.segments[1].scores.empty());
  EXPECT_EQ(result.segments[1].poses_generated, 40u);
  EXPECT_DOUBLE_EQ(result.segments[1].sphere.radius, 0.3);

  ASSERT_TRUE(result.chosen);
  EXPECT_EQ(result.chosen->search, 0u);
  EXPECT_EQ(result.chosen->rank, 0u);
  EXPECT_EQ(result.chosen->contour_point, 1u);
  EXPECT_EQ(result.chosen->id, result.segments[0].scores[0].id);
  EXPECT_EQ(result.chosen->gain, result.segments[0].scores[0].gain);
  EXPECT_EQ(result.chosen->T_world_camera.matrix(), poseOf(world, result.chosen->id).matrix());
  EXPECT_EQ(result.segments[0].scores[0].reachability, Reachability::Reachable);
  EXPECT_EQ(result.segments[0].scores[1].reachability, Reachability::NotChecked);
  EXPECT_EQ(result.counts.poses_generated, 80u);
  EXPECT_EQ(result.counts.poses_scored, 40u);
  EXPECT_EQ(result.counts.poses_unreachable, 0u);
  EXPECT_EQ(result.counts.paths_planned, 1u);
}

TEST(SearchView, PredictsDistinctVoxelsAtFullResolution) {
  TwoBlocks world;
  world.config.gain.reduction = 4;
  const ViewSearch result = search(world);
  ASSERT_TRUE(result.chosen);
  VisibilityQuery query;
  query.sphere = result.segments[0].sphere;
  query.distinct_voxels = true;
  const VisibilityCounts full = castUniform(world.states, world.camera, result.chosen->T_world_camera, query);
  EXPECT_EQ(result.chosen->gain_voxels, full.unknown_voxels);
  EXPECT_GE(result.chosen->gain_voxels, 100u);  // the front of the block alone is 10 x 10 voxels
  EXPECT_EQ(result.counts.rays,
            5u * 8u * 32u * 27u);  // at a quarter no rolls share; the diagnostic's don't count
}

TEST(SearchView, FallsThroughASegmentBelowTheThreshold) {
  TwoBlocks world;
  world.block({0.4, 0.0, 0.9}, VoxelState::Occupied);  // nothing to see at the salient one
  const ViewSearch result = search(world);
  ASSERT_TRUE(result.chosen);
  EXPECT_EQ(result.chosen->search, 1u);
  EXPECT_EQ(result.chosen->contour_point, 0u);
  EXPECT_TRUE(result.segments[0].scored);
  EXPECT_EQ(result.segments[0].scores.front().gain, 0.0);
  EXPECT_GT(result.segments[0].scores.front().occupied, 0u);
  EXPECT_EQ(result.counts.poses_scored, 80u);
  EXPECT_EQ(result.counts.paths_planned, 1u);
}

TEST(SearchView, FallsThroughASegmentOutOfReach) {
  const TwoBlocks world;
  std::size_t asked_right = 0;
  const ViewSearch result = search(world, [&](const Pose& pose) {
    const bool right = pose.translation().x() > 0.0;
    asked_right += right;
    return verdict(right ? Reachability::InCollision : Reachability::Reachable);
  });
  ASSERT_TRUE(result.chosen);
  EXPECT_EQ(result.chosen->search, 1u);
  EXPECT_EQ(asked_right, 5u);  // once a position, not once a roll
  EXPECT_EQ(result.counts.paths_planned, 6u);
  EXPECT_EQ(result.counts.poses_unreachable, 40u);
  for (const PoseScore& score : result.segments[0].scores)
    EXPECT_EQ(score.reachability, Reachability::InCollision);
}

TEST(SearchView, SkipsAndCountsUnreachablePoses) {
  const TwoBlocks world;
  const ViewSearch free = search(world);
  std::set<std::uint32_t> refused;  // the positions of the three best poses
  for (int n = 0; n < 3; ++n) refused.insert(free.segments[0].scores[n].id / 8);
  const ViewSearch result = search(world, [&](const Pose& pose) {
    for (const std::uint32_t p : refused)
      if ((world.positions[p].T_world_camera.translation() - pose.translation()).norm() < 1e-9)
        return verdict(Reachability::NoPath);
    return verdict(Reachability::Reachable);
  });
  ASSERT_TRUE(result.chosen);
  EXPECT_EQ(result.counts.poses_unreachable, result.chosen->rank);
  EXPECT_GT(result.chosen->rank, 0u);
  for (std::uint32_t r = 0; r < result.segments[0].scores.size(); ++r) {
    const PoseScore& score = result.segments[0].scores[r];
    EXPECT_EQ(score.reachability, r < result.chosen->rank    ? Reachability::NoPath
                                  : r == result.chosen->rank ? Reachability::Reachable
                                                             : Reachability::NotChecked);
    if (r < result.chosen->rank) {
      EXPECT_TRUE(refused.contains(score.id / 8));
    }
  }
}

TEST(SearchView, AsksAgainAfterTheWallClockStruck) {
  const TwoBlocks world;
  int calls = 0;
  const ViewSearch result = search(world, [&](const Pose&) {
    return verdict(calls++ ? Reachability::Reachable : Reachability::TimedOut);
  });
  ASSERT_TRUE(result.chosen);
  EXPECT_EQ(result.chosen->rank, 1u);
  EXPECT_EQ(result.counts.poses_unreachable, 1u);
}

TEST(SearchView, NothingLeftMeansFinished) {
  TwoBlocks world;
  world.config.gain.gain_threshold = 1e6;
  const ViewSearch result = search(world);
  EXPECT_FALSE(result.chosen);
  EXPECT_EQ(result.counts.poses_scored, 80u);
  EXPECT_EQ(result.counts.poses_above_threshold, 0u);
  EXPECT_EQ(result.counts.paths_planned, 0u);
  TwoBlocks empty;
  empty.points.clear();
  empty.labels.clear();
  empty.generate();
  EXPECT_TRUE(search(empty).segments.empty());
  EXPECT_FALSE(search(empty).chosen);
}

TEST(SearchView, ThresholdItselfIsNotEnough) {
  TwoBlocks world;
  const double best = search(world).chosen->gain;
  world.config.gain.gain_threshold = best - 0.5;
  ASSERT_TRUE(search(world).chosen);
  EXPECT_EQ(search(world).chosen->search, 0u);
  world.config.gain.gain_threshold = best;
  const ViewSearch result = search(world);
  EXPECT_EQ(result.segments[0].scores[0].gain, best);
  EXPECT_TRUE(!result.chosen || result.chosen->search == 1u);
}

TEST(SearchView, ExecutedPosesAreNotChosenAgain) {
  TwoBlocks world;
  const ViewSearch first = search(world);
  world.executed = {first.chosen->T_world_camera};
  const ViewSearch second = search(world);
  ASSERT_TRUE(second.chosen);
  EXPECT_NE(second.chosen->id, first.chosen->id);
  EXPECT_TRUE(second.segments[0].scores[0].executed_before);
  EXPECT_EQ(second.segments[0].scores[0].reachability, Reachability::NotChecked);
  EXPECT_EQ(second.counts.poses_executed_before, second.chosen->rank);
  world.config.gain.exclude_executed = false;
  EXPECT_EQ(search(world).chosen->id, first.chosen->id);
  EXPECT_EQ(search(world).counts.poses_executed_before, 0u);
}

TEST(SearchView, ExecutedMeansFiveCentimetresAndTenDegrees) {
  TwoBlocks world;
  const std::uint32_t best = search(world).chosen->id;
  const auto excluded = [&](const Eigen::Vector3d& shift, double roll_deg) {
    Pose pose = poseOf(world, best);
    pose.translation() += shift;
    pose.rotate(Eigen::AngleAxisd(roll_deg * EIGEN_PI / 180.0, Eigen::Vector3d::UnitZ()));
    world.executed = {pose};
    return search(world).chosen->id != best;
  };
  EXPECT_TRUE(excluded({0.049, 0.0, 0.0}, 9.9));
  EXPECT_FALSE(excluded({0.051, 0.0, 0.0}, 9.9));
  EXPECT_FALSE(excluded({0.049, 0.0, 0.0}, 10.1));
}

TEST(SearchView, PointsWithoutSegmentComeLast) {
  TwoBlocks world;
  world.points.push_back({{0.0, -0.1, 0.9}, {0.0, -1.0, 0.0}, 3});
  world.points.push_back({{0.0, -0.1, 1.1}, {0.0, -1.0, 0.0}, 3});
  world.labels = {1, 2, 0, 0};
  world.saliency.segments.push_back(
      TwoBlocks::segment(3, 0.9, {0.0, 0.0, 0.3}));  // without contour points: skipped
  world.saliency.segments[0].saliency = 0.0;
  world.generate();
  world.config.gain.gain_threshold = 1e6;
  const ViewSearch result = search(world);
  ASSERT_EQ(result.segments.size(), 3u);
  EXPECT_EQ(result.segments[0].segment, 1);
  EXPECT_EQ(result.segments[1].segment, 0);
  const SegmentSearch& rest = result.segments[2];
  EXPECT_EQ(rest.segment, -1);
  EXPECT_EQ(rest.saliency, 0.0);
  EXPECT_EQ(rest.contour_points, (std::vector<std::uint32_t>{2, 3}));
  EXPECT_NEAR((rest.sphere.center - Eigen::Vector3d(0.0, -0.1, 1.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(rest.sphere.radius, 0.1 + 0.2, 1e-12);
  EXPECT_EQ(rest.scores.size(), 80u);
}

TEST(SearchView, DisappointingContoursAreNotOfferedAgain) {
  TwoBlocks world;
  world.disappointing = {world.points[1].position_m + Eigen::Vector3d(0.04, 0.0, 0.0)};
  EXPECT_EQ(search(world).chosen->contour_point, 1u);  // off by default
  world.config.gain.exclude_disappointing = true;
  const ViewSearch result = search(world);
  ASSERT_EQ(result.segments.size(), 1u);
  EXPECT_EQ(result.chosen->contour_point, 0u);
  world.disappointing[0].x() += 0.02;  // farther than 5 cm
  EXPECT_EQ(search(world).chosen->contour_point, 1u);
  world.config.segment_by_segment = false;
  world.disappointing = {world.points[0].position_m};
  EXPECT_EQ(search(world).segments[0].contour_points, std::vector<std::uint32_t>{1});
}

TEST(SearchView, BaselineScoresEveryPoseOverTheWorkspace) {
  TwoBlocks world;
  world.config.segment_by_segment = false;
  world.workspace = Box(Eigen::Vector3d(-1.0, -1.0, 0.0), Eigen::Vector3d(0.45, 1.0, 0.95));  // cuts block B
  world.labels.clear();                                                                       // not needed
  world.saliency = {};
  const ViewSearch result = search(world);
  ASSERT_EQ(result.segments.size(), 1u);
  const SegmentSearch& all = result.segments[0];
  EXPECT_EQ(all.segment, -1);
  EXPECT_EQ(all.sphere.radius, 0.0);
  EXPECT_EQ(all.contour_points, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_TRUE(all.histograms.empty());
  ASSERT_EQ(all.scores.size(), 80u);
  VisibilityQuery query;
  query.bounds = world.workspace;
  double best = 0.0;
  for (const PoseScore& score : all.scores) {
    const VisibilityCounts one = castUniform(world.states, world.camera, poseOf(world, score.id), query);
    EXPECT_EQ(score.unknown, one.unknown) << score.id;
    EXPECT_EQ(score.histogram, -1);
    best = std::max(best, static_cast<double>(one.unknown));
  }
  ASSERT_TRUE(result.chosen);
  EXPECT_EQ(result.chosen->gain, best);
  EXPECT_EQ(result.counts.poses_scored, 80u);
}

TEST(SearchView, SameForOneAndTwoThreads) {
  const TwoBlocks world;
  const auto run = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return search(world);
  };
  const ViewSearch one = run(1), two = run(2);
  EXPECT_EQ(one.chosen->id, two.chosen->id);
  EXPECT_EQ(one.chosen->gain_voxels, two.chosen->gain_voxels);
  EXPECT_EQ(one.segments[0].histograms, two.segments[0].histograms);
  EXPECT_EQ(one.counts.rays, two.counts.rays);
}

TEST(SearchView, StopsWhenAskedTo) {
  const TwoBlocks world;
  std::stop_source source;
  RunControl control;
  control.stop = source.get_token();
  int asked = 0, reports = 0;
  control.progress = [&](std::string_view, std::uint64_t done, std::uint64_t total) {
    EXPECT_LE(done, total);
    ++reports;
  };
  const ReachPose stop_and_refuse = [&](const Pose&) {
    ++asked;
    source.request_stop();
    return verdict(Reachability::NoPath);
  };
  EXPECT_THROW(searchView(world.input(), world.config, stop_and_refuse, control), Cancelled);
  EXPECT_EQ(asked, 1);
  EXPECT_GT(reports, 0);
  reports = 0;
  EXPECT_THROW(searchView(world.input(), world.config, stop_and_refuse, control),
               Cancelled);  // before the first cast
  EXPECT_EQ(reports, 0);
  EXPECT_EQ(asked, 1);
}

std::string complaint(const TwoBlocks& world) {
  try {
    search(world);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(SearchView, RefusesWhatDoesNotBelongTogether) {
  TwoBlocks labels;
  labels.labels = {1};
  EXPECT_NE(complaint(labels).find("1 point labels for 2 contour points"), std::string::npos);
  TwoBlocks range;
  range.labels = {1, 9};
  EXPECT_NE(complaint(range).find("label 9; there are 2 segments"), std::string::npos);
  TwoBlocks rolls;
  rolls.config.views.rolls = 4;  // the positions were made for 8
  EXPECT_NE(complaint(rolls).find("position 1 has first id 8"), std::string::npos);
}

TEST(PlannerConfig, NamesFieldAndValue) {
  const auto said = [](auto change) -> std::string {
    ContourPlannerConfig config;
    change(config);
    try {
      config.validate();
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(said([](ContourPlannerConfig&) {}), "");
  EXPECT_NE(said([](auto& c) { c.gain.reduction = 0; }).find("gain.reduction = 0"), std::string::npos);
  EXPECT_NE(said([](auto& c) { c.gain.gain_threshold = -3; }).find("gain.threshold = -3"), std::string::npos);
  EXPECT_NE(said([](auto& c) { c.gain.sphere_margin_m = std::nan(""); }).find("gain.sphere_margin_m = nan"),
            std::string::npos);
  EXPECT_NE(said([](auto& c) { c.gain.disappointing_share = 1.5; }).find("gain.disappointing_share = 1.5"),
            std::string::npos);
  EXPECT_NE(said([](auto& c) { c.views.rolls = 0; }).find("views.rolls = 0"), std::string::npos);
}

}  // namespace
}  // namespace vantage
