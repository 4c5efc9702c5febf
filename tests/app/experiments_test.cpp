// The experiments of the hierarchical planner on tiny maps: 4 cm voxels, 80 candidates, a few steps.

#include "viewer/app/experiments/experiments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "io/config_file.h"
#include "tests/support/process.h"
#include "viewer/app/experiments/evaluation_time.h"
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
  EXPECT_GT(uniform.coverage, 0.2);
  EXPECT_LT(uniform.accuracy_mean_m, 0.04);
  EXPECT_LE(uniform.accuracy_mean_m, uniform.accuracy_95_m);
}

TEST(TableRun, AnInterruptionEndsIt) {
  const TableSetup setup = setUpTable(compactStandIn(), 0.35, 2, makeTiny);
  std::stop_source stop;
  stop.request_stop();
  RunControl control;
  control.stop = stop.get_token();
  EXPECT_THROW(runOnTable(setup, {.coarse_levels = 1}, 0, control), Cancelled);
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
}

TEST(A3, TimesTheRoomAndSaysThatTheReplayWasSkipped) {
  const Report report = runA3(tinyOptions(), {});
  ASSERT_EQ(report.tables.size(), 1u);
  EXPECT_EQ(report.tables[0].rows.size(), 2u) << "paper and room";
  bool skipped = false;
  for (const std::string& note : report.notes) skipped = skipped || note.find("skipped") != std::string::npos;
  EXPECT_TRUE(skipped);
  EXPECT_EQ(report.claims.size(), 3u);
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
  report.defaults = {{"w", "1", "D-A17"}};
  report.notes = {"note"};
  return report;
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
