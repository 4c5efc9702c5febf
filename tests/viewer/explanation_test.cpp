#include "viewer/explanation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/synthetic_record.h"
#include "viewer/captions.h"

namespace vantage {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const CandidateRow* rowWith(const std::vector<CandidateRow>& rows, ViewVerdict verdict) {
  const auto found = std::ranges::find(rows, verdict, &CandidateRow::verdict);
  return found == rows.end() ? nullptr : &*found;
}

const ViewFactor* factor(const Explanation& explanation, const std::string& name) {
  const auto found = std::ranges::find(explanation.factors, name, &ViewFactor::name);
  return found == explanation.factors.end() ? nullptr : &*found;
}

std::string sentenceOf(const SceneFrame& frame, ViewVerdict verdict) {
  const std::vector<CandidateRow> rows = candidateRows(frame);
  const CandidateRow* row = rowWith(rows, verdict);
  return row ? explain(frame, rows, row->id).sentence : "";
}

void expectBarsInRange(const Explanation& explanation) {
  ASSERT_FALSE(explanation.factors.empty());
  for (const ViewFactor& factor : explanation.factors) {
    for (const auto& reading : {factor.view, factor.other}) {
      if (!reading) continue;
      EXPECT_NE(reading->text, "") << factor.name;
      const double share = reading->share.value_or(0.0);
      EXPECT_TRUE(share >= 0.0 && share <= 1.0) << factor.name;
    }
    EXPECT_LE(factor.limit_share.value_or(0.0), 1.0) << factor.name;
  }
}

TEST(Explanation, MeasuresTheChosenViewAgainstTheNextOne) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  const ContourChosenView& chosen = *run.record.search->chosen;
  const Explanation e = explain(run.frame(), chosen.id);
  EXPECT_TRUE(e.is_winner);
  EXPECT_THAT(e.sentence, StartsWith("Chosen: "));
  EXPECT_THAT(e.sentence, HasSubstr(grouped(static_cast<std::uint64_t>(chosen.gain)) + " rays"));
  ASSERT_TRUE(e.other);
  EXPECT_NE(*e.other, chosen.id);
  EXPECT_EQ(*e.other, run.record.search->segments[chosen.search].scores[chosen.rank + 1].id);
  expectBarsInRange(e);
}

TEST(Explanation, ShowsTheFactorsOfSaliencyAndGain) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  const ContourChosenView& chosen = *run.record.search->chosen;
  const SegmentSearch& group = run.record.search->segments[chosen.search];
  const Explanation e = explain(run.frame(), chosen.id);
  ASSERT_TRUE(factor(e, "gain") && factor(e, "gain")->view);
  EXPECT_EQ(factor(e, "gain")->view->value, chosen.gain);
  const double end = std::max(chosen.gain, factor(e, "gain")->other->value);
  EXPECT_DOUBLE_EQ(*factor(e, "gain")->limit_share, run.header.contour_config.gain.gain_threshold / end);
  ASSERT_GE(group.segment, 0);
  const Segment& segment = run.record.saliency->segments[group.segment];
  ASSERT_TRUE(factor(e, "saliency") && factor(e, "isolation F") && factor(e, "roundness"));
  EXPECT_EQ(factor(e, "isolation F")->view->share, segment.isolation);
  EXPECT_EQ(factor(e, "roundness")->view->share, segment.roundness);
  EXPECT_THAT(factor(e, "roundness")->view->text, HasSubstr(lengthText(segment.extent_m[2])));
  EXPECT_DOUBLE_EQ(factor(e, "saliency")->view->value, segment.isolation * segment.roundness);
}

TEST(Explanation, SaysWhyAContourViewWasNotChosen) {
  test::SyntheticRun run = test::makeSyntheticRun();
  const std::string chosen = "view " + std::to_string(run.record.search->chosen->id);
  EXPECT_THAT(sentenceOf(run.frame(), ViewVerdict::Eligible), HasSubstr("chosen " + chosen));
  EXPECT_THAT(sentenceOf(run.frame(), ViewVerdict::BelowThreshold), HasSubstr("the threshold is 100."));
  auto search = std::make_shared<ViewSearch>(*run.record.search);
  SegmentSearch& group = search->segments[search->chosen->search];
  ASSERT_GT(group.scores.size(), search->chosen->rank + 2u);
  group.scores[search->chosen->rank + 1].reachability = Reachability::InCollision;
  group.scores[search->chosen->rank + 2].executed_before = true;
  ASSERT_GT(search->segments.size(), search->chosen->search + 1u);
  SegmentSearch& later = search->segments[search->chosen->search + 1];
  later.scored = true;
  later.scores = {{.id = 999999, .gain = 123456.0}};
  run.record.search = search;
  EXPECT_THAT(sentenceOf(run.frame(), ViewVerdict::Unreachable), HasSubstr("the body would touch occupied"));
  EXPECT_THAT(sentenceOf(run.frame(), ViewVerdict::TakenBefore), HasSubstr("within 5 cm and 10° of a view"));
  EXPECT_THAT(sentenceOf(run.frame(), ViewVerdict::LaterSegment),
              testing::AllOf(HasSubstr("comes after no. "), HasSubstr("though it would gain more, 123 456")));
}

TEST(Explanation, OfAPoseWhoseSegmentIsNotScored) {
  test::SyntheticRun run = test::makeSyntheticRun();
  auto search = std::make_shared<ViewSearch>(*run.record.search);
  const auto pending = std::ranges::find(search->segments, false, &SegmentSearch::scored);
  ASSERT_NE(pending, search->segments.end()) << "the search ended at its first segment";
  const std::uint32_t per_point = static_cast<std::uint32_t>(run.header.contour_config.views.posesPerPoint());
  const std::uint32_t id = pending->contour_points.front() * per_point;
  EXPECT_THAT(explain(run.frame(), id).sentence, StartsWith("Not scored: its segment, no. "));
  search->chosen.reset();
  run.record.search = search;
  EXPECT_THAT(explain(run.frame(), id).sentence, HasSubstr("is not scored yet"));
  const Explanation unscored = explain(run.frame(), id);
  EXPECT_FALSE(unscored.row);
  EXPECT_EQ(unscored.missing, "not scored yet");
  ASSERT_TRUE(factor(unscored, "gain") && factor(unscored, "saliency"));
  EXPECT_FALSE(factor(unscored, "gain")->view);
  ASSERT_TRUE(factor(unscored, "saliency")->view) << "known before its views are scored";
  EXPECT_THAT(unscored.sentence, HasSubstr("saliency " + factor(unscored, "saliency")->view->text));
}

TEST(Explanation, OfWhatIsNoCandidate) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  EXPECT_THAT(explain(run.frame(), 4000000000u).sentence, HasSubstr("no candidate of this step"));
  EXPECT_TRUE(explain(run.frame(), 4000000000u).factors.empty());
  EXPECT_THAT(explain(test::makeEmptyRun().frame(), 1).sentence, HasSubstr("No views were evaluated"));
  const test::SyntheticOctreeRun octree = test::makeSyntheticOctreeRun();
  EXPECT_THAT(explain(octree.frame(), 4000000000u).sentence, HasSubstr("no candidate of this step"));
}

TEST(Explanation, ShowsTheFactorsOfUtility) {
  const test::SyntheticOctreeRun run = test::makeSyntheticOctreeRun();
  const UtilitySearch& search = *run.record.utilities;
  const ViewUtility& best = search.views[search.ranking.front()];
  const Explanation e = explain(run.frame(), best.id);
  expectBarsInRange(e);
  EXPECT_THAT(e.sentence, HasSubstr("found no way within its iterations"));
  EXPECT_EQ(e.other, search.chosen->id);
  EXPECT_EQ(factor(e, "utility")->view->value, best.utility);
  EXPECT_DOUBLE_EQ(factor(e, "surface factor")->view->value * factor(e, "distance factor")->view->value,
                   best.utility);
  EXPECT_EQ(factor(e, "unknown")->view->value, best.unknown);
  EXPECT_THAT(factor(e, "known surface")->limit, HasSubstr("at least 50 rays"));
  EXPECT_THAT(explain(run.frame(), search.chosen->id).sentence, HasSubstr("2 better ones cannot be reached"));
}

TEST(Explanation, SaysWhyAViewOfTheHierarchicalPlannerWasNotChosen) {
  const test::SyntheticOctreeRun run = test::makeSyntheticOctreeRun(CandidateGenerator::Workspace);
  EXPECT_THAT(sentenceOf(run.frame(), ViewVerdict::Eligible), HasSubstr("has the higher utility"));
  EXPECT_THAT(sentenceOf(run.frame(), ViewVerdict::NotFree),
              AllOf(HasSubstr("cube of 5 cm"), HasSubstr("or the sensor itself would stand in")));
  EXPECT_THAT(sentenceOf(run.frame(), ViewVerdict::LittleSurface), HasSubstr("at least 50 are asked for"));
  const std::vector<CandidateRow> rows = candidateRows(run.frame());
  const Explanation rejected = explain(run.frame(), rows, rowWith(rows, ViewVerdict::NotFree)->id);
  EXPECT_FALSE(factor(rejected, "utility")->view) << "never computed";
  const test::SyntheticOctreeRun stopped = test::makeSyntheticOctreeRun(CandidateGenerator::Icosphere, false);
  EXPECT_THAT(sentenceOf(stopped.frame(), ViewVerdict::Stopped), HasSubstr("the planner stopped"));
}

TEST(Explanation, CountsTheVoxelsOfTheChosenViewAsThePlannerDid) {
  const test::SyntheticRun contour = test::makeSyntheticRun();
  std::vector<CandidateRow> rows = candidateRows(contour.frame());
  ASSERT_GT(contour.record.chosen()->gain_voxels, 0u);
  EXPECT_EQ(countedVoxels(contour.frame(), *rowWith(rows, ViewVerdict::Chosen)),
            contour.record.chosen()->gain_voxels);
  const test::SyntheticOctreeRun octree = test::makeSyntheticOctreeRun();
  rows = candidateRows(octree.frame());
  ASSERT_GT(octree.record.chosen()->gain_voxels, 0u);
  EXPECT_EQ(countedVoxels(octree.frame(), *rowWith(rows, ViewVerdict::Chosen)),
            octree.record.chosen()->gain_voxels);
}

TEST(Explanation, VoxelsAreOthersOnlyIfPoseOrRegionAre) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  const std::vector<CandidateRow> rows = candidateRows(run.frame());
  const CandidateRow& chosen = *rowWith(rows, ViewVerdict::Chosen);
  const auto region = countedRegion(run.frame(), chosen);
  ASSERT_TRUE(region && region->sphere);
  test::SyntheticRun other = run;
  other.header.contour_config.gain.gain_threshold += 100.0;
  EXPECT_EQ(countedRegion(other.frame(), chosen), region) << "a threshold ranks, it counts nothing";
  auto search = std::make_shared<ViewSearch>(*run.record.search);
  search->segments[chosen.group].sphere.radius *= 0.5;
  other.record.search = search;
  EXPECT_NE(countedRegion(other.frame(), chosen), region);
  EXPECT_LT(countedVoxels(other.frame(), chosen), countedVoxels(run.frame(), chosen));
  const auto next = std::ranges::find_if(
      rows, [&](const CandidateRow& r) { return r.group == chosen.group && r.id != chosen.id; });
  ASSERT_NE(next, rows.end());
  EXPECT_NE(countedRegion(run.frame(), *next), region);
  EXPECT_FALSE(countedRegion(run.frame(), *rowWith(rows, ViewVerdict::Pending)));
}

}  // namespace
}  // namespace vantage
