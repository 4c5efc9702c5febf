// The loop of the hierarchical planner (Algorithm 1, Vasquez-Gomez et al. 2013) in the embedded scene `room`.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "io/error.h"
#include "tests/support/simulated_run.h"

namespace vantage {
namespace {

using testing::RunObserver;
using testing::SimulatedRun;

/// Two centimetres instead of one: an iteration takes some milliseconds.
Settings coarseRoom(const std::string& planner, int steps) {
  return testing::sceneSettings(
      "room", {"octree.voxel_size_m=0.02", "scan.initial_frames=1", "scan.initial_arc_m=0", "scan.frames=1",
               "scan.tilt_deg=0", "camera.noise_at_1m_m=0", "camera.emitter_shadow=false",
               "utility.min_occupied=100", "utility.stop_gain=25", "volume.voxel_size_m=0.02",
               "volume.size=[181,181,101]", "fusion.truncation_m=0.06", "segmentation.voxel_m=0.03",
               "segmentation.seed_m=0.08", "contours.group_distance_m=0.08", "exploration.planner=" + planner,
               "exploration.steps=" + std::to_string(steps)});
}

SimulatedRun explore(const Settings& settings, int threads = 2, const RunObserver& observer = {}) {
  return testing::exploreScene("room", settings, threads, observer);
}

TEST(HierarchicalLoop, UnknownSpaceInTheBoxFallsOverTwoStepsUntilNothingIsLeftToGain) {
  const SimulatedRun run = explore(coarseRoom("hierarchical", 20));
  EXPECT_EQ(run.stop_reason, "finished");
  ASSERT_GE(run.steps.size(), 3u);
  for (std::size_t n = 0; n + 1 < run.steps.size(); ++n) {
    const StepRecord& step = run.steps[n];
    ASSERT_TRUE(step.hasView()) << n;
    EXPECT_GE(step.utilities->best_unknown, 25.0) << n;  // D-A18
    EXPECT_GE(chosenUtility(*step.utilities)->occupied, 100.0) << n;
    EXPECT_EQ(step.chosen()->path.verdict, Reachability::Reachable) << n;
    const std::uint64_t before = step.box->unknown, after = run.steps[n + 1].box->unknown;
    // A hit and two misses are unknown again (10.3), so that one scan alone can lose some voxels.
    if (n + 2 < run.steps.size()) {
      EXPECT_LT(run.steps[n + 2].box->unknown, before) << n;
    }
    EXPECT_EQ(step.realised_voxels, before - std::min(before, after)) << n;
  }
  const StepRecord& last = run.steps.back();
  EXPECT_FALSE(last.hasView());
  EXPECT_LT(last.utilities->best_unknown, 25.0);  // D-A18
  EXPECT_LT(last.box->unknown, run.steps.front().box->unknown / 4);
  EXPECT_EQ(last.search, nullptr);
  EXPECT_EQ(last.contours, nullptr);
}

TEST(HierarchicalLoop, WithoutCoarseLevelsEveryViewIsThatOfUniformRayTracing) {
  const Settings settings = coarseRoom("uniform", 4);
  const ExplorationConfig& config = settings.exploration;
  const RayTree tree(config.hierarchical.sensor, config.octree.voxel_size_m, 0);
  int compared = 0;
  explore(settings, 2, [&](const StepRecord& record, const WorldModel& world) {
    if (record.stage != Stage::Evaluation) return;
    const HierarchicalQuery query = queryOf(config.objectBox(), config.hierarchical);
    for (const ViewUtility& view : record.utilities->views) {
      if (view.rays.rays_cast == 0) continue;  // dropped before its rays
      ++compared;
      EXPECT_EQ(castHierarchical(*world.pyramid(), tree, 0, view.T_world_camera, query), view.rays)
          << record.step << " " << view.id;
    }
  });
  EXPECT_GT(compared, 500);
}

TEST(HierarchicalLoop, WithoutCoarseLevelsChoosesTheViewsOfTheUniformPlanner) {
  Settings flat = coarseRoom("hierarchical", 4);
  flat.exploration.hierarchical.coarse_levels = 0;
  const SimulatedRun hierarchical = explore(flat), uniform = explore(coarseRoom("uniform", 4));
  ASSERT_EQ(hierarchical.steps.size(), uniform.steps.size());
  ASSERT_GE(uniform.steps.size(), 3u);
  for (std::size_t n = 0; n < uniform.steps.size(); ++n) {
    const UtilitySearch &a = *hierarchical.steps[n].utilities, &b = *uniform.steps[n].utilities;
    ASSERT_EQ(a.views.size(), 320u);
    for (std::size_t v = 0; v < a.views.size(); ++v)
      EXPECT_EQ(a.views[v].rays, b.views[v].rays) << n << " " << v;
    EXPECT_EQ(a.ranking, b.ranking) << n;
    ASSERT_EQ(a.chosen.has_value(), b.chosen.has_value()) << n;
    if (a.chosen) {
      EXPECT_EQ(a.chosen->id, b.chosen->id) << n;
    }
  }
}

TEST(HierarchicalLoop, IsTheSameForAnyNumberOfThreads) {
  const SimulatedRun one = explore(coarseRoom("hierarchical", 3), 1),
                     two = explore(coarseRoom("hierarchical", 3), 2);
  ASSERT_EQ(one.steps.size(), two.steps.size());
  ASSERT_EQ(one.steps.size(), 3u);
  for (std::size_t n = 0; n < one.steps.size(); ++n) {
    EXPECT_EQ(one.steps[n].box->unknown, two.steps[n].box->unknown);
    EXPECT_EQ(one.steps[n].utilities->ranking, two.steps[n].utilities->ranking);
    ASSERT_TRUE(one.steps[n].hasView() && two.steps[n].hasView());
    EXPECT_TRUE(one.steps[n].chosen()->T_world_camera.isApprox(two.steps[n].chosen()->T_world_camera, 0.0));
    EXPECT_EQ(one.steps[n].chosen()->path.length_m, two.steps[n].chosen()->path.length_m);
  }
}

TEST(HierarchicalLoop, ARunCanSwitchPlanners) {
  const SimulatedRun run = explore(coarseRoom("hierarchical,uniform,contour", 3));
  ASSERT_EQ(run.steps.size(), 3u) << run.stop_reason;
  const std::vector<std::string> planners = {"hierarchical", "uniform", "contour"};
  for (std::size_t n = 0; n < 3; ++n) {
    const StepRecord& step = run.steps[n];
    EXPECT_EQ(step.planner, planners[n]);
    EXPECT_EQ(step.search != nullptr, planners[n] == "contour");
    EXPECT_EQ(step.utilities != nullptr, planners[n] != "contour");
    EXPECT_TRUE(step.changed_bricks && step.changed_octree_bricks && step.box)
        << n;  // both maps see every scan
  }
  EXPECT_LT(run.steps[2].box->unknown, run.steps[0].box->unknown);
  EXPECT_LT(run.steps[2].metrics.unknown_voxels, run.steps[0].metrics.unknown_voxels);
}

TEST(HierarchicalLoop, MapsThatNoPlannerNeedsAreNotKept) {
  const SimulatedRun a = explore(coarseRoom("hierarchical", 1)), b = explore(coarseRoom("contour", 1));
  ASSERT_EQ(a.steps.size(), 1u);
  ASSERT_EQ(b.steps.size(), 1u);
  EXPECT_TRUE(!a.steps[0].changed_bricks && a.steps[0].changed_octree_bricks);
  EXPECT_TRUE(b.steps[0].changed_bricks && !b.steps[0].changed_octree_bricks);
}

TEST(HierarchicalLoop, ABoxOfFreeSpaceEndsItAtTheFirstEvaluation) {
  Settings settings = coarseRoom("hierarchical", 5);
  // Free space above the objects: the first scan sees through all of it.
  settings.exploration.octree.object_box =
      Box(Eigen::Vector3d(-0.1, -0.1, 1.2), Eigen::Vector3d(0.1, 0.1, 1.3));
  settings.exploration.scan.scene_center_m = Eigen::Vector3d(0, 0, 1.25);
  const SimulatedRun run = explore(settings);
  EXPECT_EQ(run.stop_reason, "finished");
  ASSERT_EQ(run.steps.size(), 1u);
  EXPECT_EQ(run.steps[0].box->unknown, 0u);
  EXPECT_FALSE(run.steps[0].hasView());
}

TEST(HierarchicalLoop, RefusesMoreCoarseLevelsThanTheSensorAllows) {
  Settings settings = coarseRoom("hierarchical", 1);
  settings.exploration.hierarchical.coarse_levels = 7;
  EXPECT_THROW(settings.validate(), InputError);
}

}  // namespace
}  // namespace vantage
