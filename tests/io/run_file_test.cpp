#include "io/run_file.h"

#include <gmock/gmock.h>
#include <zstd.h>

#include <cmath>
#include <fstream>

#include "io/error.h"
#include "io/run_database.h"
#include "tests/io/run_support.h"

namespace vantage::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// The message with which opening or reading fails.
template <class Action>
std::string inputError(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

std::vector<std::string> namesIn(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

TEST(RunFile, GivesBackEveryFieldOfEveryRecord) {
  const TestFolder folder;
  writeRun(folder / "a.vantage", 100, 3);
  const RunReader reader(folder / "a.vantage");
  EXPECT_TRUE(equal(reader.header(), randomHeader(100)));
  EXPECT_EQ(reader.steps(), (std::vector{1, 2, 3}));
  for (const int step : reader.steps()) expectEqual(reader.step(step), randomRecord(100 + step, step));
  ASSERT_TRUE(reader.hasClosing());
  EXPECT_EQ(reader.closingStep(), 4);
  expectEqual(reader.closing(), randomRecord(104, 4, true));
  EXPECT_EQ(reader.stopReason(), "steps done");
}

TEST(RunFile, KeepsAbsentAndEmptyProductsApart) {
  const TestFolder folder;
  StepRecord absent, empty;
  absent.step = 1;
  empty.step = 2;
  empty.depth = std::make_shared<DepthFrame>();
  empty.changed_bricks = std::make_shared<std::vector<TsdfBrick>>();
  empty.contours = std::make_shared<Contours>();
  empty.surface = std::make_shared<SurfaceCloud>();
  empty.labels = std::make_shared<Labels>();
  empty.saliency = std::make_shared<Saliency>();
  empty.point_labels = std::make_shared<std::vector<std::uint32_t>>();
  empty.positions = std::make_shared<std::vector<ViewPosition>>();
  empty.search = std::make_shared<ViewSearch>();
  {
    RunWriter writer(folder / "a.vantage", {});
    writer.write(absent);
    writer.write(empty);
  }
  const RunReader reader(folder / "a.vantage");
  expectEqual(reader.step(1), absent);
  expectEqual(reader.step(2), empty);
  EXPECT_FALSE(reader.stopReason().has_value());
  EXPECT_FALSE(reader.hasClosing());
}

TEST(RunFile, FillsInWhatIsKnownLater) {
  const TestFolder folder;
  StepRecord record = randomRecord(7, 1);
  record.realised_voxels.reset();
  record.served.reset();
  RunWriter writer(folder / "a.vantage", randomHeader(1));
  writer.write(record);
  expectEqual(RunReader(folder / "a.vantage").step(1), record);
  record.stage = Stage::Realised;
  record.realised_voxels = 0;
  record.served = ScanPose{lookAt({1, 2, 3}, {0, 0, 0}), 17};
  writer.setRealised(record);
  expectEqual(RunReader(folder / "a.vantage").step(1), record);
  record.step = 2;
  EXPECT_THROW(writer.setRealised(record), std::invalid_argument);
}

TEST(RunFile, TakesStepsInAscendingOrderOnly) {
  const TestFolder folder;
  RunWriter writer(folder / "a.vantage", {});
  writer.write(randomRecord(1, 2));
  EXPECT_THROW(writer.write(randomRecord(1, 2)), std::invalid_argument);
  EXPECT_THROW(writer.write(randomRecord(1, 1)), std::invalid_argument);
  writer.write(randomRecord(1, 3));
  EXPECT_EQ(RunReader(folder / "a.vantage").steps(), (std::vector{2, 3}));
}

/// The bytes of a run that version 1 of the format holds, from before there was an octree.
std::vector<char> runOfVersion1() {
  std::ifstream file(VANTAGE_SOURCE_DIR "/tests/io/run_v1.vantage.zst", std::ios::binary);
  const std::string packed(std::istreambuf_iterator<char>(file), {});
  std::vector<char> bytes(ZSTD_getFrameContentSize(packed.data(), packed.size()));
  EXPECT_EQ(ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size()), bytes.size());
  return bytes;
}

TEST(RunFile, OpensRunsOfTheFirstVersion) {
  const TestFolder folder;
  const std::vector<char> bytes = runOfVersion1();
  std::ofstream(folder / "old.vantage", std::ios::binary).write(bytes.data(), std::ssize(bytes));
  const RunReader run(folder / "old.vantage");
  EXPECT_EQ(run.header().input, "box");
  EXPECT_FALSE(run.header().octree);
  EXPECT_EQ(run.stopReason(), "finished");
  ASSERT_EQ(run.steps(), std::vector{1});
  const StepRecord step = run.step(1);
  ASSERT_TRUE(step.search && step.contours && step.changed_bricks);
  EXPECT_EQ(step.search->counts.poses_scored, 1680u);
  EXPECT_EQ(step.search->counts.poses_unreachable, 784u);
  EXPECT_FALSE(step.hasView());
  EXPECT_FALSE(step.utilities || step.box || step.changed_octree_bricks);
  TsdfVolume volume(run.header().volume);
  EXPECT_FALSE(run.moveVolume(volume, 0, 1).empty());
  const std::vector<StepSummary> summaries = run.summaries();
  ASSERT_FALSE(summaries.empty());
  EXPECT_EQ(summaries[0].poses_scored, 1680u);
  EXPECT_FALSE(summaries[0].utility || summaries[0].box_unknown);
}

TEST(RunFile, KeepsEveryOptionOfTheContourPlanner) {
  const TestFolder folder;
  RunHeader header = randomHeader(5);
  header.contour_config.contours.normal = ContourNormal::Surface;
  header.contour_config.gain.count = GainMeasure::Volume;
  RunWriter(folder / "a.vantage", header).finish("steps done");
  const RunHeader read = RunReader(folder / "a.vantage").header();
  EXPECT_EQ(read.contour_config.contours, header.contour_config.contours);
  EXPECT_EQ(read.contour_config.gain, header.contour_config.gain);
}

TEST(RunFile, RunsOfTheSecondVersionWereMadeWithTheDefaultOptions) {
  const TestFolder folder;
  writeRun(folder / "a.vantage", 5, 2);
  const auto change = [&](const char* sql) {
    Database database(folder / "a.vantage", DatabaseMode::Write);
    database.run(sql);
  };
  change("DELETE FROM run_product WHERE name='contour options'");
  EXPECT_THAT(inputError([&] { RunReader r(folder / "a.vantage"); }), HasSubstr("options of its planner"));
  change("PRAGMA user_version=2");
  const RunReader run(folder / "a.vantage");
  EXPECT_EQ(run.header().contour_config.contours.normal, ContourNormal::Frontier);
  EXPECT_EQ(run.header().contour_config.gain.count, GainMeasure::Rays);
  EXPECT_EQ(run.steps(), (std::vector{1, 2}));
}

TEST(RunFile, GivesBackTheOctreeAsItWasAtEveryStep) {
  const TestFolder folder;
  RunHeader header = randomHeader(7);
  OccupancyOctree map = emptyOctree(header);
  const auto readAll = [](const OccupancyOctree& octree) {
    std::vector<OctreeBrick> bricks;
    for (std::uint32_t b = 0; b < octree.bricks().total(); ++b) {
      const BrickRange range = octree.bricks().range(b);
      bricks.push_back({b, std::vector<float>((range.end - range.begin).prod())});
      octree.readBrick(b, bricks.back().log_odds);
    }
    return bricks;
  };
  std::vector<std::vector<OctreeBrick>> maps;
  {
    RunWriter writer(folder / "a.vantage", header);
    for (int step = 1; step <= 3; ++step) {
      map.set({step, 2, 1}, 0.85f * static_cast<float>(step));
      maps.push_back(readAll(map));
      StepRecord record;
      record.step = step;
      record.changed_octree_bricks = std::make_shared<std::vector<OctreeBrick>>(maps.back());
      writer.write(record);
    }
    writer.finish("steps done");
  }
  const auto same = [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  const RunReader run(folder / "a.vantage");
  OccupancyOctree read = emptyOctree(run.header());
  for (int step = 1; step <= 3; ++step) {
    run.moveOctree(read, step - 1, step);
    const std::vector<OctreeBrick> bricks = readAll(read);
    for (std::size_t b = 0; b < bricks.size(); ++b)
      EXPECT_TRUE(std::ranges::equal(bricks[b].log_odds, maps[step - 1][b].log_odds, same))
          << step << " " << b;
  }
  for (const int step : {1, 0}) {
    run.moveOctree(read, step == 1 ? 3 : 1, step);
    const std::vector<OctreeBrick> bricks = readAll(read);
    for (std::size_t b = 0; b < bricks.size(); ++b)
      for (std::size_t v = 0; v < bricks[b].log_odds.size(); ++v)
        EXPECT_TRUE(step == 0 ? std::isnan(bricks[b].log_odds[v])
                              : same(bricks[b].log_odds[v], maps[step - 1][b].log_odds[v]))
            << step << " " << b;
  }
  header.octree.reset();
  EXPECT_THROW(emptyOctree(header), std::invalid_argument);
}

TEST(RunFile, RefusesAnOctreeThatCannotBe) {
  const TestFolder folder;
  const auto openWith = [&](const auto& damage) {
    RunHeader header = randomHeader(5);
    damage(*header.octree);
    RunWriter(folder / "a.vantage", header).finish("steps done");
    return inputError([&] { RunReader r(folder / "a.vantage"); });
  };
  const auto boxOf = [](double x) { return [x](OctreeHeader& octree) { octree.object_box.min().x() = x; }; };
  for (const double x : {std::nan(""), -HUGE_VAL, HUGE_VAL, 5.0})
    EXPECT_THAT(openWith(boxOf(x)), ::testing::AllOf(HasSubstr("is damaged"), HasSubstr("box"))) << x;
  EXPECT_THAT(openWith([](OctreeHeader& octree) {
                octree.map.voxel_size_m = 0.5;  // two levels fit the default sensor
                octree.planner.coarse_levels = 3;
              }),
              ::testing::AllOf(HasSubstr("is damaged"), HasSubstr("coarse levels")));
}

TEST(RunFile, RefusesAnArmThatCannotBe) {
  const TestFolder folder;
  const auto openWith = [&](const auto& damage) {
    RunHeader header = randomHeader(5);
    damage(header.arm->model);
    RunWriter(folder / "a.vantage", header).finish("steps done");
    return inputError([&] { RunReader r(folder / "a.vantage"); });
  };
  EXPECT_THAT(openWith([](RobotModel& arm) { arm.joints.clear(); }), HasSubstr("number of joints"));
  EXPECT_THAT(openWith([](RobotModel& arm) { arm.shapes[0].frame = 6; }), HasSubstr("not there"));
}

TEST(RunFile, IsOneFileOnceFinishedAndReadingMakesNoOther) {
  const TestFolder folder;
  writeRun(folder / "a.vantage", 5, 2);
  EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"a.vantage"});
  const RunReader reader(folder / "a.vantage");
  reader.step(1);
  EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"a.vantage"});
}

TEST(RunFile, ReplacesAnEarlierRunButNothingElse) {
  const TestFolder folder;
  writeRun(folder / "a.run", 5, 2);
  writeRun(folder / "a.run", 6, 1);
  EXPECT_EQ(RunReader(folder / "a.run").steps(), std::vector{1});
  std::ofstream(folder / "notes.txt") << "mine\n";
  EXPECT_THAT(inputError([&] { RunWriter(folder / "notes.txt", {}); }), HasSubstr("is not a run file"));
  EXPECT_EQ(fs::file_size(folder / "notes.txt"), 5u);
  EXPECT_THAT(inputError([&] { RunWriter(folder / "none/a.vantage", {}); }),
              HasSubstr("folder does not exist"));
  EXPECT_THAT(inputError([&] { RunWriter(folder.path(), {}); }), HasSubstr("not a regular file"));
}

TEST(RunFile, TwoFilesOfTheSameRecordsHoldTheSameBytes) {
  const TestFolder folder;
  writeRun(folder / "a.vantage", 9, 2);
  writeRun(folder / "b.vantage", 9, 2);
  const auto bytes = [&](const char* name) {
    std::ifstream file(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const RunReader a(folder / "a.vantage"), b(folder / "b.vantage");
  ASSERT_EQ(a.products().size(), b.products().size());
  EXPECT_GT(a.products().size(), 20u);
  for (std::size_t i = 0; i < a.products().size(); ++i)
    EXPECT_EQ(a.products()[i].stored_bytes, b.products()[i].stored_bytes);
  EXPECT_EQ(bytes("a.vantage"), bytes("b.vantage"));
}

TEST(RunFile, RebuildsTheVolumeOfEveryStep) {
  const TestFolder folder;
  writeRun(folder / "a.vantage", 20, 3);
  const RunReader reader(folder / "a.vantage");
  TsdfVolume expected(testGrid()), forward(testGrid());
  for (int step = 1; step <= 4; ++step) {
    const StepRecord record = randomRecord(20 + step, step, step == 4);
    for (const TsdfBrick& brick : *record.changed_bricks) expected.setBrick(brick.brick, brick.voxels);
    const BrickSet changed = reader.moveVolume(forward, step - 1, step);
    EXPECT_EQ(changed.list().size(), record.changed_bricks->size());
    TsdfVolume direct(testGrid());
    reader.moveVolume(direct, 0, step);
    EXPECT_TRUE(std::ranges::equal(forward.voxels(), expected.voxels())) << step;
    EXPECT_TRUE(std::ranges::equal(direct.voxels(), expected.voxels())) << step;
  }
  EXPECT_THROW(reader.moveVolume(forward, 0, 5), std::invalid_argument);
  EXPECT_THROW(reader.moveVolume(forward, 5, 1), std::invalid_argument);
  EXPECT_THROW(reader.moveVolume(forward, -1, 1), std::invalid_argument);
  TsdfVolume other({{0, 0, 0}, 0.01, {4, 4, 4}});
  EXPECT_THROW(reader.moveVolume(other, 0, 1), std::invalid_argument);
}

TEST(RunFile, MovesTheVolumeFromAnyStepToAnyOther) {
  const TestFolder folder;
  writeRun(folder / "a.vantage", 60, 4);
  std::vector<TsdfVolume> expected(6, TsdfVolume(testGrid()));
  for (int step = 1; step <= 5; ++step) {
    expected[step] = expected[step - 1];
    const StepRecord record = randomRecord(60 + step, step, step == 5);
    for (const TsdfBrick& brick : *record.changed_bricks) expected[step].setBrick(brick.brick, brick.voxels);
  }
  std::mt19937 random(3);
  for (int round = 0; round < 10; ++round) {
    const RunReader reader(folder / "a.vantage");  // knows nothing yet of the bricks
    TsdfVolume volume(testGrid());
    for (int from = 0, moves = 0; moves < 6; ++moves) {
      const int to = static_cast<int>(random() % 6);
      const BrickSet changed = reader.moveVolume(volume, from, to);
      EXPECT_TRUE(std::ranges::equal(volume.voxels(), expected[to].voxels())) << from << " to " << to;
      for (std::uint32_t b = 0; b < changed.total(); ++b)
        EXPECT_TRUE(changed.contains(b) || expected[from].brick(b) == expected[to].brick(b)) << b;
      from = to;
    }
  }
}

TEST(RunFile, TellsTheFiguresOfItsStepsWithoutTheirProducts) {
  const TestFolder folder;
  writeRun(folder / "a.vantage", 70, 2);
  const std::vector<StepSummary> all = RunReader(folder / "a.vantage").summaries();
  ASSERT_EQ(all.size(), 3u);
  for (int step = 1; step <= 2; ++step) {
    const StepRecord record = randomRecord(70 + step, step);
    const StepSummary& summary = all[step - 1];
    EXPECT_EQ(summary.step, step);
    EXPECT_FALSE(summary.closing);
    EXPECT_EQ(summary.planner, record.planner);
    ASSERT_TRUE(summary.has_view);
    EXPECT_EQ(summary.unknown_voxels, record.metrics.unknown_voxels);
    EXPECT_EQ(summary.coverage, record.metrics.coverage);
    EXPECT_EQ(summary.box_unknown, record.box->unknown);
    EXPECT_EQ(summary.gain, record.chosen()->gain);
    EXPECT_EQ(summary.gain_voxels, record.chosen()->gain_voxels);
    EXPECT_EQ(summary.realised_voxels, record.realised_voxels);
    EXPECT_EQ(summary.toward_object, record.toward_object);
    EXPECT_EQ(summary.poses_scored, record.counts()->poses_scored);
    EXPECT_EQ(summary.segments, record.labels->count);
    const Timings& t = record.timings;
    EXPECT_DOUBLE_EQ(summary.planning_s, *t.contours + *t.surface + *t.segmentation + *t.saliency +
                                             *t.generation + *t.evaluation + *t.collision_map +
                                             *t.motion_planning);
  }
  EXPECT_TRUE(all[2].closing);
  EXPECT_FALSE(all[2].has_view);
  EXPECT_EQ(all[2].unknown_voxels, randomRecord(73, 3, true).metrics.unknown_voxels);
}

TEST(RunFile, NoticesWhatBecomesOfItsFile) {
  const TestFolder folder;
  const fs::path path = folder / "a.vantage";
  auto writer = std::make_unique<RunWriter>(path, randomHeader(1));
  const RunReader reader(path);
  writer->write(randomRecord(1, 1));
  EXPECT_EQ(reader.fileState(), RunFileState::Same);
  writer->finish("steps done");
  writer.reset();
  EXPECT_EQ(reader.steps(), std::vector{1});
  EXPECT_EQ(reader.fileState(), RunFileState::Same);
  writer = std::make_unique<RunWriter>(path, randomHeader(2));
  EXPECT_EQ(reader.fileState(), RunFileState::Replaced);
  EXPECT_EQ(reader.steps(), std::vector{1}) << "a finished run stays readable";
  const RunReader second(path);
  writer = std::make_unique<RunWriter>(path, randomHeader(3));
  EXPECT_EQ(second.fileState(), RunFileState::Replaced);
  EXPECT_THAT(inputError([&] { second.steps(); }), HasSubstr("was replaced"));
  writer.reset();
  fs::remove(path);
  EXPECT_EQ(second.fileState(), RunFileState::Gone);
  EXPECT_THAT(inputError([&] { second.steps(); }), HasSubstr("does not exist"));
}

TEST(RunFile, LeavesTheVolumeOutOnRequest) {
  const TestFolder folder;
  writeRun(folder / "a.vantage", 30, 1);
  const RunReader reader(folder / "a.vantage");
  StepRecord expected = randomRecord(31, 1);
  expected.changed_bricks.reset();
  expected.changed_octree_bricks.reset();
  expectEqual(reader.step(1, RunDetail::NoVolume), expected);
}

TEST(RunFile, NamesTheStepsThereAreWhenAskedForAnother) {
  const TestFolder folder;
  writeRun(folder / "a.vantage", 30, 2);
  const RunReader reader(folder / "a.vantage");
  EXPECT_THAT(inputError([&] { reader.step(9); }), HasSubstr("no step 9; its steps are 1 to 2"));
}

TEST(RunFile, RefusesWhatIsNoRun) {
  const TestFolder folder;
  const auto open = [&](const std::string& name) { return inputError([&] { RunReader r(folder / name); }); };
  EXPECT_THAT(open("none.vantage"), HasSubstr("does not exist"));
  EXPECT_THAT(open(""), HasSubstr("is not a file"));
  std::ofstream(folder / "empty.vantage");
  EXPECT_THAT(open("empty.vantage"), HasSubstr("is not a run file"));
  std::ofstream(folder / "text.vantage") << std::string(5000, 'x');
  EXPECT_THAT(open("text.vantage"), HasSubstr("is not a run file"));
}

/// Overwrites bytes of a finished run.
void patch(const fs::path& path, std::streamoff at, const std::string& bytes) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(at);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

TEST(RunFile, SaysWhatToDoAboutANewerVersion) {
  const TestFolder folder;
  writeRun(folder / "a.vantage", 30, 1);
  patch(folder / "a.vantage", 60, std::string("\0\0\0\x63", 4));  // SQLite's user version
  EXPECT_THAT(inputError([&] { RunReader r(folder / "a.vantage"); }),
              ::testing::AllOf(HasSubstr("a.vantage: has version 99"), HasSubstr("newer vantage")));
  patch(folder / "a.vantage", 68, "none");  // SQLite's application id
  EXPECT_THAT(inputError([&] { RunReader r(folder / "a.vantage"); }), HasSubstr("not a run file"));
}

/// Reads everything; true if it equals what writeRun(path, 40, 2) wrote.
bool readsAsWritten(const fs::path& path) {
  const RunReader reader(path);
  bool same = equal(reader.header(), randomHeader(40)) && reader.steps() == std::vector{1, 2} &&
              reader.stopReason() == "steps done" && reader.hasClosing();
  for (const int step : reader.steps())
    same = same && equal(reader.step(step), randomRecord(40 + step, step));
  return same && equal(reader.closing(), randomRecord(43, 3, true));
}

TEST(RunFile, AFlippedBitIsNoticedOrHarmless) {
  const TestFolder folder;
  writeRun(folder / "good.vantage", 40, 2);
  ASSERT_TRUE(readsAsWritten(folder / "good.vantage"));
  std::ifstream file(folder / "good.vantage", std::ios::binary);
  const std::string good(std::istreambuf_iterator<char>(file), {});
  std::mt19937 random(1);
  int noticed = 0;
  for (int i = 0; i < 600; ++i) {
    std::string bad = good;
    // Every third in the first page, where SQLite keeps its own header and schema.
    const std::size_t at = random() % (i % 3 == 0 ? 4096 : bad.size());
    bad[at] = static_cast<char>(bad[at] ^ (1 << random() % 8));
    std::ofstream(folder / "bad.vantage", std::ios::binary) << bad;
    try {
      EXPECT_TRUE(readsAsWritten(folder / "bad.vantage")) << "other data from a bit flipped in byte " << at;
    } catch (const InputError&) {
      ++noticed;
    }
  }
  EXPECT_GT(noticed, 100);
  EXPECT_LT(noticed, 600);
}

TEST(RunFile, ATruncatedFileIsRefused) {
  const TestFolder folder;
  writeRun(folder / "a.vantage", 40, 2);
  const auto full = fs::file_size(folder / "a.vantage");
  for (int part = 19; part >= 0; --part) {
    fs::resize_file(folder / "a.vantage", full * part / 20);
    EXPECT_THROW(readsAsWritten(folder / "a.vantage"), InputError) << part << "/20";
  }
}

}  // namespace
}  // namespace vantage::testing
