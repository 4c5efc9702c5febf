// The experiments of the hierarchical planner on tiny maps: 4 cm voxels, 80 candidates, a few steps.

#include "viewer/app/experiments/experiments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <stop_token>
#include <tuple>

#include "io/config_file.h"
#include "tests/support/process.h"
#include "viewer/app/experiments/a1_runs.h"
#include "viewer/app/experiments/a3_runs.h"
#include "viewer/app/experiments/evaluation_time.h"
#include "viewer/app/experiments/stop_words.h"
#include "viewer/app/experiments/table_run.h"

namespace vantage::experiments {
namespace {

using Eigen::Vector3d;

void makeTiny(Settings& settings) {
  ExplorationConfig& e = settings.exploration;
  e.octree.voxel_size_m = 0.04;
  e.hierarchical.icosphere_subdivisions = 1;
  e.hierarchical.workspace_views = 60;
  e.hierarchical.min_occupied = 5;
  e.hierarchical.stop_gain = 2;
  e.steps = std::min(e.steps, 3);
  settings.camera = settings.camera.reduced(4);
}

ExperimentOptions tinyOptions() {
  ExperimentOptions options;
  options.quick = true;
  options.sizes_m = {0.35};
  options.max_steps = 2;
  options.repeats = 1;
  options.tune = makeTiny;
  return options;
}

/// The claim of a number, or of a number and an input.
const Claim& claimOf(const Report& report, const std::string& number, const std::string& input = "") {
  for (const Claim& claim : report.claims)
    if (claim.experiment == number && claim.claim.starts_with(input)) return claim;
  throw std::runtime_error("no claim " + number);
}

/// Options whose run is interrupted once so many lines were said.
struct Interruption {
  explicit Interruption(int lines) {
    options.control.stop = stop.get_token();
    options.say = [this, lines](const std::string&) {
      if (++said == lines) stop.request_stop();
    };
  }
  std::stop_source stop;
  int said = 0;
  ExperimentOptions options = tinyOptions();
};

/// A wedge of 2 x 1 x 4 units, the long edge along y.
std::string writeWedge(const test::TemporaryFolder& folder) {
  const std::string path = folder / "wedge.obj";
  std::ofstream(path) << "v 0 0 0\nv 2 0 0\nv 0 0 1\nv 2 0 1\nv 0 4 0\nv 2 4 0\n"
                         "f 1 2 4 3\nf 1 5 6 2\nf 3 4 6 5\nf 1 3 5\nf 2 6 4\n";
  return path;
}

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

UtilitySearch searchWith(std::size_t views, std::size_t survivors, double best_unknown) {
  UtilitySearch search;
  search.views.resize(views);
  search.ranking.resize(survivors);
  search.best_unknown = best_unknown;
  search.rejected_position = 3;
  search.rejected_registration = 4;
  search.counts.poses_executed_before = 2;
  search.counts.paths_planned = 5;
  return search;
}

TEST(StopWords, TellWhyNoViewWasTaken) {
  const auto words = [](const UtilitySearch& search) { return stopWords({"finished", 1}, &search, 100.0); };
  EXPECT_EQ(words(searchWith(9, 0, 0.0)),
            "finished: no view survives: 3 by position, 4 by registration, 2 taken before");
  EXPECT_EQ(words(searchWith(9, 2, 37.0)),
            "finished: no view sees h_stop: 37 unknown at most, 100 asked for");
  EXPECT_EQ(words(searchWith(9, 2, 137.0)), "finished: no view that shows enough can be reached: 5 tried");
  EXPECT_EQ(words(searchWith(0, 0, 0.0)), "finished: no candidates");
  EXPECT_EQ(stopWords({"steps done", 20}, nullptr, 100.0), "cut off after 20 steps");
  EXPECT_EQ(stopWords({"no frames left", 3}, nullptr, 100.0), "no frames left");
}

/// A run that took `scans` scans and covered so much, with a second of planning a step.
RunResult runWith(int coarse_levels, int scans, bool cut_off, double coverage) {
  RunResult run;
  run.spec.coarse_levels = coarse_levels;
  run.scans = scans;
  run.cut_off = cut_off;
  run.coverage = coverage;
  IterationResult step;
  step.nbv_s = coarse_levels == 0 ? 1.0 : 0.05;
  step.scored = 100;
  run.iterations.assign(static_cast<std::size_t>(scans - 1), step);
  return run;
}

Report judged(const RunResult& uniform, const RunResult& hierarchical) {
  Report report;
  judgeRuns({{"thing", 0.2, {uniform, hierarchical}}}, report);
  return report;
}

TEST(A1Criteria, RunsThatEndedAreGraded) {
  const Report good = judged(runWith(0, 10, false, 0.99), runWith(2, 15, false, 0.98));
  EXPECT_EQ(claimOf(good, "A1 (3)").verdict, Verdict::Pass);
  EXPECT_EQ(claimOf(good, "A1 (3)").ours, "-1.0 points (thing 0.20 m m=2 resume)");
  EXPECT_EQ(claimOf(good, "A1 (4a)").verdict, Verdict::Pass);
  EXPECT_EQ(claimOf(good, "A1 (4b)").verdict, Verdict::Pass);
  const Report bad = judged(runWith(0, 10, false, 0.99), runWith(2, 17, false, 0.96));
  EXPECT_EQ(claimOf(bad, "A1 (3)").verdict, Verdict::Missed);
  EXPECT_EQ(claimOf(bad, "A1 (4a)").verdict, Verdict::Missed);
  EXPECT_EQ(claimOf(bad, "A1 (4a)").remark.find("cut off"), std::string::npos);
}

TEST(A1Criteria, RunsThatWereBothCutOffAreNotComparable) {
  const Report report = judged(runWith(0, 21, true, 0.99), runWith(2, 21, true, 0.98));
  for (const char* number : {"A1 (3)", "A1 (3) m=2", "A1 (4a)", "A1 (4b)"}) {
    const Claim& claim = claimOf(report, number);
    EXPECT_EQ(claim.verdict, Verdict::NotComparable) << number;
    EXPECT_NE(claim.remark.find("cut off before they ended: thing 0.20 m m=2 resume: "), std::string::npos)
        << claim.remark;
  }
  EXPECT_NE(claimOf(report, "A1 (4a)").ours.find('1'), std::string::npos);
}

TEST(A1Criteria, ARunThatWasCutOffIsGradedWhereMoreStepsCouldNotChangeTheVerdict) {
  // Uniform would have gone on: it may cover more yet, and takes more views.
  const Report uniform = judged(runWith(0, 21, true, 0.99), runWith(2, 15, false, 0.98));
  EXPECT_EQ(claimOf(uniform, "A1 (3)").verdict, Verdict::NotComparable);
  EXPECT_EQ(claimOf(uniform, "A1 (4a)").verdict, Verdict::Pass);
  EXPECT_TRUE(claimOf(uniform, "A1 (4a)").ours.starts_with("in the end <= 0.714"))
      << claimOf(uniform, "A1 (4a)").ours;
  const Report lost = judged(runWith(0, 21, true, 0.99), runWith(2, 15, false, 0.90));
  EXPECT_EQ(claimOf(lost, "A1 (3)").verdict, Verdict::Missed);
  EXPECT_TRUE(claimOf(lost, "A1 (3)").ours.starts_with("in the end <= -9.0 points"))
      << claimOf(lost, "A1 (3)").ours;
  // The run would have gone on: it may cover more yet, and takes more views.
  const Report run = judged(runWith(0, 15, false, 0.99), runWith(2, 21, true, 0.98));
  EXPECT_EQ(claimOf(run, "A1 (3)").verdict, Verdict::Pass);
  EXPECT_EQ(claimOf(run, "A1 (4a)").verdict, Verdict::NotComparable);
  const Report slow = judged(runWith(0, 10, false, 0.99), runWith(2, 21, true, 0.98));
  EXPECT_EQ(claimOf(slow, "A1 (4a)").verdict, Verdict::Missed);
}

TEST(A1Criteria, NothingMeasuredIsNotRun) {
  EXPECT_EQ(ratio(1.0, 0.0), std::nullopt);
  EXPECT_EQ(ratio(std::nullopt, 1.0), std::nullopt);
  RunResult uniform, hierarchical;  // no step, no hidden view, no coverage
  hierarchical.spec.coarse_levels = 3;
  uniform.scans = hierarchical.scans = 1;
  const Report report = judged(uniform, hierarchical);
  EXPECT_GE(report.claims.size(), 9u);
  for (const Claim& claim : report.claims) {
    EXPECT_EQ(claim.verdict, Verdict::NotRun) << claim.experiment << ": " << claim.ours;
    EXPECT_TRUE(claim.ours.starts_with("nothing was ")) << claim.ours;
  }
  // Uniform ray tracing covers nothing, so nothing can be lost.
  EXPECT_EQ(claimOf(judged(runWith(0, 3, false, 0.0), runWith(2, 3, false, 0.0)), "A1 (3)").verdict,
            Verdict::NotRun);
  // Every candidate was dropped before its rays: the time of nothing.
  uniform.iterations.resize(1, {.nbv_s = 1e-6});
  hierarchical.iterations.resize(1, {.nbv_s = 1e-6});
  EXPECT_EQ(claimOf(judged(uniform, hierarchical), "A1 (1)").verdict, Verdict::NotRun);
  // Nothing but the first scan, which all share.
  EXPECT_EQ(claimOf(judged(runWith(0, 1, false, 0.5), runWith(2, 1, false, 0.5)), "A1 (3)").verdict,
            Verdict::NotRun);
  ObjectRuns set{"thing", 0.2, {uniform, hierarchical}};
  const Table table = mainTable({set});
  EXPECT_EQ(table.rows[1][5].text, "-");
}

TEST(A1Criteria, TellHowManyNodesWereCompared) {
  RunResult uniform = runWith(0, 3, false, 0.9);
  uniform.compared_labels = 1234;
  uniform.compared_steps = 2;
  const Report report = judged(uniform, runWith(2, 3, false, 0.9));
  EXPECT_EQ(claimOf(report, "A1 map").ours, "0 of 1234 nodes differ, at 2 steps");
  EXPECT_EQ(claimOf(report, "A1 map").verdict, Verdict::Pass);
}

TEST(A1, JudgesEveryCriterion) {
  std::vector<double> seconds;
  const Report report = runA1(tinyOptions(), seconds);
  std::set<std::string> judged;
  for (const Claim& claim : report.claims) {
    judged.insert(claim.experiment);
    EXPECT_FALSE(claim.ours.empty()) << claim.experiment;
    if (claim.experiment == "A1 (5)" || claim.experiment == "A1 map") {
      EXPECT_EQ(claim.verdict, Verdict::Pass) << claim.ours;
    }
  }
  for (const char* number : {"A1 (1)", "A1 (2)", "A1 (3)", "A1 (4a)", "A1 (4b)", "A1 (5)"})
    EXPECT_TRUE(judged.contains(number)) << number;
  ASSERT_EQ(seconds.size(), 1u);
  EXPECT_GT(seconds[0], 0.0);
  ASSERT_FALSE(report.tables.empty());
  ASSERT_GE(report.tables[0].rows.size(), 3u);
  const std::string modes[] = {"m=0 uniform", "m=2 resume", "m=3 resume"};
  for (std::size_t n = 0; n < 3; ++n) EXPECT_EQ(report.tables[0].rows[n][2].text, modes[n]);
  EXPECT_GT(report.defaults.size(), 10u);
  EXPECT_TRUE(report.not_run.empty());
}

TEST(A1, AnInterruptionKeepsTheRunsThatWereFinished) {
  Interruption interruption(2);  // within the third of three runs of the first size
  interruption.options.sizes_m = {0.35, 0.30};
  std::vector<double> seconds;
  Report report = runA1(interruption.options, seconds);
  EXPECT_EQ(report.not_run,
            (std::vector<std::string>{"A1 compact 0.35 m (m=3 resume)", "A1 compact 0.30 m (all runs)"}));
  ASSERT_FALSE(report.tables.empty());
  EXPECT_EQ(report.tables[0].rows.size(), 2u);
  report.markInterruption();
  int parts = 0;
  for (const Claim& claim : report.claims) {
    EXPECT_NE(claim.verdict, Verdict::Pass) << claim.experiment;
    parts += claim.remark == "interrupted";
  }
  EXPECT_EQ(parts, 2);
}

TEST(A2, ComparesMeanWithMaximum) {
  const Report report = runA2(tinyOptions());
  ASSERT_EQ(report.tables.size(), 1u);
  const auto& rows = report.tables[0].rows;
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[1][0].text, "max");
  EXPECT_EQ(rows[2][0].text, "mean");
  EXPECT_NE(*rows[2][2].value, *rows[1][2].value) << "occupied hits of the first step";
  EXPECT_EQ(*rows[1][2].value + *rows[1][3].value + *rows[1][4].value,
            *rows[0][2].value + *rows[0][3].value + *rows[0][4].value)
      << "every ray is something";
  EXPECT_EQ(claimOf(report, "A2 (2)").verdict, Verdict::NotComparable) << "cut off after two steps";
}

TEST(A2, AnInterruptionKeepsTheRunsThatWereFinished) {
  Interruption interruption(1);
  const Report report = runA2(interruption.options);
  EXPECT_EQ(report.not_run, std::vector<std::string>{"A2 (1 of 3 runs finished)"});
  ASSERT_EQ(report.tables.size(), 1u);
  EXPECT_EQ(report.tables[0].rows.size(), 1u);
  EXPECT_TRUE(report.claims.empty());
}

TEST(A2, TakesTheFirstMesh) {
  const test::TemporaryFolder folder;
  ExperimentOptions options = tinyOptions();
  EXPECT_EQ(meanObject(options).first.name, "compact");
  options.quick = false;
  options.meshes = {meshObject(writeWedge(folder), UpAxis::Y)};
  EXPECT_EQ(meanObject(options).first.name, "wedge");
}

TEST(A3, TimesTheRoomAndSaysThatTheReplayWasSkipped) {
  const Report report = runA3(tinyOptions(), {});
  ASSERT_EQ(report.tables.size(), 1u);
  EXPECT_EQ(report.tables[0].rows.size(), 2u) << "paper and room";
  bool skipped = false;
  for (const std::string& note : report.notes) skipped = skipped || note.find("skipped") != std::string::npos;
  EXPECT_TRUE(skipped);
  EXPECT_EQ(report.claims.size(), 3u);
  const Claim& per_view = claimOf(report, "A3 (1)");
  EXPECT_EQ(per_view.ours.find("+-"), std::string::npos) << "one seed has no spread";
  EXPECT_NE(per_view.remark.find("A1: was not run, instead 2 steps of compact 0.35 m, m=2 resume"),
            std::string::npos)
      << per_view.remark;
  const Claim& rate = claimOf(report, "A3 (3)");
  EXPECT_EQ(rate.verdict, Verdict::NotRun) << "60 views are not 1500";
  EXPECT_NE(rate.ours.find("for 60 views"), std::string::npos) << rate.ours;
}

TEST(A3, TimesItsOwnEvaluationsWhateverViewsWereTaken) {
  ExperimentOptions options = tinyOptions();
  options.tune = [](Settings& settings) {
    makeTiny(settings);
    settings.exploration.hierarchical.generator = CandidateGenerator::Icosphere;
    settings.exploration.hierarchical.exclude_executed = true;
  };
  const Report report = runA3(options, {1.0});
  EXPECT_GE(report.tables[0].rows[1][13].value.value(), 3.0) << "a view was taken and is not offered again";
}

TEST(A3, AnInterruptionKeepsTheSeedsThatWereFinished) {
  Interruption interruption(1);
  interruption.options.quick = false;
  const Report report = runA3(interruption.options, {});
  EXPECT_EQ(report.not_run.size(), 5u) << "four seeds and the time of A1";
  ASSERT_EQ(report.tables.size(), 1u);
  EXPECT_EQ(report.tables[0].rows[1][1].text, "1");
  EXPECT_EQ(claimOf(report, "A3 (1)").verdict, Verdict::NotRun);
}

RateSet rateSet(double candidates, std::vector<double> unknown, bool cut_off) {
  RateRun run;
  run.steps = {{.scan = 0.1, .update = 0.1, .evaluate = 0.5, .path = 0.0}};
  run.candidates = run.scored = candidates;
  run.unknown_per_scan = std::move(unknown);
  run.cut_off = cut_off;
  return {"room", {run, run}};
}

TEST(A3Criteria, JudgeWhatWasMeasuredAlone) {
  Report report;
  judgeRates(rateSet(1500, {7, 6, 5, 4, 3, 2, 1}, false), {0.001, "mean of its 2 runs with m=2 resume"},
             report);
  EXPECT_EQ(claimOf(report, "A3 (1)").verdict, Verdict::Pass);
  EXPECT_EQ(claimOf(report, "A3 (1)").ours, "0.333 +- 0.000 ms against 1.000 ms");
  EXPECT_EQ(claimOf(report, "A3 (2)").verdict, Verdict::Pass);
  EXPECT_EQ(claimOf(report, "A3 (3)").verdict, Verdict::Pass);
  Report other;
  judgeRates(rateSet(0, {3, 2}, true), {std::nullopt, "not run"}, other);
  EXPECT_EQ(claimOf(other, "A3 (1)").verdict, Verdict::NotRun);
  EXPECT_EQ(claimOf(other, "A3 (2)").verdict, Verdict::NotComparable) << "cut off before the seventh scan";
  EXPECT_EQ(claimOf(other, "A3 (3)").verdict, Verdict::NotRun);
  Report rising;
  judgeRates(rateSet(1500, {7, 6, 6, 4, 3, 2, 1}, false), {0.0001, ""}, rising);
  EXPECT_EQ(claimOf(rising, "A3 (1)").verdict, Verdict::Missed);
  EXPECT_EQ(claimOf(rising, "A3 (2)").verdict, Verdict::Missed);
}

TEST(Experiments, KeepTheirPlannersWhateverIsConfigured) {
  ExperimentOptions options = tinyOptions();
  options.tune = [](Settings& settings) {
    makeTiny(settings);
    settings.exploration.planners = {PlannerKind::Contour};
    settings.exploration.steps = 1;
  };
  std::vector<double> seconds;
  EXPECT_GE(runA1(options, seconds).tables[0].rows.size(), 3u);
  EXPECT_EQ(runA2(options).tables[0].rows.size(), 3u);
  EXPECT_EQ(runA3(options, seconds).tables[0].rows.size(), 2u);
}

TEST(Experiments, ChecksFindWhatIsMissingBeforeTheyRun) {
  ExperimentOptions options = tinyOptions();
  EXPECT_NO_THROW(checkA1(options));
  EXPECT_NO_THROW(checkA2(options));
  EXPECT_NO_THROW(checkA3(options));
  options.meshes = {meshObject("none.obj", UpAxis::Z)};
  EXPECT_THROW(checkA1(options), InputError);
  EXPECT_THROW(checkA2(options), InputError);
  options.dataset = "none";
  EXPECT_THROW(checkA3(options), InputError);
}

std::string defaultOf(const std::vector<DefaultUsed>& defaults, const std::string& name) {
  for (const DefaultUsed& used : defaults)
    if (used.name == name) return used.value;
  return "";
}

TEST(Defaults, AreThoseThatWereUsed) {
  Settings settings;
  settings.exploration.octree.known_scene = true;
  settings.exploration.hierarchical.generator = CandidateGenerator::Workspace;
  settings.exploration.hierarchical.workspace_views = 77;
  EXPECT_EQ(defaultOf(defaultsUsed(settings, "A3", true), "around the object's box"),
            "free; boxes of the scene (table, walls, furniture) known");
  EXPECT_EQ(defaultOf(defaultsUsed(settings, "A3", false), "around the object's box"),
            "free; free where a recorded camera has been");
  EXPECT_EQ(defaultOf(defaultsUsed(settings, "A3", true), "candidates"), "77 drawn in the workspace");
  settings.exploration.recorded_candidates = true;
  EXPECT_EQ(defaultOf(defaultsUsed(settings, "A3", false), "candidates"),
            "77 drawn in the workspace, and the recorded poses that are left");
  settings.exploration.octree.outside = VoxelState::Unknown;
  settings.exploration.octree.known_scene = false;
  settings.exploration.hierarchical.min_overlap = 0.2;
  EXPECT_EQ(defaultOf(defaultsUsed(settings, "A3", true), "around the object's box"),
            "unknown; nothing of the scene known");
  EXPECT_TRUE(defaultOf(defaultsUsed(settings, "A3", true), "least known surface h_oc").starts_with("20 %"));
  ExperimentOptions options = tinyOptions();
  options.sizes_m = {0.1, 0.3};
  EXPECT_EQ(sizesUsed(tableObjects(options), "A1").value, "0.1 m, 0.3 m");
}

TEST(EvaluationTime, IsTheMedian) {
  EXPECT_EQ(median({3, 1, 2}), 2.0);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(median({}), 0.0);
}

Report sampleReport() {
  Report report;
  report.title = "a <b> & \"c\"";
  report.setup = {"threads used: 2"};
  report.tables = {
      {"t", "Title", {"word", "number"}, {{"x, \"y\"", Cell::number(1.25, 1, " %")}, {"z", "-"}}}};
  report.claims = {{"A1 (1)", "claim", "paper", "ours", Verdict::Missed, "why"}};
  report.lines = {{"curve", "scan", "voxels", {{"run", {3, 2, 1}}}}};
  report.bars = {{"bars", " %", {{"run", 4.0}, {"other", 12.0}}, 10.0}};
  report.defaults = {{"w", "1", "D-A17", "A1"}};
  report.notes = {"note"};
  return report;
}

TEST(ReportFiles, ListEqualDefaultsOnceForAllThatUsedThem) {
  Report report, other;
  report.defaults = {{"w", "1", "D-A17", "A1"}};
  other.defaults = {{"w", "1", "D-A17", "A2"}, {"w", "2", "D-A17", "A2"}};
  report.append(std::move(other));
  ASSERT_EQ(report.defaults.size(), 2u);
  EXPECT_EQ(report.defaults[0].where, "A1, A2");
  EXPECT_EQ(report.defaults[1].where, "A2");
}

TEST(ReportFiles, KeepNumbersInFullAndQuoteWords) {
  const Report report = sampleReport();
  EXPECT_EQ(tableCsv(report.tables[0]), "word,number\n\"x, \"\"y\"\"\",1.25\nz,-\n");
  const auto json = nlohmann::json::parse(reportJson(report));
  EXPECT_EQ(json["tables"]["t"]["rows"][0]["number"], 1.25);
  EXPECT_EQ(json["claims"][0]["verdict"], "missed");
  EXPECT_EQ(json["curves"]["curve"]["run"].size(), 3u);
  EXPECT_NE(tableText(report.tables[0]).find("x, \"y\" |  1.2 %"), std::string::npos)
      << tableText(report.tables[0]);
}

TEST(ReportFiles, ThePageIsOfOnePieceAndEscapesWhatItShows) {
  const std::string html = reportHtml(sampleReport());
  EXPECT_NE(html.find("a &lt;b&gt; &amp; &quot;c&quot;"), std::string::npos);
  for (const char* outside : {"src=", "href=", "@import", "url("})
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  for (const char* part : {"<svg", "limit 10 %", "missed", "Defaults that were used", "note"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
}

TEST(ReportFiles, AreWrittenIntoAFolderThatIsMade) {
  const test::TemporaryFolder folder;
  const auto files = writeReport(sampleReport(), folder.path() / "new" / "deep");
  EXPECT_EQ(files.size(), 4u);
  for (const auto& file : files) EXPECT_GT(std::filesystem::file_size(file), 0u) << file;
  test::writeFile(folder.path() / "taken", "x");
  EXPECT_THROW(writeReport(sampleReport(), folder.path() / "taken"), InputError);
}

}  // namespace
}  // namespace vantage::experiments
