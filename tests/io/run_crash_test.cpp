// What becomes of a run file when its writer is killed, is still at work, or runs out of disk.

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>
#include <thread>

#include "io/error.h"
#include "io/run_file.h"
#include "tests/io/run_support.h"

namespace vantage::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// Runs `work` in a process of its own, without the parent's buffers and exit handlers.
template <class Work>
pid_t fork(const Work& work) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  int result = 1;
  try {
    result = work();
  } catch (...) {
    result = 99;
  }
  ::_exit(result);
}

int exitOf(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/// A record with bricks enough for a transaction of some megabytes.
StepRecord largeRecord(int step) {
  StepRecord record = randomRecord(1000 + step, step);
  auto bricks = std::make_shared<std::vector<TsdfBrick>>();
  Randomizer random(step);
  for (std::uint32_t b = 0; b < 600; ++b) {
    TsdfBrick brick{b, std::vector<TsdfVoxel>(1024)};
    for (TsdfVoxel& voxel : brick.voxels) {
      random.scalar(voxel.value);
      random.scalar(voxel.weight);
    }
    bricks->push_back(std::move(brick));
  }
  record.changed_bricks = bricks;
  return record;
}

TEST(RunFileCrash, AKilledWriterLeavesEveryFinishedStep) {
  const TestFolder folder;
  const fs::path path = folder / "a.vantage";
  int steps_seen = 0;
  for (int round = 0; round < 6; ++round) {
    int said[2];
    ASSERT_EQ(::pipe(said), 0);
    const pid_t child = fork([&] {
      RunWriter writer(path, randomHeader(1));
      for (int step = 1;; ++step) {
        writer.write(largeRecord(step));
        if (::write(said[1], "s", 1) != 1) return 1;
      }
    });
    ::close(said[1]);
    char byte = 0;
    ASSERT_EQ(::read(said[0], &byte, 1), 1);
    std::this_thread::sleep_for(37ms * round);  // anywhere in the middle of a later step
    ::kill(child, SIGKILL);
    EXPECT_EQ(exitOf(child), -SIGKILL);
    int finished = 1;
    while (::read(said[0], &byte, 1) == 1) ++finished;
    ::close(said[0]);

    const RunReader reader(path);
    const std::vector<int> steps = reader.steps();
    ASSERT_GE(static_cast<int>(steps.size()), finished);
    for (const int step : steps) expectEqual(reader.step(step), largeRecord(step));
    EXPECT_FALSE(reader.stopReason().has_value());
    steps_seen += finished;
  }
  EXPECT_GT(steps_seen, 6);
}

TEST(RunFileCrash, AReaderFollowsAWriterInAnotherProcess) {
  const TestFolder folder;
  const fs::path path = folder / "a.vantage";
  constexpr int kSteps = 12;
  { RunWriter empty(path, randomHeader(1)); }
  const RunReader reader(path);
  EXPECT_TRUE(reader.steps().empty());
  fs::remove(path);

  const pid_t child = fork([&] {
    RunWriter writer(path, randomHeader(1));
    for (int step = 1; step <= kSteps; ++step) {
      writer.write(largeRecord(step));
      std::this_thread::sleep_for(15ms);
    }
    writer.finish("steps done");
    return 0;
  });
  while (!fs::exists(path)) std::this_thread::sleep_for(1ms);
  const RunReader follower(path);
  std::vector<std::size_t> counts = {0};
  while (!follower.stopReason()) {
    const std::vector<int> steps = follower.steps();
    ASSERT_GE(steps.size(), counts.back());
    if (steps.size() > counts.back()) {
      counts.push_back(steps.size());
      expectEqual(follower.step(steps.back()), largeRecord(steps.back()));
    }
    std::this_thread::sleep_for(2ms);
  }
  EXPECT_EQ(exitOf(child), 0);
  EXPECT_GT(counts.size(), 3u) << "the run was never seen growing";
  EXPECT_EQ(follower.steps().size(), static_cast<std::size_t>(kSteps));
  EXPECT_FALSE(fs::exists(path.string() + "-wal")) << "the follower kept the writer from folding its files";
}

TEST(RunFileCrash, AFullDiskIsReportedAndEarlierStepsStay) {
  const TestFolder folder;
  const fs::path path = folder / "a.vantage";
  const pid_t child = fork([&] {
    ::signal(SIGXFSZ, SIG_IGN);
    RunWriter writer(path, randomHeader(1));
    writer.write(randomRecord(1, 1));
    writer.write(randomRecord(2, 2));
    const rlimit limit{1 << 20, 1 << 20};  // a step's log does not fit
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      writer.write(largeRecord(3));
      return 2;
    } catch (const InputError&) {
      return 3;
    } catch (const std::runtime_error& error) {
      const std::string text = error.what();
      if (!text.starts_with(path.string() + ": step 3") || text.find("disk full") == std::string::npos)
        return 4;
    }
    writer.write(randomRecord(4, 4));  // a small one still fits: the writer is in order
    return 0;
  });
  EXPECT_EQ(exitOf(child), 0);
  const RunReader reader(path);
  EXPECT_EQ(reader.steps(), (std::vector{1, 2, 4}));
  expectEqual(reader.step(1), randomRecord(1, 1));
  expectEqual(reader.step(2), randomRecord(2, 2));
  expectEqual(reader.step(4), randomRecord(4, 4));
}

TEST(RunFileCrash, ADiskFullFromTheStartIsAnError) {
  const TestFolder folder;
  const pid_t child = fork([&] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      RunWriter writer(folder / "a.vantage", randomHeader(1));
    } catch (const InputError&) {
      return 0;
    }
    return 2;
  });
  EXPECT_EQ(exitOf(child), 0);
}

TEST(RunFileCrash, ManyThreadsReadOneRun) {
  const TestFolder folder;
  writeRun(folder / "a.vantage", 50, 4);
  const RunReader reader(folder / "a.vantage");
  std::vector<std::jthread> threads;
  std::vector<int> same(8, 0);
  for (int t = 0; t < 8; ++t)
    threads.emplace_back(
        [&, t] { same[t] = equal(reader.step(1 + t % 4), randomRecord(51 + t % 4, 1 + t % 4)); });
  threads.clear();
  EXPECT_THAT(same, ::testing::Each(1));
}

}  // namespace
}  // namespace vantage::testing
