#include "viewer/run_session.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <random>

#include "io/error.h"
#include "tests/io/run_support.h"

namespace vantage::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A record with every product, of one of the planners, whose octree bricks fit the octree of
/// randomHeader(1).
StepRecord recordOf(int step, const std::string& planner, bool closing = false) {
  StepRecord record = randomRecord(500 + step, step, closing);
  record.planner = planner;
  const OccupancyOctree map = emptyOctree(randomHeader(1));
  auto bricks = std::make_shared<std::vector<OctreeBrick>>();
  Randomizer random(900 + step);
  for (std::uint32_t b = step % 2; b < map.bricks().total(); b += 2) {
    const BrickRange range = map.bricks().range(b);
    OctreeBrick brick{b, std::vector<float>((range.end - range.begin).prod(), std::nanf(""))};
    for (std::size_t v = 0; v < brick.log_odds.size(); v += 3) random.scalar(brick.log_odds[v]);
    bricks->push_back(std::move(brick));
  }
  record.changed_octree_bricks = bricks;
  return record;
}

RunHeader headerOf(const std::string& planner, std::uint64_t seed = 1) {
  RunHeader header = randomHeader(seed);
  header.planner = planner;
  header.truth.vertices.assign(3, Eigen::Vector3f::Zero());
  header.truth.triangles = {{0, 1, 2}};
  header.truth.colors.resize(1);
  return header;
}

constexpr int kSteps = 5;  // the closing scan is one more

void writeSteps(const fs::path& path, const std::string& planner) {
  RunWriter writer(path, headerOf(planner));
  for (int step = 1; step <= kSteps; ++step) writer.write(recordOf(step, planner));
  writer.write(recordOf(kSteps + 1, planner, true));
  writer.finish("steps done");
}

/// Volumes after each step, applied one after the other.
std::vector<TsdfVolume> volumesOf(const std::string& planner) {
  std::vector<TsdfVolume> all(kSteps + 2, TsdfVolume(testGrid()));
  for (int step = 1; step <= kSteps + 1; ++step) {
    all[step] = all[step - 1];
    const StepRecord record = recordOf(step, planner, step > kSteps);
    for (const TsdfBrick& brick : *record.changed_bricks) all[step].setBrick(brick.brick, brick.voxels);
  }
  return all;
}

bool sameStates(const StateGrid& a, const StateGrid& b) {
  return std::ranges::equal(a.states(), b.states()) && std::ranges::equal(a.freeRadius(), b.freeRadius());
}

TEST(RunSession, LoadsStepsInAnyOrderAsTheRunHadThem) {
  const TestFolder folder;
  writeSteps(folder / "a.vantage", "contour");
  const std::vector<TsdfVolume> expected = volumesOf("contour");
  RunSession session(folder / "a.vantage");
  EXPECT_TRUE(session.finished());
  ASSERT_EQ(session.summaries().size(), kSteps + 1u);
  std::mt19937 random(7);
  StepData shown;
  for (int round = 0; round < 25; ++round) {
    const int step = 1 + static_cast<int>(random() % (kSteps + 1));
    shown = session.load(step);
    ASSERT_TRUE(shown.volume && shown.states && !shown.octree && !shown.pyramid && !shown.tree);
    EXPECT_TRUE(std::ranges::equal(shown.volume->voxels(), expected[step].voxels())) << step;
    EXPECT_TRUE(sameStates(*shown.states, makeStateGrid(expected[step]))) << step;
    StepRecord record = recordOf(step, "contour", step > kSteps);
    record.changed_bricks.reset();
    record.changed_octree_bricks.reset();
    expectEqual(*shown.record, record);
    EXPECT_EQ(&shown.frame().states, shown.states.get());
    EXPECT_EQ(shown.frame().truth, &shown.header->truth);
  }
}

TEST(RunSession, WhatItHandsOutNeverChangesAndOutlivesIt) {
  const TestFolder folder;
  writeSteps(folder / "a.vantage", "contour");
  const std::vector<TsdfVolume> expected = volumesOf("contour");
  std::vector<StepData> kept;
  {
    RunSession session(folder / "a.vantage");
    for (const int step : {2, 5, 1, 4, 2}) kept.push_back(session.load(step));
    EXPECT_EQ(kept.front().volume, kept.back().volume) << "the same map is held once";
  }
  int n = 0;
  for (const int step : {2, 5, 1, 4, 2}) {
    EXPECT_TRUE(std::ranges::equal(kept[n].volume->voxels(), expected[step].voxels())) << step;
    EXPECT_TRUE(sameStates(*kept[n++].states, makeStateGrid(expected[step]))) << step;
  }
}

TEST(RunSession, PreparingAStepChangesNothingThatIsHeldAndLoadsAsBefore) {
  const TestFolder folder;
  const std::vector<TsdfVolume> expected = volumesOf("contour");
  writeSteps(folder / "a.vantage", "contour");
  RunSession session(folder / "a.vantage");
  StepData shown = session.load(1);
  for (const int step : {2, 3, 2, 5, 1, kSteps + 1}) {
    session.prepare(step);
    session.prepare(99);
    EXPECT_TRUE(std::ranges::equal(shown.volume->voxels(), expected[shown.record->step].voxels()));
    shown = session.load(step);
    EXPECT_TRUE(std::ranges::equal(shown.volume->voxels(), expected[step].voxels())) << step;
  }
}

TEST(RunSession, ShowsOctreePlannersTheirOctree) {
  const TestFolder folder;
  writeSteps(folder / "a.vantage", "hierarchical");
  RunSession session(folder / "a.vantage");
  const RunReader reader(folder / "a.vantage");
  StepData data;
  for (const int step : {3, 1, kSteps + 1, 2}) {
    data = session.load(step);
    OccupancyOctree expected = emptyOctree(reader.header());
    reader.moveOctree(expected, 0, step);
    const StatePyramid pyramid(expected, StatePyramid::kMaxCoarseLevels);
    ASSERT_TRUE(data.octree && data.pyramid && data.tree && !data.volume);
    EXPECT_EQ(data.states.get(), &data.pyramid->finest());
    for (int level = 0; level <= pyramid.coarseLevels(); ++level)
      EXPECT_TRUE(sameStates(data.pyramid->level(level), pyramid.level(level))) << step << " " << level;
    EXPECT_TRUE(onOctree(data.frame()));
  }
}

TEST(RunSession, TellsWhatEarlierStepsExclude) {
  const TestFolder folder;
  writeSteps(folder / "a.vantage", "contour");
  RunSession session(folder / "a.vantage");
  Exclusions expected;
  EXPECT_TRUE(session.exclusionsBefore(1).executed.empty());
  for (int step = 1; step < kSteps; ++step)
    expected.add(recordOf(step, "contour"), session.header()->contour_config.gain);
  for (int round = 0; round < 2; ++round) {
    const Exclusions found = session.exclusionsBefore(kSteps);
    ASSERT_EQ(found.executed.size(), expected.executed.size());
    EXPECT_GT(found.executed.size(), 0u);
    for (std::size_t i = 0; i < found.executed.size(); ++i)
      EXPECT_TRUE(found.executed[i].isApprox(expected.executed[i], 1e-12));
    EXPECT_EQ(found.disappointing.size(), expected.disappointing.size());
  }
}

TEST(RunSession, FollowsARunThatIsStillWritten) {
  const TestFolder folder;
  RunWriter writer(folder / "a.vantage", headerOf("contour"));
  RunSession session(folder / "a.vantage");
  EXPECT_TRUE(session.summaries().empty());
  EXPECT_FALSE(session.finished());
  Followed news = session.refresh();
  EXPECT_FALSE(news.grown || news.finished || news.replaced || news.gone);

  StepRecord record = recordOf(1, "contour");
  record.realised_voxels.reset();
  record.served.reset();
  writer.write(record);
  news = session.refresh();
  EXPECT_TRUE(news.grown);
  EXPECT_FALSE(news.finished);
  ASSERT_EQ(session.summaries().size(), 1u);
  EXPECT_FALSE(session.load(1).record->realised_voxels);

  record.realised_voxels = 42;
  writer.setRealised(record);
  EXPECT_TRUE(session.refresh().grown) << "a realised gain is news";
  EXPECT_EQ(session.summaries()[0].realised_voxels, 42u);
  EXPECT_EQ(session.load(1).record->realised_voxels, 42u);

  writer.write(recordOf(2, "contour"));
  writer.finish("steps done");
  news = session.refresh();
  EXPECT_TRUE(news.grown && news.finished && session.finished());
  news = session.refresh();
  EXPECT_TRUE(news.finished && !news.grown && !news.replaced && !news.gone);
  EXPECT_EQ(session.load(2).record->step, 2);
}

TEST(RunSession, TellsOfAFileThatIsReplacedOrRemovedAndKeepsWhatItHas) {
  const TestFolder folder;
  const fs::path path = folder / "a.vantage";
  writeSteps(path, "contour");
  RunSession session(path);
  const StepData before = session.load(2);
  writeSteps(path, "contour");
  Followed news = session.refresh();
  EXPECT_TRUE(news.replaced && !news.gone && !news.grown);
  EXPECT_EQ(session.load(3).record->step, 3) << "a finished run is read to its end";
  fs::remove(path);
  news = session.refresh();
  EXPECT_TRUE(news.gone && !news.replaced);
  EXPECT_TRUE(std::ranges::equal(before.volume->voxels(), volumesOf("contour")[2].voxels()));
}

TEST(RunSession, TellsOfARunInProgressThatGoesOrIsWrittenAnew) {
  const TestFolder folder;
  const fs::path path = folder / "a.vantage";
  auto writer = std::make_unique<RunWriter>(path, headerOf("contour"));
  writer->write(recordOf(1, "contour"));
  RunSession session(path);
  writer = std::make_unique<RunWriter>(path, headerOf("contour", 2));
  EXPECT_TRUE(session.refresh().replaced);
  EXPECT_THROW(session.load(1), InputError);
  RunSession second(path);
  writer.reset();
  for (const auto& entry : fs::directory_iterator(folder.path())) fs::remove(entry);
  EXPECT_TRUE(second.refresh().gone);
  EXPECT_THROW(second.load(1), InputError);
}

TEST(RunSession, ATruncatedFileIsToldAndReadingItIsAnError) {
  const TestFolder folder;
  const fs::path path = folder / "a.vantage";
  writeSteps(path, "contour");
  RunSession session(path);
  fs::resize_file(path, fs::file_size(path) / 3);
  const Followed news = session.refresh();
  EXPECT_TRUE(news.replaced || !news.problem.empty());
  int refused = 0;
  for (int step = 1; step <= kSteps; ++step) {
    try {
      session.load(step);
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_THROW(RunSession{path}, InputError);
}

TEST(RunSession, RefusesWhatTheReaderRefuses) {
  const TestFolder folder;
  const auto message = [&](const fs::path& path) -> std::string {
    try {
      RunSession session(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no InputError";
  };
  EXPECT_THAT(message(folder / "none.vantage"), HasSubstr("does not exist"));
  std::ofstream(folder / "text.vantage") << "no run\n";
  EXPECT_THAT(message(folder / "text.vantage"), HasSubstr("is not a run file"));
  writeSteps(folder / "a.vantage", "contour");
  RunSession session(folder / "a.vantage");
  EXPECT_THROW(session.load(99), InputError);
}

}  // namespace
}  // namespace vantage::testing
