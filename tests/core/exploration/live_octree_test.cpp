// The grid of a run never drifts from the octree that it stands for: every tenth iteration of table-top
// reconstructions (evaluation.md, A1) is cast again over OctoMap's own copy of the live tree.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <string>
#include <vector>

#include "tests/support/octree_caster.h"
#include "tests/support/simulated_run.h"

namespace vantage {
namespace {

struct Check {
  std::string planner;
  int coarse_levels;
  const char* child_start;
  std::size_t every;  ///< view that is cast again: full resolution takes a second a view
};

/// Of a run.
struct Progress {
  int compared_iterations = 0;
  int compared_views = 0;
};

void compare(const StepRecord& record, const WorldModel& world, const ExplorationConfig& config,
             const Check& check, Progress& progress) {
  const RayTree tree(config.hierarchical.sensor, config.octree.voxel_size_m,
                     config.hierarchical.coarse_levels);
  HierarchicalQuery query;
  query.bounds = config.objectBox();
  query.start = config.hierarchical.child_start;
  const int levels = check.planner == "uniform" ? 0 : check.coarse_levels;
  std::vector<const ViewUtility*> views;
  std::size_t cast = 0;
  for (const ViewUtility& view : record.utilities->views)
    if (view.rays.rays_cast > 0 && cast++ % check.every == 0) views.push_back(&view);
  const testing::OctreeCaster reference(*world.octree());
  std::vector<RayCounts> expected(views.size());
  tbb::parallel_for(std::size_t{0}, views.size(), [&](std::size_t n) {
    expected[n] = reference.cast(tree, levels, views[n]->T_world_camera, query);
  });
  for (std::size_t n = 0; n < views.size(); ++n)
    EXPECT_EQ(views[n]->rays, expected[n])
        << check.planner << " step " << record.step << " view " << views[n]->id;
  ++progress.compared_iterations;
  progress.compared_views += static_cast<int>(views.size());
}

void reconstruct(const char* scene, const Check& check, Progress& progress) {
  const Settings settings = testing::sceneSettings(
      scene,
      {"exploration.planner=" + check.planner, "rays.coarse_levels=" + std::to_string(check.coarse_levels),
       std::string("rays.child_start=") + check.child_start, "exploration.steps=11"});
  testing::exploreScene(scene, settings, 2, [&](const StepRecord& record, const WorldModel& world) {
    if (record.stage == Stage::Evaluation && record.step % 10 == 1)
      compare(record, world, settings.exploration, check, progress);
  });
}

TEST(LiveOctree, GivesTheCountsOfEveryViewOfEveryTenthIteration) {
  for (const Check& check : {Check{"hierarchical", 2, "resume", 1}, Check{"hierarchical", 3, "restart", 1}}) {
    Progress progress;
    reconstruct("a1_compact", check, progress);
    EXPECT_EQ(progress.compared_iterations, 2) << check.child_start;
    EXPECT_GE(progress.compared_views, 300) << check.child_start;
  }
}

TEST(LiveOctree, GivesTheUniformCountsOfEverySixteenthViewOfEveryTenthIteration) {
  Progress progress;
  reconstruct("a1_elongated", {"uniform", 2, "resume", 16}, progress);
  EXPECT_EQ(progress.compared_iterations, 2);
  EXPECT_GE(progress.compared_views, 20);
}

}  // namespace
}  // namespace vantage
