// Many runs one after the other, with what was kept of an earlier call.
#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "viewer/app/experiments/b1_report.h"
#include "viewer/app/experiments/experiments.h"

namespace vantage::experiments {
namespace {

/// Tells after each run how long the others will take, by the mean of those that were made now.
class Progress {
 public:
  Progress(std::string experiment, std::size_t runs) : experiment_(std::move(experiment)), left_(runs) {}
  std::string after(const ExplorationRun& run, bool kept, double seconds) {
    --left_;
    if (!kept) {
      sum_s_ += seconds;
      ++made_;
    }
    const double wait_s = made_ == 0 ? 0.0 : static_cast<double>(left_) * sum_s_ / made_;
    const std::string time = made_ == 0 || left_ == 0 ? fmt::format("; {} left", left_)
                             : wait_s < 120
                                 ? fmt::format("; {} left, about {:.0f} s", left_, wait_s)
                                 : fmt::format("; {} left, about {:.0f} min", left_, wait_s / 60.0);
    return fmt::format("{} {}: {} ticks, U_tau {:.0f} -> {:.0f}, {}{}", experiment_, run.run.text(),
                       run.ticks(), run.unknown_near_objects.front(), run.unknown_near_objects.back(),
                       kept ? "kept from before" : fmt::format("{:.0f} s", seconds), time);
  }

 private:
  std::string experiment_;
  std::size_t left_;
  double sum_s_ = 0.0, made_ = 0.0;
};

}  // namespace

Runs exploreAll(const std::string& experiment, const std::vector<RunOf>& planned,
                const ExperimentOptions& options, Report& report) {
  const KeptRuns kept(options.keep, options.program);
  Progress progress(experiment, planned.size());
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
      report.not_run.push_back(
          fmt::format("{} ({} of {} runs)", experiment, planned.size() - i, planned.size()));
      break;
    }
  }
  return runs;
}

}  // namespace vantage::experiments
