// B1: exploration of four tabletop scenes by the contour-based planner and the standard baseline.
#include <fmt/format.h>

#include <chrono>

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
    add(Series::Core, 1, {"tabletop"});
    return runs;
  }
  add(Series::Core, options.seeds.value_or(5), kScenes);
  for (const Series series : {Series::Open, Series::Filtered, Series::Exact})
    add(series, options.seeds.value_or(1), kScenes);
  add(Series::Unseen, options.seeds.value_or(1), {"unseen_kitchen", "unseen_workshop"});
  return runs;
}

/// Tells after each run how long the others will take, by the mean of those that were made now.
class Progress {
 public:
  explicit Progress(std::size_t runs) : left_(runs) {}
  std::string after(const ExplorationRun& run, bool kept, double seconds) {
    --left_;
    if (!kept) {
      sum_s_ += seconds;
      ++made_;
    }
    const std::string time = made_ == 0 ? ""
                                        : fmt::format("; {} left, about {:.0f} min", left_,
                                                      static_cast<double>(left_) * sum_s_ / made_ / 60.0);
    return fmt::format("B1 {}: {} ticks, U_tau {:.0f} -> {:.0f}, {}{}", run.run.text(), run.ticks(),
                       run.unknown_near_objects.front(), run.unknown_near_objects.back(),
                       kept ? "kept from before" : fmt::format("{:.0f} s", seconds), time);
  }

 private:
  std::size_t left_;
  double sum_s_ = 0.0, made_ = 0.0;
};

Runs explore(const ExperimentOptions& options, Report& report) {
  const KeptRuns kept(options.keep, options.program);
  const std::vector<RunOf> planned = plannedRuns(options);
  Progress progress(planned.size());
  Runs runs;
  for (std::size_t i = 0; i < planned.size(); ++i) {
    const auto start = std::chrono::steady_clock::now();
    try {
      options.control.check();
      std::optional<ExplorationRun> run = kept.find(planned[i], options.tune);
      const bool found = run.has_value();
      if (!found) {
        run = runExploration(planned[i], options.tune, options.control);
        kept.keep(*run, options.tune);
      }
      runs.push_back(std::move(*run));
      options.say(
          progress.after(runs.back(), found,
                         std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()));
    } catch (const Cancelled&) {
      report.not_run.push_back(fmt::format("B1: {} of {} runs", planned.size() - i, planned.size()));
      break;
    }
  }
  return runs;
}

}  // namespace

Report runB1(const ExperimentOptions& options) {
  Report report;
  const Runs runs = explore(options, report);
  if (runs.empty()) return report;
  report.tables = {nbvTable(runs), runTable(runs), phaseTable(runs), segmentTable(runs), tickTable(runs)};
  report.lines = unknownPlots(runs);
  judgeB1(runs, report);
  report.notes.push_back(
      "B1: sizes and places of the objects are ours, and so are gain threshold, segmentation's constants and "
      "the scan; "
      "the robot is a free-flying sensor with a reach of 1.4 m, its motion is modelled.");
  return report;
}

void checkB1(const ExperimentOptions& options) {
  for (const RunOf& run : plannedRuns(options)) settingsOf(run, sceneOf(run), options.tune);
}

}  // namespace vantage::experiments
