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

/// a / b; none unless both were measured and b is above 0.
std::optional<double> ratio(std::optional<double> a, std::optional<double> b);
/// "1 run", "2 runs".
std::string runsText(int runs);
/// A share in per cent.
std::optional<double> percent(std::optional<double> share);

// A run against uniform ray tracing of the same object. Each is empty where either side measured nothing.

/// Mean NBV time by the clock and in CPU time, and visits per scored view. Empty if uniform cast no ray.
std::optional<double> timeShare(const ObjectRuns& set, const RunResult& run);
std::optional<double> cpuShare(const ObjectRuns& set, const RunResult& run);
std::optional<double> visitShare(const ObjectRuns& set, const RunResult& run);
/// Finest rays that were cast, of all finest rays of the scored views.
std::optional<double> finestShare(const RunResult& run);
/// Cost of the views that the table hides against uniform ray tracing on the same map.
std::optional<double> hiddenTimeShare(const ObjectRuns& set, const RunResult& run);
std::optional<double> hiddenVisitShare(const ObjectRuns& set, const RunResult& run);
/// Coverage that the run ends with less than uniform, points; negative = more. Empty if uniform covers
/// nothing or took no view after the first scan.
std::optional<double> lostPoints(const ObjectRuns& set, const RunResult& run);
/// Scans and total planning time. Empty if uniform took no view after the first scan.
std::optional<double> viewShare(const ObjectRuns& set, const RunResult& run);
std::optional<double> totalTimeShare(const ObjectRuns& set, const RunResult& run);
/// Step at which the literal rule would have stopped (D-A18).
std::optional<double> literalStop(const RunResult& run);

/// The table of evaluation.md, and one with every planning step.
Table mainTable(const std::vector<ObjectRuns>& sets);
Table stepTable(const std::vector<ObjectRuns>& sets);

/// Adds the pass criteria with their values. What was not measured is "not run". Of runs that were cut off,
/// coverage, views and total time are graded only where more steps could not change the verdict.
void judgeRuns(const std::vector<ObjectRuns>& sets, Report& report);

/// Criteria (1), (2): cost; (3), (4): what the runs ended with; (5) and the maps.
void judgeCost(const std::vector<ObjectRuns>& sets, Report& report);
void judgeEnds(const std::vector<ObjectRuns>& sets, Report& report);
void judgeSameness(const std::vector<ObjectRuns>& sets, Report& report);

}  // namespace vantage::experiments
