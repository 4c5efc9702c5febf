#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/app/experiments/report.h"
#include "viewer/app/experiments/table_run.h"

namespace vantage::experiments {

/// All runs of one object at one size; the first is uniform ray tracing.
struct ObjectRuns {
  std::string object;
  double size_m = 0.0;
  std::vector<RunResult> runs;

  const RunResult& uniform() const { return runs.front(); }
  std::string title() const;
};

/// a / b, 0 for b = 0.
double ratio(double a, double b);

/// A run against uniform ray tracing of the same object: mean NBV time by the clock and in CPU time, and
/// visits per scored view.
double timeShare(const ObjectRuns& set, const RunResult& run);
double cpuShare(const ObjectRuns& set, const RunResult& run);
double visitShare(const ObjectRuns& set, const RunResult& run);
/// Finest rays that were cast, of all finest rays of the scored views.
double finestShare(const RunResult& run);
/// Cost of the views that the table hides against uniform ray tracing on the same map.
double hiddenTimeShare(const ObjectRuns& set, const RunResult& run);
double hiddenVisitShare(const ObjectRuns& set, const RunResult& run);
/// Step at which the literal rule would have stopped (D-A18).
std::optional<double> literalStop(const RunResult& run);

/// The table of evaluation.md, and one with every planning step.
Table mainTable(const std::vector<ObjectRuns>& sets);
Table stepTable(const std::vector<ObjectRuns>& sets);

/// Adds the pass criteria with their values. \param cut_off runs end before they are done: what depends on
/// their ends is not judged
void judgeRuns(const std::vector<ObjectRuns>& sets, bool cut_off, Report& report);

}  // namespace vantage::experiments
