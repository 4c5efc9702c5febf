#include "viewer/background_work.h"

#include <gmock/gmock.h>

#include <array>
#include <atomic>
#include <chrono>
#include <random>
#include <semaphore>
#include <thread>

namespace vantage {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Counts wakes; lets a test wait for them.
class Bell {
 public:
  std::function<void()> ring() {
    return [this] { rung_.release(); };
  }
  [[nodiscard]] bool wait() { return rung_.try_acquire_for(20s); }

 private:
  std::counting_semaphore<> rung_{0};
};

/// Polls until nothing runs, waits or is left.
void settle(BackgroundWork& work) {
  const auto until = std::chrono::steady_clock::now() + 20s;
  while (work.busy() && std::chrono::steady_clock::now() < until) {
    work.poll();
    std::this_thread::sleep_for(100us);
  }
  ASSERT_FALSE(work.busy());
}

/// A job that waits until it is told to stop, and says that it began.
BackgroundWork::Job untilStopped(std::binary_semaphore& began) {
  return [&began](const RunControl& control) -> BackgroundWork::Finish {
    began.release();
    while (true) {
      control.check();
      std::this_thread::sleep_for(100us);
    }
  };
}

TEST(BackgroundWork, WorksOnAnotherThreadAndFinishesOnThePollingOne) {
  Bell bell;
  BackgroundWork work(bell.ring());
  std::thread::id worked, finished;
  work.start("a", [&](const RunControl&) {
    worked = std::this_thread::get_id();
    return [&] { finished = std::this_thread::get_id(); };
  });
  ASSERT_TRUE(bell.wait());
  EXPECT_EQ(finished, std::thread::id());
  EXPECT_TRUE(work.poll());
  EXPECT_EQ(finished, std::this_thread::get_id());
  EXPECT_NE(worked, std::this_thread::get_id());
  EXPECT_FALSE(work.poll());
  EXPECT_FALSE(work.busy());
}

TEST(BackgroundWork, DoesJobsOfDifferentNamesInTheOrderOfTheirStart) {
  BackgroundWork work({});
  std::vector<int> order;
  for (int i = 0; i < 5; ++i)
    work.start("job " + std::to_string(i),
               [&order, i](const RunControl&) { return [&order, i] { order.push_back(i); }; });
  settle(work);
  EXPECT_THAT(order, ElementsAre(0, 1, 2, 3, 4));
}

TEST(BackgroundWork, TheNewestJobOfANameReplacesOneThatRunsWaitsOrIsDone) {
  Bell bell;
  std::vector<std::string> seen;
  const auto saying = [&](std::string text) {
    return [&seen, text](const RunControl&) { return [&seen, text] { seen.push_back(text); }; };
  };
  BackgroundWork work(bell.ring());
  std::binary_semaphore began(0);
  work.start("score", saying("done, not polled"));
  ASSERT_TRUE(bell.wait());
  work.start("score", untilStopped(began));
  began.acquire();
  work.start("score", saying("waiting"));
  work.start("score", saying("newest"));
  settle(work);
  EXPECT_THAT(seen, ElementsAre("newest"));
}

TEST(BackgroundWork, ACancelledJobNeverFinishesEvenIfItDoesNotNotice) {
  Bell bell;
  BackgroundWork work(bell.ring());
  bool finished = false;
  std::binary_semaphore began(0), go(0);
  work.start("stubborn", [&](const RunControl&) {
    began.release();
    go.acquire();
    return [&] { finished = true; };
  });
  work.start("waiting", [&](const RunControl&) { return [&] { finished = true; }; });
  began.acquire();
  work.cancel("stubborn");
  work.cancel("waiting");
  work.cancel("unknown");
  EXPECT_THAT(work.running(), IsEmpty());
  go.release();
  settle(work);
  work.start("done", [&](const RunControl&) { return [&] { finished = true; }; });
  ASSERT_TRUE(bell.wait());
  work.cancel("done");
  EXPECT_FALSE(work.poll());
  EXPECT_FALSE(finished);
}

TEST(BackgroundWork, AFinishMayCancelOneThatComesAfterItAndStartMore) {
  BackgroundWork work({});
  std::vector<std::string> seen;
  work.start("first", [&](const RunControl&) {
    return [&] {
      seen.push_back("first");
      work.cancel("second");
      work.start("third", [&](const RunControl&) { return [&] { seen.push_back("third"); }; });
    };
  });
  work.start("second", [&](const RunControl&) { return [&] { seen.push_back("second"); }; });
  while (!work.running().empty()) std::this_thread::sleep_for(100us);
  settle(work);
  EXPECT_THAT(seen, ElementsAre("first", "third"));
}

TEST(BackgroundWork, ExceptionsOfJobsAndFinishesArriveAsFailures) {
  std::vector<std::string> failures;
  BackgroundWork work({});
  work.onFailure([&](const std::string& name, const std::string& message) {
    failures.push_back(name + ": " + message);
  });
  work.start("a",
             [](const RunControl&) -> BackgroundWork::Finish { throw std::runtime_error("file is gone"); });
  work.start("b", [](const RunControl&) -> BackgroundWork::Finish { throw 7; });
  work.start("c", [](const RunControl&) { return [] { throw std::runtime_error("no room"); }; });
  work.start("d", [](const RunControl&) -> BackgroundWork::Finish { return {}; });
  settle(work);
  EXPECT_THAT(failures, ElementsAre("a: file is gone", "b: failed without a message", "c: no room"));
}

TEST(BackgroundWork, TellsWhatRunsAndWaits) {
  Bell bell;
  BackgroundWork work(bell.ring());
  std::binary_semaphore go(0);
  work.start("score", [&](const RunControl& control) -> BackgroundWork::Finish {
    control.report("poses", 3, 10);
    go.acquire();
    return {};
  });
  work.start("segment", [](const RunControl&) -> BackgroundWork::Finish { return {}; });
  ASSERT_TRUE(bell.wait()) << "progress wakes, too";
  const auto all = work.running();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].name, "score");
  EXPECT_EQ(all[0].phase, "poses");
  EXPECT_EQ(all[0].done, 3u);
  EXPECT_EQ(all[0].total, 10u);
  EXPECT_FALSE(all[0].waiting);
  EXPECT_EQ(all[1].name, "segment");
  EXPECT_TRUE(all[1].waiting);
  go.release();
  settle(work);
  EXPECT_THAT(work.running(), IsEmpty());
}

TEST(BackgroundWork, EndsWithAJobThatRunsAndOthersThatWait) {
  std::binary_semaphore began(0);
  bool second = false;
  {
    BackgroundWork work({});
    work.start("a", untilStopped(began));
    work.start("b", [&](const RunControl&) -> BackgroundWork::Finish {
      second = true;
      return {};
    });
    began.acquire();
  }
  EXPECT_FALSE(second);
}

// Starts, cancels and polls as fast as it goes. Whatever is interleaved: finishes of a name arrive in the
// order of its starts, none after a newer start or a cancel, and the last one that was not cancelled always
// arrives.
TEST(BackgroundWork, KeepsItsPromisesWhateverIsInterleaved) {
  constexpr int kNames = 3, kRounds = 4000;
  std::atomic<int> wakes = 0;
  BackgroundWork work([&] { ++wakes; });
  std::array<int, kNames> newest{}, arrived{};
  std::mt19937 random(5);
  int started = 0;
  for (int round = 0; round < kRounds; ++round) {
    const int n = static_cast<int>(random() % kNames);
    const std::string name(1, static_cast<char>('a' + n));
    switch (random() % 4) {
      case 0:
        work.poll();
        break;
      case 1:
        work.cancel(name);
        newest[n] = 0;
        break;
      default:
        newest[n] = ++started;
        work.start(name, [&, n, number = started](const RunControl& control) -> BackgroundWork::Finish {
          control.report("spin", 1, 2);
          for (int i = 0; i < number % 50; ++i) control.check();
          return [&, n, number] {
            EXPECT_EQ(number, newest[n]) << "a replaced or cancelled job has finished";
            arrived[n] = number;
          };
        });
    }
  }
  settle(work);
  for (int n = 0; n < kNames; ++n) EXPECT_TRUE(newest[n] == 0 || arrived[n] == newest[n]) << n;
  EXPECT_GT(wakes, 0);
}

}  // namespace
}  // namespace vantage
