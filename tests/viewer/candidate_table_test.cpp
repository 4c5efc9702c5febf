#include "viewer/candidate_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/support/synthetic_record.h"

namespace vantage {
namespace {

std::vector<CandidateRow> someRows() {
  std::mt19937 random(3);
  std::vector<CandidateRow> rows;
  for (std::uint32_t i = 0; i < 400; ++i) {
    CandidateRow row;
    row.id = i * 7;
    row.group = random() % 5;
    row.segment = 10 + row.group;
    if (random() % 3 > 0) row.rank = random() % 50;
    row.score = random() % 40;
    row.saliency = row.group / 10.0;
    row.unknown = random() % 10;
    row.distance_m = (random() % 100) / 50.0;
    if (i % 60 == 0) {
      row.verdict = ViewVerdict::Pending;
      row.rank.reset();
    }
    rows.push_back(row);
  }
  return rows;
}

StepData dataOf(const test::SyntheticRun& run) {
  StepData data;
  data.header = std::make_shared<RunHeader>(run.header);
  data.record = std::make_shared<StepRecord>(run.record);
  data.states = std::make_shared<StateGrid>(run.states);
  return data;
}

TEST(CandidateTable, SortsByEveryColumnAndKeepsTheOrderOfEqualOnes) {
  const std::vector<CandidateRow> rows = someRows();
  for (const bool hierarchical : {false, true}) {
    for (const CandidateColumnText& column : candidateColumns(hierarchical)) {
      for (const bool descending : {false, true}) {
        const auto listed = listedRows(rows, {}, column.column, descending);
        ASSERT_EQ(listed.size(), rows.size()) << column.name;
        auto all = listed;
        std::ranges::sort(all);
        EXPECT_EQ(std::ranges::adjacent_find(all), all.end()) << column.name;
        EXPECT_EQ(listed, listedRows(rows, {}, column.column, descending)) << column.name;
      }
    }
  }
  const auto by_gain = listedRows(rows, {}, CandidateColumn::Gain, true);
  std::size_t compared = 0;
  for (std::size_t i = 1; i < by_gain.size(); ++i) {
    const CandidateRow &a = rows[by_gain[i - 1]], &b = rows[by_gain[i]];
    if (b.pending()) break;
    EXPECT_GE(a.score, b.score);
    if (a.score == b.score) {
      EXPECT_LT(by_gain[i - 1], by_gain[i]);
    }
    ++compared;
  }
  EXPECT_GT(compared, 300u);
}

TEST(CandidateTable, PutsRowsWithoutAValueLastBothWaysPendingOnesFirst) {
  const std::vector<CandidateRow> rows = someRows();
  for (const bool descending : {false, true}) {
    const auto listed = listedRows(rows, {}, CandidateColumn::Rank, descending);
    const auto kind = [&](std::uint32_t i) { return rows[i].rank ? 0 : rows[i].pending() ? 1 : 2; };
    EXPECT_TRUE(std::ranges::is_sorted(listed, {}, kind));
    EXPECT_EQ(kind(listed.front()), 0);
    EXPECT_EQ(kind(listed.back()), 2);
  }
}

TEST(CandidateTable, Filters) {
  const std::vector<CandidateRow> rows = someRows();
  const auto listed = [&](const CandidateFilter& filter) {
    return listedRows(rows, filter, CandidateColumn::View, false);
  };
  ASSERT_FALSE(listed({.text = "49"}).empty());
  for (const std::uint32_t i : listed({.text = "49"}))
    EXPECT_NE(std::to_string(rows[i].id).find("49"), std::string::npos);
  ASSERT_FALSE(listed({.ranked_only = true}).empty());
  for (const std::uint32_t i : listed({.ranked_only = true})) EXPECT_TRUE(rows[i].rank || rows[i].pending());
  ASSERT_FALSE(listed({.segment = 13}).empty());
  for (const std::uint32_t i : listed({.segment = 13})) EXPECT_EQ(rows[i].group, 3u);
  EXPECT_TRUE(listed({.text = "no such view"}).empty());
}

TEST(CandidateTable, ListsTheViewWhoseNumberIsTypedFirst) {
  const std::vector<CandidateRow> rows = someRows();
  for (const bool descending : {false, true}) {
    const auto listed = listedRows(rows, {.text = "21"}, CandidateColumn::View, descending);
    ASSERT_GT(listed.size(), 3u);
    EXPECT_EQ(rows[listed.front()].id, 21u);
    EXPECT_NE(rows[listed.back()].id, 21u);
  }
}

TEST(CandidateTable, LeavesOutWhatTheRobotCannotTakeButNotWhatItWasNotAskedFor) {
  std::vector<CandidateRow> rows(4);
  rows[0].reachability = Reachability::Reachable;
  rows[1].reachability = Reachability::NotChecked;
  rows[2].reachability = Reachability::InCollision;
  rows[3].verdict = ViewVerdict::NotFree;
  EXPECT_EQ(listedRows(rows, {.reachable_only = true}, CandidateColumn::View, false),
            (std::vector<std::uint32_t>{0, 1}));
}

TEST(CandidateTable, WorksOnlyWhenSomethingChanged) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  const StepData data = dataOf(run);
  CandidateTable table;
  table.show(data, data);
  const std::uint64_t revision = table.revision();
  table.show(data, data);
  EXPECT_EQ(table.revision(), revision);
  StepData other = data;
  other.record = std::make_shared<StepRecord>(run.record);
  table.show(data, other);
  EXPECT_NE(table.revision(), revision);
  table.show({}, {});
  EXPECT_TRUE(table.rows().empty());
  EXPECT_TRUE(table.listed().empty());
}

TEST(CandidateTable, ShowsHowAnotherThresholdMovesViews) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  test::SyntheticRun stricter = run;
  const std::uint32_t chosen = run.record.search->chosen->id;
  stricter.header.contour_config.gain.gain_threshold = run.record.search->chosen->gain;
  auto search = std::make_shared<ViewSearch>(*run.record.search);
  search->chosen.reset();
  stricter.record.search = search;
  CandidateTable table;
  table.show(dataOf(run), dataOf(stricter));
  ASSERT_NE(table.find(chosen), nullptr);
  EXPECT_EQ(table.find(chosen)->change.kind, RankChange::Kind::Gone);
}

TEST(CandidateTable, ComparesWithAllThatWasScoredBeforeAnythingWasTried) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  const StepData recorded = dataOf(run);
  StepData all = recorded;
  auto search = std::make_shared<ViewSearch>(*run.record.search);
  const auto unscored = std::ranges::find(search->segments, false, &SegmentSearch::scored);
  ASSERT_NE(unscored, search->segments.end());
  unscored->scored = true;
  unscored->scores = {{.id = 999999, .gain = 5000.0}};
  auto record = std::make_shared<StepRecord>(run.record);
  record->search = search;
  all.record = record;
  CandidateTable table;
  table.show(recorded, recorded);
  table.show(recorded, all);
  ASSERT_NE(table.find(999999), nullptr);
  EXPECT_EQ(table.find(999999)->change.kind, RankChange::Kind::Same);
  EXPECT_FALSE(table.compares());
  StepData tried = all;
  auto header = std::make_shared<RunHeader>(run.header);
  header->contour_config.gain.gain_threshold = 4999.0;
  tried.header = header;
  table.show(recorded, tried);
  EXPECT_TRUE(table.compares());
  EXPECT_EQ(table.find(999999)->change.kind, RankChange::Kind::Up);
}

TEST(CandidateTable, FindsViewsInTheListedOrder) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  const StepData data = dataOf(run);
  CandidateTable table;
  table.show(data, data);
  table.sortBy(CandidateColumn::Distance, true);
  const std::uint32_t id = run.record.search->chosen->id;
  const auto place = table.placeOf(id);
  ASSERT_TRUE(place);
  EXPECT_EQ(table.rows()[table.listed()[*place]].id, id);
  table.filter({.text = "no such view"});
  EXPECT_FALSE(table.placeOf(id));
}

TEST(CandidateTable, StepsFromViewToViewPastPendingSegments) {
  const test::SyntheticRun run = test::makeSyntheticRun();
  const StepData data = dataOf(run);
  CandidateTable table;
  EXPECT_FALSE(table.neighbour({}, +1));
  table.show(data, data);
  std::vector<std::uint32_t> ids;
  for (const std::uint32_t index : table.listed())
    if (!table.rows()[index].pending()) ids.push_back(table.rows()[index].id);
  ASSERT_LT(ids.size(), table.listed().size()) << "no segment is pending";
  std::optional<std::uint32_t> at = table.neighbour({}, +1);
  for (const std::uint32_t id : ids) {
    ASSERT_EQ(at, id);
    at = table.neighbour(at, +1);
  }
  EXPECT_EQ(at, ids.back());
  EXPECT_EQ(table.neighbour(ids[2], -2), ids[0]);
  EXPECT_EQ(table.neighbour(ids[1], -5), ids[0]);
}

}  // namespace
}  // namespace vantage
