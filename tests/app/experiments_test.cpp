#include "viewer/app/experiments/experiments.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <stdexcept>

#include "tests/app/tiny_experiments.h"
#include "viewer/app/experiments/a1_runs.h"
#include "viewer/app/experiments/a3_runs.h"
#include "viewer/app/experiments/stop_words.h"

namespace vantage::experiments {
namespace {

/// The claim of a number, or of a number and an input.
const Claim& claimOf(const Report& report, const std::string& number, const std::string& input = "") {
  for (const Claim& claim : report.claims)
    if (claim.experiment == number && claim.claim.starts_with(input)) return claim;
  throw std::runtime_error("no claim " + number);
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

}  // namespace
}  // namespace vantage::experiments
