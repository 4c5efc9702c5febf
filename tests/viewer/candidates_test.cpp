#include "viewer/candidates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/support/synthetic_record.h"

namespace vantage {
namespace {

std::vector<CandidateRow> ranked(std::vector<CandidateRow> rows) {
  std::erase_if(rows, [](const CandidateRow& r) { return !r.rank; });
  std::ranges::stable_sort(rows, {}, [](const CandidateRow& r) { return *r.rank; });
  return rows;
}

const CandidateRow* chosenRow(const std::vector<CandidateRow>& rows) {
  const auto found = std::ranges::find_if(rows, &CandidateRow::chosen);
  return found == rows.end() ? nullptr : &*found;
}

/// All groups of the run scored with the same scores as the chosen one, turned about: enough to rank over
/// segments.
test::SyntheticRun withAllGroupsScored() {
  test::SyntheticRun run = test::makeSyntheticRun();
  auto search = std::make_shared<ViewSearch>(*run.record.search);
  std::uint32_t id = 1000000;
  for (SegmentSearch& group : search->segments) {
    if (group.scored) continue;
    group.scored = true;
    group.scores = {{.id = id++, .gain = 5000.0, .unknown = 5000}, {.id = id++, .gain = 50.0, .unknown = 50}};
  }
  run.record.search = search;
  return run;
}

TEST(Candidates, OfTheContourPlannerAreItsScores) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  const std::vector<CandidateRow> rows = candidateRows(run.frame());
  std::size_t scored = 0, pending = 0;
  for (const SegmentSearch& group : run.record.search->segments) {
    scored += group.scores.size();
    pending += !group.scored;
  }
  ASSERT_GT(scored, 0u);
  EXPECT_EQ(rows.size(), scored + pending);
  EXPECT_EQ(std::ranges::count_if(rows, &CandidateRow::pending), static_cast<std::ptrdiff_t>(pending));
  const CandidateRow* chosen = chosenRow(rows);
  ASSERT_NE(chosen, nullptr);
  EXPECT_EQ(chosen->id, run.record.search->chosen->id);
  EXPECT_EQ(chosen->score, run.record.search->chosen->gain);
  EXPECT_EQ(chosen->group, run.record.search->chosen->search);
  EXPECT_EQ(chosen->reachability, Reachability::Reachable);
}

TEST(Candidates, RankInTheOrderInWhichViewsAreTried) {
  const test::SyntheticRun run = withAllGroupsScored();
  const std::vector<CandidateRow> rows = ranked(candidateRows(run.frame()));
  ASSERT_GT(rows.size(), 2u);
  const double threshold = run.header.contour_config.gain.gain_threshold;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(*rows[i].rank, i + 1);
    EXPECT_GT(rows[i].score, threshold);
    if (i == 0) continue;
    EXPECT_GE(rows[i].group, rows[i - 1].group);
    if (rows[i].group == rows[i - 1].group) {
      EXPECT_LE(rows[i].score, rows[i - 1].score);
    }
  }
  // Whatever comes before the chosen one was refused.
  for (const CandidateRow& row : rows) {
    if (row.chosen()) break;
    EXPECT_EQ(row.verdict, ViewVerdict::Unreachable);
  }
}

TEST(Candidates, BelowTheThresholdOrTakenBeforeHaveNoRank) {
  test::SyntheticRun run = test::makeSyntheticRun();
  auto search = std::make_shared<ViewSearch>(*run.record.search);
  SegmentSearch& group = search->segments[search->chosen->search];
  group.scores[0].executed_before = true;
  group.scores[0].reachability = Reachability::NotChecked;
  const std::uint32_t excluded = group.scores[0].id;
  search->chosen.reset();
  run.record.search = search;
  std::size_t below = 0;
  for (const CandidateRow& row : candidateRows(run.frame())) {
    if (row.verdict == ViewVerdict::BelowThreshold) {
      ++below;
      EXPECT_FALSE(row.rank);
      EXPECT_LE(row.score, run.header.contour_config.gain.gain_threshold);
    }
    if (row.id == excluded && !row.pending()) {
      EXPECT_EQ(row.verdict, ViewVerdict::TakenBefore);
      EXPECT_FALSE(row.rank);
    }
  }
  EXPECT_GT(below, 0u);
}

TEST(Candidates, OfLaterSegmentsSaySo) {
  const test::SyntheticRun run = withAllGroupsScored();
  const std::uint32_t chosen = run.record.search->chosen->search;
  ASSERT_GT(run.record.search->segments.size(), chosen + 1u);
  std::size_t later = 0;
  for (const CandidateRow& row : candidateRows(run.frame())) {
    if (row.group <= chosen || row.verdict == ViewVerdict::BelowThreshold) continue;
    EXPECT_EQ(row.verdict, ViewVerdict::LaterSegment);
    EXPECT_TRUE(row.rank);
    ++later;
  }
  EXPECT_GT(later, 0u);
}

TEST(Candidates, BehindAPendingSegmentHaveNoRankYet) {
  test::SyntheticRun run = withAllGroupsScored();
  auto search = std::make_shared<ViewSearch>(*run.record.search);
  search->chosen.reset();
  ASSERT_GT(search->segments.size(), 1u);
  search->segments[0].scored = false;
  search->segments[0].scores.clear();
  run.record.search = search;
  const std::vector<CandidateRow> rows = candidateRows(run.frame());
  ASSERT_TRUE(rows.front().pending());
  EXPECT_EQ(rows.front().poses, search->segments[0].poses_generated);
  EXPECT_TRUE(ranked(rows).empty());
  EXPECT_TRUE(std::ranges::any_of(rows, [](const auto& r) { return r.verdict == ViewVerdict::Waiting; }));
}

TEST(Candidates, OfTheHierarchicalPlannerAreItsViewsAndRanking) {
  const test::SyntheticOctreeRun run = test::makeSyntheticOctreeRun();
  const UtilitySearch& search = *run.record.utilities;
  const std::vector<CandidateRow> rows = candidateRows(run.frame());
  ASSERT_EQ(rows.size(), search.views.size());
  std::set<std::uint32_t> ids;
  for (const CandidateRow& row : rows) ids.insert(row.id);
  EXPECT_EQ(ids.size(), rows.size());
  for (std::size_t i = 0; i < search.ranking.size(); ++i) {
    EXPECT_EQ(rows[i].id, search.views[search.ranking[i]].id);
    EXPECT_EQ(rows[i].score, search.views[search.ranking[i]].utility);
  }
  EXPECT_EQ(rows[0].verdict, ViewVerdict::Unreachable);
  EXPECT_EQ(rows[1].verdict, ViewVerdict::Unreachable);
  EXPECT_EQ(rows[2].verdict, ViewVerdict::Chosen);
  EXPECT_EQ(rows[2].rank, 3u);
  const auto with = [&](ViewVerdict verdict) {
    return static_cast<std::uint64_t>(std::ranges::count(rows, verdict, &CandidateRow::verdict));
  };
  EXPECT_EQ(with(ViewVerdict::NotFree), search.rejected_position);
  EXPECT_EQ(with(ViewVerdict::LittleSurface), search.rejected_registration);
}

TEST(Candidates, OfAStoppedSearchSaySo) {
  const test::SyntheticOctreeRun run = test::makeSyntheticOctreeRun(CandidateGenerator::Icosphere, false);
  const std::vector<CandidateRow> rows = candidateRows(run.frame());
  ASSERT_FALSE(rows.empty());
  EXPECT_EQ(rows.front().verdict, ViewVerdict::Stopped);
  EXPECT_EQ(chosenRow(rows), nullptr);
}

TEST(Candidates, AreNoneBeforeTheEvaluation) {
  EXPECT_TRUE(candidateRows(test::makeEmptyRun().frame()).empty());
}

TEST(RankChanges, TellUpDownNewAndGone) {
  const auto row = [](std::uint32_t id, std::optional<std::uint32_t> rank) {
    CandidateRow r;
    r.id = id;
    r.rank = rank;
    return r;
  };
  const std::vector<CandidateRow> before = {row(7, 1), row(8, 2), row(9, 3), row(5, {})};
  std::vector<CandidateRow> after = {row(9, 1), row(7, 2), row(5, 3), row(8, {}), row(4, {}), row(3, 4)};
  compareRanks(after, before);
  using Kind = RankChange::Kind;
  EXPECT_EQ(after[0].change, (RankChange{Kind::Up, 2}));
  EXPECT_EQ(after[1].change, (RankChange{Kind::Down, 1}));
  EXPECT_EQ(after[2].change, (RankChange{Kind::New, 0}));
  EXPECT_EQ(after[3].change, (RankChange{Kind::Gone, 0}));
  EXPECT_EQ(after[4].change, (RankChange{Kind::None, 0}));
  EXPECT_EQ(after[5].change, (RankChange{Kind::None, 0})) << "its old place may have been the same";
}

TEST(RankChanges, AreNotKnownBehindASegmentThatIsNotScored) {
  const auto row = [](std::uint32_t id, std::optional<std::uint32_t> rank, ViewVerdict verdict) {
    CandidateRow r;
    r.id = id;
    r.rank = rank;
    r.verdict = verdict;
    return r;
  };
  using enum ViewVerdict;
  const std::vector<CandidateRow> before = {row(1, 1, Chosen), row(2, 2, Eligible), row(3, 3, Unreachable),
                                            row(4, 4, Eligible), row(5, 5, Eligible)};
  std::vector<CandidateRow> after = {row(1, 1, Unreachable), row(0, {}, Pending),
                                     row(2, {}, Waiting),    row(3, {}, Unreachable),
                                     row(4, {}, Waiting),    row(5, {}, BelowThreshold)};
  compareRanks(after, before);
  using Kind = RankChange::Kind;
  EXPECT_EQ(after[0].change.kind, Kind::Same);
  for (const std::size_t waits : {2, 3, 4}) EXPECT_EQ(after[waits].change.kind, Kind::None) << waits;
  EXPECT_EQ(after[5].change.kind, Kind::Gone) << "too little gain wherever it stands";
}

TEST(RankChanges, AreNoneWithoutAChange) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  std::vector<CandidateRow> rows = candidateRows(run.frame());
  compareRanks(rows, candidateRows(run.frame()));
  for (const CandidateRow& row : rows)
    EXPECT_EQ(row.change.kind, row.rank ? RankChange::Kind::Same : RankChange::Kind::None);
}

TEST(RankChanges, NeedTheSameCandidates) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  EXPECT_TRUE(sameCandidates(run.frame(), run.frame()));
  test::SyntheticRun moved = run;
  auto positions = std::make_shared<std::vector<ViewPosition>>(*run.record.positions);
  moved.record.positions = positions;
  EXPECT_TRUE(sameCandidates(run.frame(), moved.frame())) << "equal copies";
  positions->back().T_world_camera.translation().x() += 0.01;
  EXPECT_FALSE(sameCandidates(run.frame(), moved.frame()));
  const test::SyntheticOctreeRun octree = test::makeSyntheticOctreeRun();
  EXPECT_FALSE(sameCandidates(run.frame(), octree.frame()));
  EXPECT_TRUE(sameCandidates(octree.frame(), octree.frame()));
}

}  // namespace
}  // namespace vantage
