#pragma once

#include <functional>
#include <string>
#include <vector>

#include "viewer/app/experiments/b1_runs.h"
#include "viewer/app/experiments/report.h"
#include "viewer/app/experiments/spread.h"

namespace vantage::experiments {

/// All runs of B1 that were finished.
using Runs = std::vector<ExplorationRun>;

struct ExperimentOptions;

/// Makes the runs, or takes over those that were kept. What an interruption left out is named in the report.
/// \param experiment "B1" or "B2", for people
Runs exploreAll(const std::string& experiment, const std::vector<RunOf>& planned,
                const ExperimentOptions& options, Report& report);

/// Runs of one series and method; of one scene unless `scene` is empty. They point into `runs`.
std::vector<const ExplorationRun*> select(const Runs& runs, Series series, bool proposed,
                                          const std::string& scene = "");
/// Mean and deviation of a figure of runs.
Spread spreadOver(const std::vector<const ExplorationRun*>& runs,
                  const std::function<double(const ExplorationRun&)>& figure);
/// Scenes in the order of the runs.
std::vector<std::string> scenesOf(const Runs& runs);

/// A row for each NBV.
Table nbvTable(const Runs& runs);
/// A row for each run: the graded series, those that are printed beside it, and the scenes by somebody who
/// had not seen the settings; without those that have no runs.
std::vector<Table> runTables(const Runs& runs);
/// Tables 1 and 3 of the paper beside ours, of the core series.
Table phaseTable(const Runs& runs, Series series);
Table tickTable(const Runs& runs);
/// Table 2: segments of the third NBV of the first proposed run on `tabletop`; empty if there is none.
Table segmentTable(const Runs& runs);
/// Fig. 18: mean unknown near the objects, a plot for each scene.
std::vector<LinePlot> unknownPlots(const Runs& runs);

/// Criteria 1 to 6 on the core series. What was not run for both methods is "not run".
void judgeB1(const Runs& runs, Report& report);

}  // namespace vantage::experiments
