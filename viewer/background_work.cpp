#include "viewer/background_work.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <utility>

namespace vantage {
namespace {

constexpr auto kWakeEvery = std::chrono::milliseconds(100);

struct Task {
  std::string name;
  BackgroundWork::Job job;
};

/// The job that the worker is at.
struct Running {
  BackgroundProgress progress;
  std::stop_source stop;
};

/// What a job left for poll().
struct Outcome {
  std::string name;
  BackgroundWork::Finish finish;
  std::string failure;  ///< empty if it went well
};

/// What an action fails with; empty if it does not.
template <class Action>
std::string failureOf(const Action& action) {
  try {
    action();
    return {};
  } catch (const std::exception& error) {
    return failureText(error);
  } catch (...) {
    return "failed without a message";
  }
}

}  // namespace

std::string failureText(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error))
    return "does not fit in memory; close other programs or use a larger machine";
  return *error.what() ? error.what() : "failed without a message";
}

struct BackgroundWork::State {
  std::function<void()> wake;
  Failure failed;
  mutable std::mutex mutex;
  std::condition_variable_any changed;
  std::deque<Task> waiting;
  std::optional<Running> running;
  std::deque<Outcome> done;
  std::jthread worker;  // last: joined before the rest goes

  void work(std::stop_token quit);
  /// Runs a task outside the lock.
  Outcome carryOut(Task task, std::stop_token stop);
  RunControl control(std::stop_token stop);
  void forget(const std::string& name);
};

void BackgroundWork::State::work(std::stop_token quit) {
  std::unique_lock lock(mutex);
  while (changed.wait(lock, quit, [&] { return !waiting.empty(); })) {
    if (quit.stop_requested()) return;
    Task task = std::move(waiting.front());
    waiting.pop_front();
    running.emplace().progress.name = task.name;
    const std::stop_source stop = running->stop;
    lock.unlock();
    std::optional<Outcome> outcome = carryOut(std::move(task), stop.get_token());
    lock.lock();
    running.reset();
    const bool wanted = !stop.stop_requested() && (outcome->finish || !outcome->failure.empty());
    if (wanted) done.push_back(std::move(*outcome));
    lock.unlock();
    outcome.reset();  // what a cancelled job made goes outside the lock
    if (wanted && wake) wake();
    lock.lock();
  }
}

Outcome BackgroundWork::State::carryOut(Task task, std::stop_token stop) {
  Outcome outcome{task.name, {}, {}};
  const RunControl run = control(stop);
  outcome.failure = failureOf([&] {
    try {
      outcome.finish = task.job(run);
    } catch (const Cancelled&) {  // asked for, not failed
    }
  });
  return outcome;
}

RunControl BackgroundWork::State::control(std::stop_token stop) {
  RunControl run;
  run.stop = stop;
  run.progress = [this, last = std::chrono::steady_clock::time_point()](
                     std::string_view phase, std::uint64_t items, std::uint64_t total) mutable {
    {
      const std::lock_guard lock(mutex);
      if (!running) return;
      running->progress.phase = phase;
      running->progress.done = items;
      running->progress.total = total;
    }
    const auto now = std::chrono::steady_clock::now();
    if (!wake || now - last < kWakeEvery) return;
    last = now;
    wake();
  };
  return run;
}

/// Called with the lock held.
void BackgroundWork::State::forget(const std::string& name) {
  const auto named = [&](const auto& each) { return each.name == name; };
  std::erase_if(waiting, named);
  std::erase_if(done, named);
  if (running && running->progress.name == name) running->stop.request_stop();
}

BackgroundWork::BackgroundWork(std::function<void()> wake) : state_(std::make_unique<State>()) {
  state_->wake = std::move(wake);
  state_->worker = std::jthread([state = state_.get()](std::stop_token quit) { state->work(quit); });
}

BackgroundWork::~BackgroundWork() {
  state_->worker.request_stop();
  {
    const std::lock_guard lock(state_->mutex);
    if (state_->running) state_->running->stop.request_stop();
  }
  state_->worker.join();
}

void BackgroundWork::onFailure(Failure failed) {
  state_->failed = std::move(failed);
}

void BackgroundWork::start(std::string name, Job job) {
  {
    const std::lock_guard lock(state_->mutex);
    state_->forget(name);
    state_->waiting.push_back({std::move(name), std::move(job)});
  }
  state_->changed.notify_one();
}

void BackgroundWork::cancel(const std::string& name) {
  const std::lock_guard lock(state_->mutex);
  state_->forget(name);
}

bool BackgroundWork::poll() {
  std::unique_lock lock(state_->mutex);
  const std::size_t now = state_->done.size();  // what comes later is for the next time
  for (std::size_t i = 0; i < now && !state_->done.empty(); ++i) {
    Outcome outcome = std::move(state_->done.front());
    state_->done.pop_front();
    lock.unlock();
    if (outcome.failure.empty()) outcome.failure = failureOf(outcome.finish);
    if (!outcome.failure.empty() && state_->failed) state_->failed(outcome.name, outcome.failure);
    lock.lock();
  }
  return now > 0;
}

std::vector<BackgroundProgress> BackgroundWork::running() const {
  const std::lock_guard lock(state_->mutex);
  std::vector<BackgroundProgress> all;
  if (state_->running && !state_->running->stop.stop_requested()) all.push_back(state_->running->progress);
  for (const Task& task : state_->waiting) all.push_back({.name = task.name, .phase = {}, .waiting = true});
  return all;
}

bool BackgroundWork::busy() const {
  const std::lock_guard lock(state_->mutex);
  return state_->running || !state_->waiting.empty() || !state_->done.empty();
}

}  // namespace vantage
