#include "viewer/app/experiments/table_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <stop_token>
#include <tuple>

#include "tests/app/tiny_experiments.h"

namespace vantage::experiments {
namespace {

using Eigen::Vector3d;

TEST(Objects, StandOnTheMiddleOfTheTableAtTheSizeAskedFor) {
  for (const ObjectSource& source : {compactStandIn(), elongatedStandIn()})
    for (const double size_m : {0.20, 0.35}) {
      const SceneFile scene = sceneOnTable(source, size_m);
      const Box bounds = objectBounds(scene);
      EXPECT_NEAR(bounds.sizes().maxCoeff(), size_m, 1e-6);
      EXPECT_NEAR(bounds.min().z(), tableTop_m(scene), 1e-6);
      EXPECT_NEAR(bounds.center().x(), 0.0, 1e-6);
      EXPECT_NEAR(bounds.center().y(), 0.0, 1e-6);
    }
}

TEST(Objects, ScaleTheirDistancesToo) {
  const SceneFile small = sceneOnTable(compactStandIn(), 0.2), large = sceneOnTable(compactStandIn(), 0.4);
  const double top = tableTop_m(small);
  int compared = 0;
  for (std::size_t n = 0; n < small.solids.size(); ++n) {
    if (small.solids[n].role() != SolidRole::Object) continue;
    const Vector3d p(0.05, -0.02, 0.04), foot(0, 0, top);
    EXPECT_NEAR(2 * small.solids[n].signedDistance(foot + p), large.solids[n].signedDistance(foot + 2 * p),
                1e-9);
    ++compared;
  }
  EXPECT_GE(compared, 3);
}

TEST(Objects, MeshesAreTurnedUprightScaledAndPutOnTheTable) {
  const test::TemporaryFolder folder;
  const std::string file = writeWedge(folder);
  const Box lying = objectBounds(sceneOnTable(meshObject(file, UpAxis::Z), 0.2));
  EXPECT_TRUE(lying.sizes().isApprox(Vector3d(0.10, 0.20, 0.05), 1e-5));
  const SceneFile scene = sceneOnTable(meshObject(file, UpAxis::Y), 0.2);
  const Box standing = objectBounds(scene);
  EXPECT_TRUE(standing.sizes().isApprox(Vector3d(0.10, 0.05, 0.20), 1e-5));
  EXPECT_NEAR(standing.min().z(), tableTop_m(scene), 1e-6);
  // The wedge is thick at its foot, y = 0.
  for (const Solid& solid : scene.solids)
    if (solid.role() == SolidRole::Object) {
      EXPECT_LT(solid.signedDistance(Vector3d(0, 0.02, standing.min().z() + 0.005)), 0.0);
      EXPECT_GT(solid.signedDistance(Vector3d(0, -0.02, standing.max().z() - 0.005)), 0.0);
    }
  EXPECT_THROW(sceneOnTable(meshObject(folder / "none.obj", UpAxis::Y), 0.2), InputError);
}

TEST(Objects, TheBoxIsTheExtentAndFiveCentimetresFromTheTableUp) {
  const SceneFile scene = sceneOnTable(elongatedStandIn(), 0.35);
  const Box object = objectBounds(scene), box = objectBox(scene);
  EXPECT_NEAR(box.min().x(), object.min().x() - 0.05, 1e-9);
  EXPECT_NEAR(box.max().y(), object.max().y() + 0.05, 1e-9);
  EXPECT_NEAR(box.max().z(), object.max().z() + 0.05, 1e-9);
  EXPECT_NEAR(box.min().z(), 0.43, 1e-9);
}

TEST(Truth, CountsTheSurfaceThatSomeCandidateSees) {
  const SceneFile scene = sceneOnTable(compactStandIn(), 0.35);
  const Box object = objectBounds(scene);
  const auto around = icosphereViews(object.center(), 1.0, 1);
  std::vector<ViewCandidate> left;
  for (const ViewCandidate& view : around)
    if (view.T_world_camera.translation().x() < -0.5) left.push_back(view);
  const auto all = CandidateTruth(scene, around, 0.05).observableSurface();
  const auto half = CandidateTruth(scene, left, 0.05).observableSurface();
  EXPECT_GT(half.size(), 1000u);
  EXPECT_GT(all.size(), half.size());
  float rightmost = -1.0f;
  for (const Eigen::Vector3f& p : half) rightmost = std::max(rightmost, p.x());
  EXPECT_LT(rightmost, object.max().x() - 0.02) << "the far side is hidden";
  EXPECT_TRUE(CandidateTruth(scene, {}, 0.05).observableSurface().empty());
}

// Requirement (i) of section 10.4 and criterion (5) of A1.
TEST(TableRun, WithoutCoarseLevelsEqualsUniformRayTracingInEveryViewOfEveryStep) {
  const TableSetup setup = setUpTable(compactStandIn(), 0.35, 3, makeTiny);
  const RunResult run = runOnTable(setup, {.coarse_levels = 0}, 0, {});
  EXPECT_GT(run.compared_with_uniform, 60u);
  EXPECT_EQ(run.different_from_uniform, 0u);
  EXPECT_EQ(run.wrong_labels, 0u);
  for (const IterationResult& step : run.iterations) {
    EXPECT_EQ(step.rays, step.scored * run.rays_per_view);
    EXPECT_EQ(step.finest_rays, step.rays);
  }
}

TEST(TableRun, EqualsUniformRayTracingForEveryWayOfCasting) {
  const TableSetup setup = setUpTable(compactStandIn(), 0.35, 2, [](Settings& settings) {
    makeTiny(settings);
    HierarchicalPlannerConfig& h = settings.exploration.hierarchical;
    h.count = GainCount::Voxels;
    h.refine_unknown = true;
    h.child_start = ChildStart::Restart;
  });
  const RunResult run = runOnTable(setup, {.coarse_levels = 0, .start = ChildStart::Restart}, 0, {});
  EXPECT_GT(run.compared_with_uniform, 30u);
  EXPECT_EQ(run.different_from_uniform, 0u);
}

TEST(TableRun, ComparesTheLabelsOfEveryNodeOfTheBox) {
  const TableSetup setup = setUpTable(compactStandIn(), 0.35, 1, makeTiny);
  const RunResult run = runOnTable(setup, {.coarse_levels = 3}, 0, {});
  const ExplorationConfig& config = setup.settings.exploration;
  const GridGeometry grid = OccupancyOctree::gridAround(config.volume.bounds(), config.octree.voxel_size_m);
  const StatePyramid pyramid(grid, firstVoxelOf(grid), 3);
  std::size_t nodes = 0;
  for (int level = 0; level <= 3; ++level) {
    std::set<std::tuple<int, int, int>> seen;
    const Eigen::Vector3i low = grid.voxelAt(config.objectBox().min());
    const Eigen::Vector3i high = grid.voxelAt(config.objectBox().max());
    for (int k = low.z(); k <= high.z(); ++k)
      for (int j = low.y(); j <= high.y(); ++j)
        for (int i = low.x(); i <= high.x(); ++i) {
          const Eigen::Vector3i node = pyramid.node({i, j, k}, level);
          seen.emplace(node.x(), node.y(), node.z());
        }
    nodes += seen.size();
  }
  EXPECT_EQ(run.compared_steps, 1);
  EXPECT_EQ(run.compared_labels, nodes);
  EXPECT_GT(nodes, 1000u);
  EXPECT_EQ(run.wrong_labels, 0u);
}

TEST(TableRun, HierarchicalRunsShareTheFirstScanAndVisitLess) {
  const TableSetup setup = setUpTable(compactStandIn(), 0.35, 2, makeTiny);
  const RunResult uniform = runOnTable(setup, {.coarse_levels = 0}, 1, {});
  const RunResult hierarchical = runOnTable(setup, {.coarse_levels = 2}, 1, {});
  ASSERT_FALSE(uniform.iterations.empty());
  ASSERT_FALSE(hierarchical.iterations.empty());
  EXPECT_EQ(hierarchical.unknown_per_scan.front(), uniform.unknown_per_scan.front());
  EXPECT_EQ(hierarchical.iterations[0].scored, uniform.iterations[0].scored);
  EXPECT_LT(hierarchical.iterations[0].visits, uniform.iterations[0].visits / 2);
  EXPECT_EQ(hierarchical.wrong_labels, 0u);
  EXPECT_EQ(hierarchical.hidden.views, uniform.hidden.views);
  EXPECT_GT(uniform.hidden.views, 0u);
  EXPECT_LT(hierarchical.hidden.visits, uniform.hidden.visits / 4);
  EXPECT_GT(uniform.hidden.seconds, 0.0);
  EXPECT_LT(uniform.unknown_per_scan.back(), uniform.unknown_per_scan.front());
  EXPECT_GT(uniform.coverage.value(), 0.2);
  EXPECT_LT(uniform.accuracy_mean_m.value(), 0.04);
  EXPECT_LE(uniform.accuracy_mean_m, uniform.accuracy_95_m);
  EXPECT_TRUE(uniform.cut_off);
  EXPECT_EQ(uniform.stop_reason, "cut off after 2 steps");
}

TEST(TableRun, UnknownNodesHideAThinObjectFromCoarseRaysUnlessTheyAreRefined) {
  const TableSetup setup = setUpTable(elongatedStandIn(), 0.20, 2, {});
  const RunSpec coarse{.coarse_levels = 3}, refined{.coarse_levels = 3, .refine_unknown = true};
  const RunResult hidden = runOnTable(setup, coarse, 1, {}), seen = runOnTable(setup, refined, 1, {});
  EXPECT_EQ(hidden.scans, 1);
  EXPECT_EQ(seen.scans, 3);
  EXPECT_GT(seen.coverage.value(), hidden.coverage.value() + 0.1);
  EXPECT_EQ(refined.label(), "m=3 resume refine unknown");
  EXPECT_FALSE(refined.graded());
}

TEST(TableRun, AnInterruptionEndsIt) {
  const TableSetup setup = setUpTable(compactStandIn(), 0.35, 2, makeTiny);
  std::stop_source stop;
  stop.request_stop();
  RunControl control;
  control.stop = stop.get_token();
  EXPECT_THROW(runOnTable(setup, {.coarse_levels = 1}, 0, control), Cancelled);
}

}  // namespace
}  // namespace vantage::experiments
