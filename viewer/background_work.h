#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/run_control.h"

namespace vantage {

/// How far a piece of background work has come.
struct BackgroundProgress {
  std::string name;
  std::string phase;        ///< as the work reports it; empty before it does
  std::uint64_t done = 0;   ///< items
  std::uint64_t total = 0;  ///< items; 0 = not known
  bool waiting = false;     ///< it has not begun
};

/// What went wrong, for people.
std::string failureText(const std::exception& error);

/// Long work beside the window: one worker thread does one job after the other, in the order in which they
/// were started; what they give is handed over on the thread that calls poll(). All functions belong to one
/// owning thread. A job that was cancelled never hands anything over.
class BackgroundWork {
 public:
  using Finish = std::function<void()>;                  ///< runs in poll(); may start and cancel jobs
  using Job = std::function<Finish(const RunControl&)>;  ///< runs on the worker; may return an empty Finish
  using Failure = std::function<void(const std::string& name, const std::string& message)>;

  /// \param wake called from the worker, outside all locks, when there is something to poll, and at most ten
  /// times a second while a job reports progress; may be empty.
  explicit BackgroundWork(std::function<void()> wake);
  /// Cancels everything and waits for the running job to notice.
  ~BackgroundWork();
  BackgroundWork(const BackgroundWork&) = delete;
  BackgroundWork& operator=(const BackgroundWork&) = delete;

  /// Who is told, in poll(), of exceptions from jobs and their finishes.
  void onFailure(Failure failed);

  /// The newest job of a name replaces one that waits, runs or was not polled yet under it, which is
  /// cancelled.
  void start(std::string name, Job job);
  /// Nothing happens if there is no such job.
  void cancel(const std::string& name);

  /// Runs the finishes and tells the failures of jobs that are done. \return true if there were any
  bool poll();

  /// The running job, then those that wait.
  std::vector<BackgroundProgress> running() const;
  /// A job runs, waits, or is done and was not polled.
  bool busy() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage
