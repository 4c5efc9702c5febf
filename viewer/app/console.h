#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "core/run_control.h"
#include "viewer/app/command.h"

namespace vantage::app {

/// Work was stopped by the user; says what was kept. Ends the program with exit code 1.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Takes over SIGINT, SIGTERM and SIGHUP for the whole program: a console that exists is asked to stop,
/// otherwise (or when asked twice) the program ends at once with 130. Call it before any other thread is
/// made.
void watchStopSignals();

/// Routes log lines to standard error: warnings always, details with -v, as JSON objects with --log-json.
void setUpLog(const GlobalOptions& global);

/// A line for people on standard output, unless -q.
void say(const GlobalOptions& global, const std::string& line);

/// `vantage: warning: ...` on standard error.
void warn(const std::string& message);

/// A log line that names what was done; shown with -v.
void logDetail(const std::string& line);

/// Progress of long work on standard error: on a terminal a bar with rate and time left, in a pipe nothing
/// (finished steps are printed as lines). Ctrl-C and SIGTERM request a stop.
class Console {
 public:
  explicit Console(const GlobalOptions& global);
  ~Console();
  Console(const Console&) = delete;

  /// Stop token and progress to hand to long work.
  RunControl control();
  /// Removes the bar, so that a line can be printed.
  void clear();
  bool interrupted() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vantage::app
