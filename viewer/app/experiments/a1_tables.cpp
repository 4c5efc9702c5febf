#include <fmt/format.h>

#include "viewer/app/experiments/a1_runs.h"

namespace vantage::experiments {
namespace {

struct Totals {
  double scored = 0, finest = 0, visits = 0;
  explicit Totals(const RunResult& run) {
    for (const IterationResult& step : run.iterations) {
      scored += static_cast<double>(step.scored);
      finest += static_cast<double>(step.finest_rays);
      visits += static_cast<double>(step.visits);
    }
  }
};

/// Some view was more than dropped before its rays; otherwise its time is that of nothing.
bool castRays(const RunResult& run) {
  return Totals(run).scored > 0;
}

}  // namespace

std::string ObjectRuns::title() const {
  return fmt::format("{} {:.2f} m", object, size_m);
}

std::optional<double> ratio(std::optional<double> a, std::optional<double> b) {
  return a && b && *b > 0.0 ? std::optional(*a / *b) : std::nullopt;
}

std::string runsText(int runs) {
  return fmt::format("{} run{}", runs, runs == 1 ? "" : "s");
}

std::optional<double> percent(std::optional<double> share) {
  return share ? std::optional(100 * *share) : std::nullopt;
}

std::optional<double> timeShare(const ObjectRuns& set, const RunResult& run) {
  if (!castRays(set.uniform()) || run.iterations.empty()) return std::nullopt;
  return ratio(run.meanNbv_s(), set.uniform().meanNbv_s());
}

std::optional<double> cpuShare(const ObjectRuns& set, const RunResult& run) {
  if (!castRays(set.uniform()) || run.iterations.empty()) return std::nullopt;
  return ratio(run.meanCpu_s(), set.uniform().meanCpu_s());
}

std::optional<double> visitShare(const ObjectRuns& set, const RunResult& run) {
  const Totals ours(run), all(set.uniform());
  return ratio(ratio(ours.visits, ours.scored), ratio(all.visits, all.scored));
}

std::optional<double> finestShare(const RunResult& run) {
  const Totals totals(run);
  return ratio(totals.finest, totals.scored * static_cast<double>(run.rays_per_view));
}

std::optional<double> hiddenTimeShare(const ObjectRuns& set, const RunResult& run) {
  if (run.hidden.views == 0 || set.uniform().hidden.views == 0) return std::nullopt;
  return ratio(run.hidden.seconds, set.uniform().hidden.seconds);
}

std::optional<double> hiddenVisitShare(const ObjectRuns& set, const RunResult& run) {
  if (run.hidden.views == 0) return std::nullopt;
  return ratio(static_cast<double>(run.hidden.visits), static_cast<double>(set.uniform().hidden.visits));
}

std::optional<double> lostPoints(const ObjectRuns& set, const RunResult& run) {
  if (set.uniform().scans < 2 || !run.coverage || !(set.uniform().coverage.value_or(0.0) > 0.0))
    return std::nullopt;
  return 100 * (*set.uniform().coverage - *run.coverage);
}

std::optional<double> viewShare(const ObjectRuns& set, const RunResult& run) {
  if (set.uniform().scans < 2) return std::nullopt;
  return ratio(run.scans, set.uniform().scans);
}

std::optional<double> totalTimeShare(const ObjectRuns& set, const RunResult& run) {
  if (set.uniform().scans < 2 || run.iterations.empty()) return std::nullopt;
  return ratio(run.totalNbv_s(), set.uniform().totalNbv_s());
}

std::optional<double> literalStop(const RunResult& run) {
  return run.literal_stop > 0 ? std::optional<double>(run.literal_stop) : std::nullopt;
}

Table mainTable(const std::vector<ObjectRuns>& sets) {
  Table table{"a1",
              "A1: simulated reconstruction, uniform (m=0) against hierarchical ray tracing",
              {"object", "size m", "mode", "views", "NBV s/iter", "% of URT", "CPU % of URT", "visits %",
               "finest rays %", "hidden-view %", "hidden visits %", "coverage", "unknown left", "stop reason",
               "planning s", "accuracy mm", "95 % mm", "literal stop"},
              {}};
  for (const ObjectRuns& set : sets)
    for (const RunResult& run : set.runs) {
      const auto share = [](const std::optional<double>& value, int decimals) {
        return Cell::maybe(percent(value), decimals);
      };
      const auto millimetres = [](const std::optional<double>& metres) {
        return Cell::maybe(metres ? std::optional(1000 * *metres) : std::nullopt, 2);
      };
      table.rows.push_back(
          {set.object, Cell::number(set.size_m, 2), run.spec.label(), Cell::number(run.scans),
           Cell::number(run.meanNbv_s(), 4), share(timeShare(set, run), 1), share(cpuShare(set, run), 1),
           share(visitShare(set, run), 2), share(finestShare(run), 1), share(hiddenTimeShare(set, run), 2),
           share(hiddenVisitShare(set, run), 2), Cell::maybe(percent(run.coverage), 1, " %"),
           Cell::number(run.unknown_per_scan.empty() ? 0.0 : run.unknown_per_scan.back()), run.stop_reason,
           Cell::number(run.totalNbv_s(), 3), millimetres(run.accuracy_mean_m),
           millimetres(run.accuracy_95_m), Cell::maybe(literalStop(run))});
    }
  return table;
}

Table stepTable(const std::vector<ObjectRuns>& sets) {
  Table table{"a1_steps",
              "A1: every planning step",
              {"object", "size m", "mode", "step", "view", "gain", "NBV s", "scored", "rays", "finest rays",
               "visits", "unknown"},
              {}};
  for (const ObjectRuns& set : sets)
    for (const RunResult& run : set.runs)
      for (std::size_t n = 0; n < run.iterations.size(); ++n) {
        const IterationResult& step = run.iterations[n];
        const auto count = [](auto value) { return Cell::number(static_cast<double>(value)); };
        table.rows.push_back({set.object, Cell::number(set.size_m, 2), run.spec.label(), count(n + 1),
                              step.chosen < 0 ? Cell("-") : count(step.chosen), count(step.gain),
                              Cell::number(step.nbv_s, 5), count(step.scored), count(step.rays),
                              count(step.finest_rays), count(step.visits), count(step.unknown_voxels)});
      }
  return table;
}

}  // namespace vantage::experiments
