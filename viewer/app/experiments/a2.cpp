#include <fmt/format.h>

#include <optional>

#include "viewer/app/experiments/a1_runs.h"
#include "viewer/app/experiments/experiments.h"
#include "viewer/app/experiments/table_run.h"

namespace vantage::experiments {
namespace {

constexpr const char* kExpected = "expected, not a figure of the paper (D-A5)";

IterationResult firstStep(const RunResult& run) {
  return run.iterations.empty() ? IterationResult{} : run.iterations.front();
}

std::string innerText(const RunSpec& spec) {
  if (spec.coarse_levels == 0) return "-";
  return spec.inner == InnerRule::Mean ? "mean" : "max";
}

Table resultTable(const TableSetup& setup, const std::vector<RunResult>& runs) {
  Table table{
      "a2",
      fmt::format("A2: mean against maximum for inner nodes, m=2, {} {:.2f} m", setup.object, setup.size_m),
      {"inner", "mode", "occupied rays (step 1)", "unknown rays (step 1)", "other rays (step 1)", "views",
       "coverage", "unknown left", "stop reason", "NBV s/iter"},
      {}};
  for (const RunResult& run : runs) {
    const IterationResult first = firstStep(run);
    const double occupied = static_cast<double>(first.occupied_rays);
    const double unknown = static_cast<double>(first.unknown_rays);
    const double all = static_cast<double>(first.scored * run.rays_per_view);
    table.rows.push_back({innerText(run.spec), run.spec.label(), Cell::number(occupied),
                          Cell::number(unknown), Cell::number(all - occupied - unknown),
                          Cell::number(run.scans), Cell::maybe(percent(run.coverage), 1, " %"),
                          Cell::number(run.unknown_per_scan.empty() ? 0.0 : run.unknown_per_scan.back()),
                          run.stop_reason, Cell::number(run.meanNbv_s(), 4)});
  }
  return table;
}

std::string percentText(const std::optional<double>& share) {
  return share ? fmt::format("{:.1f} %", 100 * *share) : "not measured";
}

/// Lost hits of the mean in step 1, where both runs see the same map.
Claim lostHits(const RunResult& max, const RunResult& mean) {
  const auto kept = [&](std::uint64_t IterationResult::*rays) {
    return ratio(static_cast<double>(firstStep(mean).*rays), static_cast<double>(firstStep(max).*rays));
  };
  const std::optional<double> occupied = kept(&IterationResult::occupied_rays);
  return {"A2 (1)",
          "the mean loses occupied hits in step 1",
          "-",
          occupied ? percentText(occupied) + " of max" : "nothing was measured",
          occupied ? passIf(*occupied < 1.0) : Verdict::NotRun,
          fmt::format("{}; unknown rays of max: {}: rims that are free in part read free, and rays that pass "
                      "them can reach the surface behind",
                      kExpected, percentText(kept(&IterationResult::unknown_rays)))};
}

/// More views or less coverage. Of runs that were cut off only what more steps could not change counts.
Claim worseEnd(const RunResult& max, const RunResult& mean) {
  Claim claim{"A2 (2)",
              "the mean needs more views or ends with less coverage",
              "-",
              "nothing was measured",
              Verdict::NotRun,
              kExpected};
  if (max.iterations.empty() || mean.iterations.empty() || !max.coverage || !mean.coverage) return claim;
  claim.ours = fmt::format("{} and {}, max {} and {}", mean.scans, percentText(mean.coverage), max.scans,
                           percentText(max.coverage));
  const bool more_views = mean.scans > max.scans;
  claim.verdict = passIf(more_views || *mean.coverage < *max.coverage);
  if ((max.cut_off || mean.cut_off) && !(more_views && !max.cut_off)) {
    claim.verdict = Verdict::NotComparable;
    claim.remark += fmt::format("; cut off before the end: {}", max.cut_off && mean.cut_off ? "both"
                                                                : max.cut_off               ? "max"
                                                                                            : "mean");
  }
  return claim;
}

/// Defaults as A2 uses them.
std::vector<DefaultUsed> defaultsOf(const TableSetup& setup, const ExperimentOptions& options) {
  std::vector<DefaultUsed> defaults = defaultsUsed(setup.settings, "A2", true);
  setDefault(defaults, "coarse levels m", "0, 2");
  setDefault(defaults, "children of rays", "resume");
  setDefault(defaults, "inner nodes", "max and mean");
  defaults.push_back(sizesUsed({meanObject(options)}, "A2"));
  return defaults;
}

}  // namespace

std::pair<ObjectSource, double> meanObject(const ExperimentOptions& options) {
  return {options.meshes.empty() ? compactStandIn() : options.meshes.front(), options.sizes_m.front()};
}

void checkA2(const ExperimentOptions& options) {
  const auto [source, size_m] = meanObject(options);
  tableSettings(sceneOnTable(source, size_m), options.max_steps, options.tune);
}

Report runA2(const ExperimentOptions& options) {
  const auto [source, size_m] = meanObject(options);
  Report report;
  std::vector<RunResult> runs;
  std::optional<TableSetup> setup;
  try {
    options.control.check();
    setup.emplace(setUpTable(source, size_m, options.max_steps, options.tune));
    for (const RunSpec& spec :
         {RunSpec{.coarse_levels = 0}, RunSpec{.coarse_levels = 2, .inner = InnerRule::Max},
          RunSpec{.coarse_levels = 2, .inner = InnerRule::Mean}}) {
      runs.push_back(runOnTable(*setup, spec, options.repeats, options.control));
      options.say(fmt::format("A2 {}: {} views, coverage {}, {}", spec.label(), runs.back().scans,
                              percentText(runs.back().coverage), runs.back().stop_reason));
    }
  } catch (const Cancelled&) {
    report.not_run.push_back(fmt::format("A2 ({} of 3 runs finished)", runs.size()));
  }
  if (runs.empty()) return report;
  report.defaults = defaultsOf(*setup, options);
  report.tables = {resultTable(*setup, runs)};
  if (runs.size() == 3) report.claims = {lostHits(runs[1], runs[2]), worseEnd(runs[1], runs[2])};
  LinePlot unknown{"A2: unknown voxels in the object's box", "scan", "unknown voxels", {}};
  for (const RunResult& run : runs) unknown.series.push_back({run.spec.label(), run.unknown_per_scan});
  report.lines = {std::move(unknown)};
  report.notes = {
      "A2: other rays leave the box or end outside it, or, with the mean, pass coarse nodes that read "
      "free although something is in them."};
  return report;
}

}  // namespace vantage::experiments
