#include <fmt/format.h>

#include <algorithm>

#include "viewer/app/experiments/experiments.h"
#include "viewer/app/experiments/table_run.h"

namespace vantage::experiments {
namespace {

Table resultTable(const TableSetup& setup, const std::vector<RunResult>& runs) {
  Table table{
      "a2",
      fmt::format("A2: mean against maximum for inner nodes, m=2, {} {:.2f} m", setup.object, setup.size_m),
      {"inner", "mode", "occupied rays (step 1)", "unknown rays (step 1)", "other rays (step 1)", "views",
       "coverage", "unknown left", "stop reason", "NBV s/iter"},
      {}};
  for (const RunResult& run : runs) {
    const IterationResult& first = run.iterations.at(0);
    const double occupied = static_cast<double>(first.occupied_rays);
    const double unknown = static_cast<double>(first.unknown_rays);
    const double all = static_cast<double>(first.scored * run.rays_per_view);
    table.rows.push_back({run.spec.coarse_levels == 0         ? "-"
                          : run.spec.inner == InnerRule::Mean ? "mean"
                                                              : "max",
                          run.spec.label(), Cell::number(occupied), Cell::number(unknown),
                          Cell::number(all - occupied - unknown), Cell::number(run.scans),
                          Cell::number(100 * run.coverage, 1, " %"),
                          Cell::number(run.unknown_per_scan.back()), run.stop_reason,
                          Cell::number(run.meanNbv_s(), 4)});
  }
  return table;
}

Claim expectation(const std::string& number, const std::string& what, const std::string& ours, bool met) {
  return {"A2 " + number, what, "-", ours, passIf(met), "expected, not a figure of the paper (D-A5)"};
}

}  // namespace

Report runA2(const ExperimentOptions& options) {
  const auto [source, size_m] = tableObjects(options).front();
  const TableSetup setup = setUpTable(source, size_m, options.max_steps, options.tune);
  std::vector<RunResult> runs;
  for (const RunSpec& spec :
       {RunSpec{.coarse_levels = 0}, RunSpec{.coarse_levels = 2, .inner = InnerRule::Max},
        RunSpec{.coarse_levels = 2, .inner = InnerRule::Mean}}) {
    runs.push_back(runOnTable(setup, spec, options.repeats, options.control));
    options.say(fmt::format("A2 {}: {} views, coverage {:.1f} %, {}", spec.label(), runs.back().scans,
                            100 * runs.back().coverage, runs.back().stop_reason));
  }
  const RunResult &max = runs[1], &mean = runs[2];
  const double kept = static_cast<double>(mean.iterations.at(0).occupied_rays) /
                      std::max<double>(1.0, static_cast<double>(max.iterations.at(0).occupied_rays));
  const double unknown_kept = static_cast<double>(mean.iterations.at(0).unknown_rays) /
                              std::max<double>(1.0, static_cast<double>(max.iterations.at(0).unknown_rays));
  Report report;
  report.defaults = defaultsUsed(setup.settings);
  report.tables = {resultTable(setup, runs)};
  report.claims = {expectation("(1)", "the mean loses occupied hits in step 1",
                               fmt::format("{:.1f} % of max", 100 * kept), kept < 1.0),
                   expectation("(2)", "the mean needs more views or ends with less coverage",
                               fmt::format("{} and {:.1f} %, max {} and {:.1f} %", mean.scans,
                                           100 * mean.coverage, max.scans, 100 * max.coverage),
                               mean.scans > max.scans || mean.coverage < max.coverage)};
  report.claims[0].remark += fmt::format(
      "; unknown rays {:.1f} % of max: rims that are free in part read free, and rays that pass "
      "them can reach the surface behind",
      100 * unknown_kept);
  LinePlot unknown{"A2: unknown voxels in the object's box", "scan", "unknown voxels", {}};
  for (const RunResult& run : runs) unknown.series.push_back({run.spec.label(), run.unknown_per_scan});
  report.lines = {std::move(unknown)};
  report.notes = {
      "A2: other rays leave the box or end outside it, or, with the mean, pass coarse nodes that read "
      "free although something is in them."};
  return report;
}

}  // namespace vantage::experiments
