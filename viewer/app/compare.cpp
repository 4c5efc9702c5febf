#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/csv_table.h"
#include "io/run_file.h"
#include "io/text_file.h"
#include "snapshots/comparison.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/inputs.h"
#include "viewer/app/json_output.h"

namespace vantage::app {
namespace {

using Json = nlohmann::ordered_json;

struct CompareOptions {
  std::vector<std::string> runs;
  std::string output, picture;
};

/// What a run knew and did at a step, in units that do not depend on its voxels.
struct ComparedStep {
  int step = 0;
  std::size_t run = 0;
  std::string planner;
  std::optional<double> unknown_near_objects_dm3, unknown_in_boxes_dm3, coverage;
  std::optional<double> nbv_s;  ///< choosing the view, without motion planning
  std::optional<std::uint64_t> rays;
  std::optional<double> path_m;  ///< empty: no view
};

ComparedStep compared(const RunHeader& header, const StepRecord& record, int step, std::size_t run) {
  const double edge_dm = measuredMap(header).voxel_size_m * 10.0, voxel_dm3 = edge_dm * edge_dm * edge_dm;
  const auto volume = [&](const std::optional<std::uint64_t>& voxels) {
    return voxels ? std::optional(static_cast<double>(*voxels) * voxel_dm3) : std::nullopt;
  };
  const Timings& t = record.timings;
  ComparedStep row;
  row.step = step;
  row.run = run;
  if (!record.closing) row.planner = record.planner;
  row.unknown_near_objects_dm3 = volume(record.metrics.unknown_near_objects);
  row.unknown_in_boxes_dm3 = volume(record.metrics.unknown_in_boxes);
  row.coverage = record.metrics.coverage;
  for (const auto& phase : {t.contours, t.surface, t.segmentation, t.saliency, t.generation, t.evaluation})
    if (phase) row.nbv_s = row.nbv_s.value_or(0.0) + *phase;
  if (const SearchCounts* counts = record.counts()) row.rays = counts->rays;
  if (const ChosenView* chosen = record.chosen()) row.path_m = chosen->path.length_m;
  return row;
}

struct Comparison {
  std::vector<ComparedStep> rows;
  std::vector<std::string> notes;  ///< differencesOf()
};

Comparison compareRuns(const std::vector<std::string>& paths) {
  std::vector<RunHeader> headers;
  Comparison result;
  std::vector<ComparedStep>& rows = result.rows;
  for (const std::string& path : paths) {
    const RunReader run(path);
    headers.push_back(run.header());
    const std::size_t n = headers.size() - 1;
    for (const int step : run.steps())
      rows.push_back(compared(headers[n], run.step(step, RunDetail::NoVolume), step, n));
    if (run.hasClosing())
      rows.push_back(compared(headers[n], run.closing(RunDetail::NoVolume), run.closingStep(), n));
  }
  requireOneScene(paths, headers);
  std::ranges::stable_sort(rows, {}, [](const ComparedStep& r) { return std::pair(r.step, r.run); });
  result.notes = differencesOf(headers);
  return result;
}

template <class T>
std::string cell(const std::optional<T>& value, fmt::format_string<T> format) {
  return value ? fmt::format(format, T{*value}) : "";
}

CsvTable csv(const std::vector<ComparedStep>& rows, const std::vector<std::string>& paths) {
  CsvTable table("step,run,planner,coverage,unknown_near_objects_dm3,unknown_in_boxes_dm3,nbv_s,rays,path_m");
  for (const ComparedStep& r : rows)
    table.cell(r.step)
        .cell(paths[r.run])
        .cell(r.planner)
        .cell(r.coverage)
        .cell(r.unknown_near_objects_dm3)
        .cell(r.unknown_in_boxes_dm3)
        .cell(r.nbv_s)
        .cell(r.rays)
        .cell(r.path_m)
        .endRow();
  return table;
}

std::string table(const std::vector<ComparedStep>& rows) {
  std::string text = "step run planner        coverage  unknown near objects     NBV        rays    path\n";
  for (const ComparedStep& r : rows)
    text += fmt::format("{:>4} {:>3} {:<13} {:>9}  {:>20} {:>7} {:>11} {:>7}\n", r.step, r.run + 1,
                        r.planner.empty() ? "(last map)" : r.planner,
                        r.coverage ? fmt::format("{:.1f} %", *r.coverage * 100) : "-",
                        cell(r.unknown_near_objects_dm3, "{:.3f} dm3"), cell(r.nbv_s, "{:.3f} s"),
                        cell(r.rays, "{}"), cell(r.path_m, "{:.2f} m"));
  return text;
}

Json toJson(const Comparison& comparison, const std::vector<std::string>& paths) {
  const auto orNull = [](const auto& value) { return value ? Json(*value) : Json(nullptr); };
  Json all = Json::array();
  for (const ComparedStep& r : comparison.rows)
    all.push_back({{"step", r.step},
                   {"run", paths[r.run]},
                   {"planner", r.planner},
                   {"coverage", orNull(r.coverage)},
                   {"unknown_near_objects_dm3", orNull(r.unknown_near_objects_dm3)},
                   {"unknown_in_boxes_dm3", orNull(r.unknown_in_boxes_dm3)},
                   {"nbv_s", orNull(r.nbv_s)},
                   {"rays", orNull(r.rays)},
                   {"path_m", orNull(r.path_m)}});
  return {{"runs", paths}, {"notes", comparison.notes}, {"steps", all}};
}

void takePicture(const GlobalOptions& global, const CompareOptions& options) {
  Console console(global);
  ComparisonRequest request;
  request.output = options.picture;
  const auto files = takeComparison(options.runs[0], options.runs[1], request, console.control());
  console.clear();
  for (const auto& file : files) say(global, file.string());
}

/// What cannot be compared or written is said before the work.
void checkOptions(const GlobalOptions& global, const CompareOptions& options) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const std::string& run : options.runs) {
    if (std::ranges::any_of(files, [&](const auto& other) { return sameFile(other.second, run); }))
      throw InputError(run, "is named twice; compare different runs");
    files.emplace_back("RUN", run);
  }
  files.emplace_back("-o", options.output);
  files.emplace_back("--json", global.json);
  files.emplace_back("--picture", options.picture);
  requireDistinctFiles(files);
  if (!options.output.empty() && options.output != "-") requireCreatable(options.output);
  if (options.picture.empty()) return;
  if (options.runs.size() != 2)
    throw InputError("--picture",
                     fmt::format("shows two runs side by side; {} were given", options.runs.size()));
  requireEnding("--picture", options.picture, {".png"});
  requireCreatable(options.picture);
}

int compare(const GlobalOptions& global, const CompareOptions& options) {
  checkOptions(global, options);
  const Comparison comparison = compareRuns(options.runs);
  if (options.output != "-" && global.json != "-") {
    for (std::size_t n = 0; n < options.runs.size(); ++n)
      say(global, fmt::format("run {}: {}", n + 1, options.runs[n]));
    say(global, table(comparison.rows));
    for (const std::string& note : comparison.notes) say(global, "note: " + note);
  }
  if (!options.output.empty()) csv(comparison.rows, options.runs).save(options.output);
  writeJson(global.json, toJson(comparison, options.runs));
  if (!options.picture.empty()) takePicture(global, options);
  return 0;
}

}  // namespace

void addCompare(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto o = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare", "Runs of one scene beside each other, step by step");
  command->add_option("runs", o->runs, "Run files, two or more")
      ->required()
      ->expected(2, 16)
      ->type_name("RUN");
  command->add_option("-o,--output", o->output, "The table, CSV")->type_name("TABLE.csv");
  command->add_option("--picture", o->picture, "Both runs side by side, a row a step (two runs)")
      ->type_name("SHEET.png");
  command->footer("Example: vantage compare contour.vantage hierarchical.vantage -o steps.csv");
  command->callback([&global, &action, o] { action = [&global, o] { return compare(global, *o); }; });
}

}  // namespace vantage::app
