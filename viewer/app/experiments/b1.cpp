// B1: exploration of four tabletop scenes by the contour-based planner and the standard baseline.
#include <fmt/format.h>

#include "viewer/app/experiments/b1_report.h"
#include "viewer/app/experiments/experiments.h"

namespace vantage::experiments {
namespace {

const std::vector<std::string> kScenes = {"tabletop", "clutter", "apart", "row"};  // S1 to S4

/// The core first; both methods of a seed one after the other, so that an interruption leaves pairs.
std::vector<RunOf> plannedRuns(const ExperimentOptions& options) {
  std::vector<RunOf> runs;
  const auto add = [&](Series series, std::uint64_t seeds, const std::vector<std::string>& scenes) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed)
      for (const std::string& scene : scenes)
        for (const bool proposed : {true, false}) runs.push_back({scene, series, proposed, seed});
  };
  if (options.quick) {
    add(Series::Core, options.seeds.value_or(1), {"tabletop"});
    return runs;
  }
  add(Series::Core, options.seeds.value_or(5), kScenes);
  add(Series::Arm, options.seeds.value_or(1), kScenes);
  for (const Series series : {Series::Open, Series::Filtered, Series::Exact})
    add(series, options.seeds.value_or(1), kScenes);
  add(Series::Unseen, options.seeds.value_or(1), {"unseen_kitchen", "unseen_workshop"});
  return runs;
}

}  // namespace

Report runB1(const ExperimentOptions& options) {
  Report report;
  const Runs runs = exploreAll("B1", plannedRuns(options), options, report);
  if (runs.empty()) return report;
  report.tables = {nbvTable(runs)};
  for (Table& table : runTables(runs)) report.tables.push_back(std::move(table));
  if (Table arm = phaseTable(runs, Series::Arm); !arm.rows.empty()) report.tables.push_back(std::move(arm));
  for (Table& table : std::vector{phaseTable(runs, Series::Core), segmentTable(runs), tickTable(runs)})
    report.tables.push_back(std::move(table));
  report.lines = unknownPlots(runs);
  judgeB1(runs, report);
  report.defaults =
      contourDefaultsUsed(settingsOf(runs.front().run, sceneOf(runs.front().run), options.tune), "B1");
  report.notes.push_back(
      "B1: sizes and places of the objects are ours; the robot of the graded series is a free-flying sensor "
      "with a reach of 1.4 m. The series 'arm' has the camera in the hand of a simulated Comau SMART SiX and "
      "is judged by nothing. Motion is modelled.");
  return report;
}

void checkB1(const ExperimentOptions& options) {
  for (const RunOf& run : plannedRuns(options)) settingsOf(run, sceneOf(run), options.tune);
}

}  // namespace vantage::experiments
