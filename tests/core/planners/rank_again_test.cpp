#include "core/planners/rank_again.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "tests/core/planners/half_known_block.h"

namespace vantage {
namespace {

using Eigen::Vector3d;
using test::HalfKnownBlock;

/// A search over the half known block with some views taken before.
struct Bench {
  HalfKnownBlock block;
  HierarchicalPlannerConfig config = block.config();
  Pose current = lookAt(Vector3d(-1.0, 0.03, 0.02), Vector3d::Zero());
  std::vector<ViewCandidate> candidates = icosphereViews(block.object_box.center(), 1.0, 1);
  std::vector<Pose> executed;
  StatePyramid pyramid = block.pyramid();
  RayTree tree = RayTree(config.sensor, HalfKnownBlock::kVoxel_m, 3);

  Bench() {
    candidates.push_back({80, lookAt(Vector3d(0.1, 0, 0), Vector3d(1, 0, 0))});  // in unknown space
    candidates.push_back({81, lookAt(Vector3d(-1, 0, 0), Vector3d(-2, 0, 0))});  // looks away
    candidates.push_back({82, lookAt(Vector3d(9, 0, 0), Vector3d::Zero()), 5});  // outside the map
    candidates.push_back({83, lookAt(Vector3d(-1, 0.2, 0), Vector3d::Zero()), 6});
  }
  UtilityInput input() const {
    return {.pyramid = pyramid,
            .tree = tree,
            .object_box = block.object_box,
            .candidates = candidates,
            .current = current,
            .executed = executed};
  }
  UtilitySearch search(const HierarchicalPlannerConfig& wanted, const ReachPose& reach) const {
    return searchUtility(input(), wanted, reach, {});
  }
};

/// A verdict for each position, drawn by the seed.
ReachPose moodyRobot(std::uint32_t seed) {
  return [seed](const Pose& pose) {
    const Vector3d p = 1e4 * pose.translation();
    std::seed_seq sequence{static_cast<int>(seed), static_cast<int>(p.x()), static_cast<int>(p.y()),
                           static_cast<int>(p.z())};
    std::mt19937 random(sequence);
    MotionPlan plan;
    plan.verdict = random() % 3 == 0 ? Reachability::Reachable : Reachability::InCollision;
    return plan;
  };
}

void expectSameView(const ViewUtility& fresh, const ViewUtility& again) {
  EXPECT_EQ(again.id, fresh.id);
  EXPECT_EQ(again.frame, fresh.frame);
  EXPECT_EQ(again.T_world_camera.matrix(), fresh.T_world_camera.matrix());
  EXPECT_EQ(again.rejection, fresh.rejection);
  EXPECT_EQ(again.reachability, fresh.reachability);
  EXPECT_EQ(again.rays, fresh.rays);
  EXPECT_EQ(again.unknown, fresh.unknown);
  EXPECT_EQ(again.occupied, fresh.occupied);
  EXPECT_EQ(again.surface, fresh.surface);
  EXPECT_EQ(again.distance, fresh.distance);
  EXPECT_EQ(again.utility, fresh.utility);
}

void expectSameCounts(const UtilitySearch& fresh, const UtilitySearch& again) {
  EXPECT_EQ(again.counts.poses_generated, fresh.counts.poses_generated);
  EXPECT_EQ(again.counts.poses_scored, fresh.counts.poses_scored);
  EXPECT_EQ(again.counts.poses_above_threshold, fresh.counts.poses_above_threshold);
  EXPECT_EQ(again.counts.poses_unreachable, fresh.counts.poses_unreachable);
  EXPECT_EQ(again.counts.poses_executed_before, fresh.counts.poses_executed_before);
  EXPECT_EQ(again.counts.rays, fresh.counts.rays);
  EXPECT_EQ(again.counts.voxels_visited, fresh.counts.voxels_visited);
  EXPECT_EQ(again.counts.paths_planned, fresh.counts.paths_planned);
  EXPECT_EQ(again.finest_rays_cast, fresh.finest_rays_cast);
  EXPECT_EQ(again.rejected_position, fresh.rejected_position);
  EXPECT_EQ(again.rejected_registration, fresh.rejected_registration);
}

void expectSameSearch(const UtilitySearch& fresh, const UtilitySearch& again) {
  ASSERT_EQ(again.views.size(), fresh.views.size());
  for (std::size_t n = 0; n < fresh.views.size(); ++n) expectSameView(fresh.views[n], again.views[n]);
  EXPECT_EQ(again.ranking, fresh.ranking);
  expectSameCounts(fresh, again);
  EXPECT_EQ(again.box_unknown, fresh.box_unknown);
  EXPECT_EQ(again.box_occupied, fresh.box_occupied);
  EXPECT_EQ(again.best_unknown, fresh.best_unknown);
  EXPECT_EQ(again.literal_stop, fresh.literal_stop);
  ASSERT_EQ(again.chosen.has_value(), fresh.chosen.has_value());
  if (!fresh.chosen) return;
  EXPECT_EQ(again.chosen->id, fresh.chosen->id);
  EXPECT_EQ(again.chosen->gain, fresh.chosen->gain);
  EXPECT_EQ(again.chosen->path.verdict, fresh.chosen->path.verdict);
}

/// Changes everything that a ranking from kept rays may change.
HierarchicalPlannerConfig shaken(const Bench& bench, std::mt19937& random) {
  HierarchicalPlannerConfig wanted = bench.config;
  wanted.min_occupied = random() % 400;
  wanted.min_overlap = random() % 2 ? 0.0 : random() % 10 * 0.1;
  wanted.stop_gain = random() % 600;
  wanted.rotation_weight_m_per_rad = random() % 5 * 0.5;
  wanted.exclude_executed = bench.config.exclude_executed || random() % 2 == 0;
  wanted.executed_distance_m += random() % 10 * 0.05;
  wanted.executed_angle_rad += random() % 10 * 0.1;
  return wanted;
}

TEST(RankAgain, EqualsAFreshSearchForRandomConfigurations) {
  std::mt19937 random(3);
  int chosen = 0, registration = 0, executed = 0, unreachable = 0;
  for (int n = 0; n < 60; ++n) {
    SCOPED_TRACE(n);
    Bench bench;
    for (int k = 0; k < 3; ++k)
      bench.executed.push_back(bench.candidates[random() % bench.candidates.size()].T_world_camera);
    bench.config.exclude_executed = n % 3 == 0;
    const UtilitySearch recorded = bench.search(bench.config, test::reachAll);
    const HierarchicalPlannerConfig wanted = shaken(bench, random);
    ASSERT_TRUE(canRankAgain(bench.config, wanted));
    const ReachPose reach = moodyRobot(random());
    const UtilitySearch fresh = bench.search(wanted, reach);
    const UtilitySearch again = rankAgain(recorded, wanted, bench.current, bench.executed, reach);
    expectSameSearch(fresh, again);
    if (fresh.chosen) {
      EXPECT_EQ(countVoxels(bench.input(), again.chosen->T_world_camera), fresh.chosen->gain_voxels);
    }
    chosen += fresh.chosen.has_value();
    registration += fresh.rejected_registration != recorded.rejected_registration;
    executed += fresh.counts.poses_executed_before != recorded.counts.poses_executed_before;
    unreachable += fresh.counts.poses_unreachable > 0;
  }
  // Every kind of change was met.
  EXPECT_GT(chosen, 10);
  EXPECT_LT(chosen, 60);
  EXPECT_GT(registration, 10);
  EXPECT_GT(executed, 10);
  EXPECT_GT(unreachable, 10);
}

TEST(RankAgain, RefusesWhatNeedsOtherRays) {
  HierarchicalPlannerConfig have;
  const auto allowed = [&](auto change) {
    HierarchicalPlannerConfig wanted = have;
    change(wanted);
    return canRankAgain(have, wanted);
  };
  EXPECT_TRUE(allowed([](auto&) {}));
  EXPECT_TRUE(allowed([](auto& c) { c.min_occupied = 3; }));
  EXPECT_TRUE(allowed([](auto& c) { c.exclude_executed = true; }));
  EXPECT_FALSE(allowed([](auto& c) { c.coarse_levels = 1; }));
  EXPECT_FALSE(allowed([](auto& c) { c.body_m = 0.1; }));
  EXPECT_FALSE(allowed([](auto& c) { c.workspace_views = 10; }));
  EXPECT_FALSE(allowed([](auto& c) { c.sensor.max_range_m = 1.0; }));
  EXPECT_FALSE(allowed([](auto& c) { c.refine_unknown = true; }));
  have.exclude_executed = true;  // what it left out was never cast
  EXPECT_TRUE(allowed([](auto& c) { c.executed_distance_m = 0.5; }));
  EXPECT_FALSE(allowed([](auto& c) { c.executed_distance_m = 0.01; }));
  EXPECT_FALSE(allowed([](auto& c) { c.executed_angle_rad = 0.01; }));
  EXPECT_FALSE(allowed([](auto& c) { c.exclude_executed = false; }));
}

TEST(RankAgain, RefusesValuesOutOfRange) {
  const Bench bench;
  HierarchicalPlannerConfig wanted = bench.config;
  wanted.min_overlap = 2.0;
  EXPECT_THROW(rankAgain({}, wanted, bench.current, {}, test::reachAll), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
