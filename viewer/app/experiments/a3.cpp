#include <fmt/format.h>

#include <numeric>

#include "viewer/app/experiments/a3_runs.h"
#include "viewer/app/experiments/table_run.h"

namespace vantage::experiments {
namespace {

Table phaseTable(const std::vector<RateSet>& sets, int repeats) {
  Table table{"a3",
              fmt::format("A3: evaluation rate with views drawn in the workspace, means per step; evaluate: "
                          "median of {}, scan, update and path: measured once a step",
                          std::max(repeats, 1)),
              {"input", "seeds", "scan s", "update s", "evaluate s", "per view ms", "path s", "total s",
               "evaluate +-", "candidates", "scored", "rejected pos", "rejected reg", "scans",
               "unknown (OBB) per scan, first seed", "stop reason"},
              {}};
  table.rows.push_back({"paper (real fan)", "-", Cell::number(0.1, 4), Cell::number(6.3, 4),
                        Cell::number(10.3, 4), Cell::number(6.9, 4), Cell::number(0.3, 4),
                        Cell::number(17.0, 4), "-", Cell::number(1500), "-", "-", "-", Cell::number(7), "-",
                        "-"});
  for (const RateSet& set : sets) {
    const auto phase = [&](double Phases::*member) {
      return Cell::number(set.spread([&](const RateRun& run) { return run.mean().*member; }).mean, 4);
    };
    const auto average = [&](double RateRun::*member) {
      return Cell::number(set.spread([&](const RateRun& run) { return run.*member; }).mean);
    };
    std::string unknown;
    for (const double voxels : set.runs.front().unknown_per_scan)
      unknown += fmt::format("{}{:.0f}", unknown.empty() ? "" : " ", voxels);
    const std::optional<Spread> per_view = set.perView_ms();
    table.rows.push_back(
        {set.name, Cell::number(static_cast<double>(set.runs.size())), phase(&Phases::scan),
         phase(&Phases::update), phase(&Phases::evaluate),
         Cell::maybe(per_view ? std::optional(per_view->mean) : std::nullopt, 4), phase(&Phases::path),
         Cell::number(set.spread([](const RateRun& run) { return run.mean().total(); }).mean, 4),
         Cell::maybe(set.evaluate_s().deviation, 4), average(&RateRun::candidates), average(&RateRun::scored),
         average(&RateRun::rejected_position), average(&RateRun::rejected_registration),
         Cell::number(static_cast<double>(set.fewestScans())), unknown, set.runs.front().stop_reason});
  }
  return table;
}

/// Mean time of a candidate in A1, or in one run like those of A1 where there was none.
Yardstick yardstick(const ExperimentOptions& options, const std::vector<double>& seconds_per_view) {
  if (!seconds_per_view.empty())
    return {std::accumulate(seconds_per_view.begin(), seconds_per_view.end(), 0.0) /
                static_cast<double>(seconds_per_view.size()),
            fmt::format("mean of its {} run{} with m=2 resume", seconds_per_view.size(),
                        seconds_per_view.size() == 1 ? "" : "s")};
  options.control.check();
  const auto [source, size_m] = tableObjects(options).front();
  const TableSetup setup = setUpTable(source, size_m, std::min(options.max_steps, 5), options.tune);
  const RunResult run = runOnTable(setup, {.coarse_levels = 2}, options.repeats, options.control);
  const double seconds = run.secondsPerCandidate();
  return {seconds > 0.0 ? std::optional(seconds) : std::nullopt,
          fmt::format("was not run, instead {} steps of {} {:.2f} m, {}", run.iterations.size(), setup.object,
                      size_m, run.spec.label())};
}

std::string line(const RateSet& set, std::uint64_t seed) {
  const RateRun& run = set.runs.back();
  const std::optional<double> per_view = run.secondsPerView();
  return fmt::format("A3 {}, seed {}: {} scans, evaluation {:.4f} s{}, {}", set.name, seed + 1,
                     run.unknown_per_scan.size(), run.mean().evaluate,
                     per_view ? fmt::format(" ({:.4f} ms per view)", 1e3 * *per_view) : "", run.stop_reason);
}

/// All runs, seed by seed. \param defaults by set
void measure(const ExperimentOptions& options, std::vector<RateSet>& sets,
             std::vector<std::vector<DefaultUsed>>& defaults, Report& report) {
  const std::uint64_t seeds = options.quick ? 1 : 5;
  const auto run = [&](std::size_t n, std::uint64_t seed) {
    options.control.check();
    RateSet& set = sets[n];
    set.runs.push_back(set.name == "room" ? runRoom(options, seed, defaults[n])
                                          : runReplay(options, seed, defaults[n]));
    options.say(line(set, seed));
  };
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (std::size_t n = 0; n < sets.size(); ++n) {
      try {
        run(n, seed);
      } catch (const Cancelled&) {
        report.not_run.push_back(fmt::format("A3 {}, seed {}", sets[n].name, seed + 1));
      }
      if (sets[n].runs.empty()) defaults[n].clear();
    }
  std::erase_if(sets, [](const RateSet& set) { return set.runs.empty(); });
}

void addPlots(const std::vector<RateSet>& sets, Report& report) {
  for (const RateSet& set : sets) {
    LinePlot unknown{"A3: unknown voxels in the object's box, " + set.name, "scan", "unknown voxels", {}};
    for (std::size_t n = 0; n < set.runs.size(); ++n)
      unknown.series.push_back({fmt::format("seed {}", n + 1), set.runs[n].unknown_per_scan});
    report.lines.push_back(std::move(unknown));
  }
}

}  // namespace

Report runA3(const ExperimentOptions& options, const std::vector<double>& seconds_per_view) {
  checkA3(options);
  Report report;
  std::vector<RateSet> sets = {{"room", {}}};
  if (options.dataset.empty())
    report.notes.push_back("A3: the replay was skipped, no recorded sequence was given (--dataset DIR).");
  else
    sets.push_back({"replay", {}});
  std::vector<std::vector<DefaultUsed>> defaults(sets.size());
  measure(options, sets, defaults, report);
  if (sets.empty()) return report;

  Yardstick a1{std::nullopt, "not run, interrupted"};
  try {
    a1 = yardstick(options, seconds_per_view);
  } catch (const Cancelled&) {
    report.not_run.push_back("A3 (1): time per view of A1");
  }
  for (const RateSet& set : sets) judgeRates(set, a1, report);
  for (std::vector<DefaultUsed>& used : defaults) {
    Report part;
    part.defaults = std::move(used);
    report.append(std::move(part));
  }
  addPlots(sets, report);
  report.tables = {phaseTable(sets, options.repeats)};
  report.notes.push_back(
      "A3: the office fan and the mobile robot are replaced by a simulated furnished room and by recorded "
      "data; times of the paper are another machine's.");
  report.notes.push_back(
      "A3: an evaluation that takes less than a second is repeated, and the median counts. A scan and an "
      "update change what the next one would find, and a path follows from them: they are measured once.");
  return report;
}

}  // namespace vantage::experiments
