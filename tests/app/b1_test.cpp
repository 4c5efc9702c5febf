// B1's report on made-up runs, and runs that are kept.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <stdexcept>

#include "tests/support/process.h"
#include "viewer/app/experiments/b1_report.h"

namespace vantage::experiments {
namespace {

using ::testing::HasSubstr;

/// A run whose first `ticks` NBVs look at objects.
ExplorationRun runOf(const std::string& scene, bool proposed, std::uint64_t seed, int ticks,
                     double unknown_left, std::uint64_t rays) {
  ExplorationRun run;
  run.run = {scene, Series::Core, proposed, seed};
  for (int i = 0; i < kNbvs; ++i) {
    NbvResult nbv;
    nbv.chosen = true;
    nbv.toward_object = i < ticks;
    nbv.generated = 1000;
    nbv.scored = proposed ? 100 : 1000;
    nbv.rays = rays;
    nbv.seconds.evaluation = proposed ? 1.0 : 8.0;
    nbv.seconds.segmentation = proposed ? 0.5 : 0.0;
    if (proposed) {
      nbv.saliency_check = {true, 0.99, 0.11};
      nbv.segments = {{0.5, 40, 1, "jug A"}, {0.1, 80, 2, ""}, {0.05, 40, 1, ""}};
    }
    run.nbvs.push_back(nbv);
    run.unknown_near_objects.push_back(1000.0 - i * (1000.0 - unknown_left) / kNbvs);
  }
  run.unknown_near_objects.push_back(unknown_left);
  run.unknown_in_boxes = run.unknown_near_objects;
  return run;
}

Runs passingRuns() {
  Runs runs;
  for (const char* scene : {"tabletop", "clutter", "apart", "row"})
    for (const std::uint64_t seed : {1, 2}) {
      runs.push_back(runOf(scene, true, seed, 4, 100.0, 10));
      runs.push_back(runOf(scene, false, seed, 1, 300.0, 200));
    }
  return runs;
}

const Claim& claimOf(const Report& report, const std::string& number) {
  for (const Claim& claim : report.claims)
    if (claim.experiment == number) return claim;
  throw std::runtime_error("no claim " + number);
}

Report judged(const Runs& runs) {
  Report report;
  judgeB1(runs, report);
  return report;
}

TEST(B1, FiguresOfARunFollowFromItsNbvs) {
  const ExplorationRun run = runOf("row", true, 1, 3, 500.0, 10);
  EXPECT_EQ(run.ticks(), 3);
  EXPECT_TRUE(run.ticksFirst());
  EXPECT_DOUBLE_EQ(run.area(), 5 * 750.0) << "a straight line from 1000 to 500";
  EXPECT_DOUBLE_EQ(run.seconds().nbv(), 5 * 1.5);
  ExplorationRun late = run;
  late.nbvs[0].toward_object = false;
  EXPECT_FALSE(late.ticksFirst());
}

TEST(B1, AllCriteriaPassWhereTheyShould) {
  const Report report = judged(passingRuns());
  ASSERT_EQ(report.claims.size(), 10u);
  for (const Claim& claim : report.claims) {
    if (claim.experiment == "B1 (6)") continue;
    EXPECT_EQ(claim.verdict, Verdict::Pass) << claim.experiment << ": " << claim.ours;
  }
  EXPECT_EQ(claimOf(report, "B1 (1)").ours, "10.0 %");
  EXPECT_EQ(claimOf(report, "B1 (2a)").ours, "20.0");
  EXPECT_EQ(claimOf(report, "B1 (3a)").ours, "16.0 against 4.0 of 20");
  EXPECT_EQ(claimOf(report, "B1 (6)").verdict, Verdict::Missed) << "evaluation is larger";
}

TEST(B1, EachCriterionCanBeMissed) {
  const auto with = [](const std::string& number, auto change) {
    Runs runs = passingRuns();
    for (ExplorationRun& run : runs) change(run);
    return claimOf(judged(runs), number).verdict;
  };
  const auto eachNbv = [](auto change) {
    return [change](ExplorationRun& run) {
      for (NbvResult& nbv : run.nbvs) change(run, nbv);
    };
  };
  EXPECT_EQ(with("B1 (1)", eachNbv([](auto& run, auto& nbv) { nbv.scored = run.run.proposed ? 130 : 1000; })),
            Verdict::Missed);
  EXPECT_EQ(with("B1 (2a)", eachNbv([](auto& run, auto& nbv) { nbv.rays = run.run.proposed ? 20 : 200; })),
            Verdict::Missed);
  EXPECT_EQ(with("B1 (2b)", eachNbv([](auto& run, auto& nbv) {
                   if (!run.run.proposed) nbv.seconds.evaluation = 2.0;
                 })),
            Verdict::Missed);
  EXPECT_EQ(with("B1 (2b)", eachNbv([](auto& run, auto& nbv) {
                   if (run.run.proposed) nbv.seconds.segmentation = 5.0;
                 })),
            Verdict::NotComparable)
      << "segmentation decides";
  EXPECT_EQ(with("B1 (2c)", eachNbv([](auto& run, auto& nbv) {
                   if (run.run.proposed) nbv.seconds.motion = 100.0;
                 })),
            Verdict::Missed);
  EXPECT_EQ(with("B1 (3a)", eachNbv([](auto& run, auto& nbv) { nbv.toward_object &= !run.run.proposed; })),
            Verdict::Missed);
  EXPECT_EQ(with("B1 (3b)", [](ExplorationRun& run) { run.nbvs[0].toward_object = false; }), Verdict::Missed);
  EXPECT_EQ(with("B1 (4a)",
                 [](ExplorationRun& run) {
                   if (run.run.proposed && run.run.scene == "row") run.unknown_near_objects.back() = 400.0;
                 }),
            Verdict::Missed);
  EXPECT_EQ(with("B1 (4b)",
                 [](ExplorationRun& run) {
                   if (run.run.proposed && run.run.scene != "row") run.unknown_near_objects.assign(6, 2000.0);
                 }),
            Verdict::Missed);
  EXPECT_EQ(with("B1 (5)", eachNbv([](auto&, auto& nbv) {
                   if (nbv.saliency_check) nbv.saliency_check->object_share = 0.9;
                 })),
            Verdict::Missed);
}

TEST(B1, PartOfTheProtocolIsNamedAsSuch) {
  Runs runs = passingRuns();
  std::erase_if(runs, [](const ExplorationRun& run) { return run.run.scene != "tabletop"; });
  for (const Claim& claim : judged(runs).claims)
    EXPECT_THAT(claim.remark, HasSubstr("on 1 of 4 scenes, ")) << claim.experiment;
}

TEST(B1, WithoutBothMethodsNothingIsJudged) {
  Runs runs = passingRuns();
  std::erase_if(runs, [](const ExplorationRun& run) { return !run.run.proposed; });
  EXPECT_TRUE(judged(runs).claims.empty());
}

TEST(B1, TablesHoldThePaperBesideOurs) {
  const Runs runs = passingRuns();
  EXPECT_THAT(tableText(phaseTable(runs, Series::Core)), HasSubstr("288.5 +- 39.0"));
  EXPECT_THAT(tableText(tickTable(runs)), HasSubstr("y y y y x"));
  const std::string segments = tableText(segmentTable(runs));
  EXPECT_THAT(segments, HasSubstr("jug A"));
  EXPECT_EQ(segments.find("first non-object"), segments.rfind("first non-object")) << "marked once";
  EXPECT_EQ(nbvTable(runs).rows.size(), runs.size() * kNbvs);
  for (const Table& table :
       {nbvTable(runs), phaseTable(runs, Series::Core), tickTable(runs), segmentTable(runs)})
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size()) << table.name;
  Runs with_others = runs;
  with_others[0].run.series = Series::Exact;
  with_others[1].run.series = Series::Unseen;
  const std::vector<Table> tables = runTables(with_others);
  ASSERT_EQ(tables.size(), 3u);
  for (std::size_t t = 0; t < tables.size(); ++t) {
    EXPECT_EQ(tables[t].rows.size(), t == 0 ? runs.size() - 2 : 1u) << tables[t].name;
    for (const auto& row : tables[t].rows) EXPECT_EQ(row.size(), tables[t].columns.size()) << tables[t].name;
  }
  EXPECT_EQ(runTables(runs).size(), 1u);
  const auto plots = unknownPlots(runs);
  ASSERT_EQ(plots.size(), 4u);
  EXPECT_EQ(plots[0].series.size(), 2u);
  EXPECT_EQ(plots[0].series[0].values.size(), 6u);
}

TEST(KeptRuns, GiveBackWhatWasKeptForTheSameSetupAlone) {
  const test::TemporaryFolder folder;
  const ExplorationRun run = runOf("tabletop", true, 2, 3, 123.0, 77);
  const KeptRuns kept(folder.path() / "runs", "1.0");
  EXPECT_FALSE(kept.find(run.run, {}));
  kept.keep(run, {});
  const auto found = kept.find(run.run, {});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->run.text(), run.run.text());
  EXPECT_EQ(found->unknown_near_objects, run.unknown_near_objects);
  ASSERT_EQ(found->nbvs.size(), run.nbvs.size());
  EXPECT_EQ(found->nbvs[2].rays, 77u);
  EXPECT_EQ(found->nbvs[2].toward_object, true);
  EXPECT_EQ(found->nbvs[2].segments.size(), 3u);
  EXPECT_EQ(found->nbvs[2].segments[0].object, "jug A");
  EXPECT_DOUBLE_EQ(found->nbvs[2].saliency_check->object_share, 0.99);
  EXPECT_DOUBLE_EQ(found->seconds().nbv(), run.seconds().nbv());

  RunOf other = run.run;
  other.seed = 3;
  EXPECT_FALSE(kept.find(other, {})) << "another run";
  RunOf variant = run.run;
  variant.variant = "B_th = 0.05 m";
  variant.settings = {"saliency.isolation_distance_m=0.05"};
  EXPECT_FALSE(kept.find(variant, {})) << "another variant";
  kept.keep(ExplorationRun{variant, run.nbvs, run.unknown_near_objects, run.unknown_in_boxes, 0.5, "done"},
            {});
  EXPECT_TRUE(kept.find(variant, {}));
  EXPECT_TRUE(kept.find(run.run, {}));
  EXPECT_FALSE(KeptRuns(folder.path() / "runs", "1.1").find(run.run, {})) << "another program";
  EXPECT_FALSE(kept.find(run.run, [](Settings& s) { s.exploration.contour.gain.gain_threshold = 500; }))
      << "other settings";
  ExplorationRun shortened = run;
  shortened.nbvs.resize(1);
  kept.keep(shortened, {});
  EXPECT_FALSE(kept.find(run.run, {})) << "views are missing";
  shortened = run;
  shortened.unknown_near_objects.resize(1);
  kept.keep(shortened, {});
  EXPECT_FALSE(kept.find(run.run, {})) << "a curve is cut short";
  kept.keep(run, {});
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_FALSE(kept.find(run.run, {})) << "another number of threads, other times";
  }
  EXPECT_TRUE(kept.find(run.run, {}));
  test::writeFile(folder.path() / "runs/tabletop-core-proposed-2.json", "{\"setup\": ");
  EXPECT_FALSE(kept.find(run.run, {})) << "cut short";
  EXPECT_FALSE(KeptRuns("", "1.0").find(run.run, {})) << "nothing is kept";
}

}  // namespace
}  // namespace vantage::experiments
