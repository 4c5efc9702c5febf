#pragma once

#include <memory>
#include <string>

#include "core/exploration/step_record.h"
#include "io/run_file.h"

namespace vantage {

/// The object of `explore --json`: version, input, planner, robot, seed, threads, compute, stop_reason,
/// steps[] and final. Every key is there in this order, null where it does not apply; a timing of a phase
/// that did not run is null. Feed it the records as they come; text() is valid at any time.
class JsonSummary {
 public:
  explicit JsonSummary(const RunHeader& header);
  ~JsonSummary();
  JsonSummary(const JsonSummary&) = delete;

  /// Adds a finished step, or the closing record, which becomes `final`.
  void add(const StepRecord& record);
  /// Fills in realised_voxels and the served frame of a step added before.
  /// \throws std::invalid_argument if there is no such step.
  void setRealised(const StepRecord& record);
  void finish(const std::string& stop_reason);

  /// The JSON text, indented, with a line end.
  std::string text() const;
  /// Writes the text to a file, or to standard output for "-".
  /// \throws InputError if the file cannot be created, std::runtime_error if it cannot be written.
  void write(const std::string& path) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The object of one entry of steps[], indented: what one planned step is in `plan --json`.
std::string stepJsonText(const StepRecord& record);

/// The same object from a recorded run.
std::unique_ptr<JsonSummary> jsonSummary(const RunReader& run);

}  // namespace vantage
