#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "io/config_file.h"
#include "io/text_file.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/app/experiments/experiments.h"

namespace vantage::app {
namespace {

using experiments::ExperimentOptions;
using experiments::Report;
using experiments::UpAxis;

struct ReproduceOptions {
  std::string experiment, output, dataset, up = "z";
  std::vector<std::string> meshes;
  std::vector<double> sizes_m = {0.20, 0.35};
  bool quick = false;
};

UpAxis upAxis(const std::string& name) {
  return name == "x" ? UpAxis::X : name == "y" ? UpAxis::Y : UpAxis::Z;
}

/// The command line's part of the configuration; the user's own file is left out, so that results compare.
void tune(Settings& settings, const GlobalOptions& global) {
  for (const std::string& file : global.config_files) applyTomlFile(settings, file);
  for (const std::string& assignment : global.assignments) applyAssignment(settings, assignment);
  if (global.seed) applyAssignment(settings, fmt::format("exploration.seed={}", *global.seed), "--seed");
}

ExperimentOptions experimentOptions(const GlobalOptions& global, const ReproduceOptions& options,
                                    Console& console) {
  ExperimentOptions result;
  result.quick = options.quick;
  for (const double size_m : options.sizes_m)
    if (!(size_m >= 0.02 && size_m <= 0.6))
      throw InputError(fmt::format("--sizes {}", size_m), "objects of 0.02 to 0.6 m fit on the table");
  result.sizes_m = options.sizes_m;
  for (const std::string& mesh : options.meshes)
    result.meshes.push_back(experiments::meshObject(mesh, upAxis(options.up)));
  result.dataset = options.dataset;
  result.max_steps = options.quick ? 6 : 20;
  result.tune = [&global](Settings& settings) { tune(settings, global); };
  result.say = [&global, &console](const std::string& line) {
    console.clear();
    say(global, line);
  };
  result.control = console.control();
  return result;
}

void requireFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!std::filesystem::is_directory(path))
    throw InputError("-o " + path, "is no folder and cannot be made one; choose another name");
  requireCreatable(std::filesystem::path(path) / "report.html");
}

Report runAll(const std::string& experiment, const ExperimentOptions& options) {
  const bool all = experiment == "all";
  Report report;
  std::vector<double> seconds_per_view;
  const auto add = [&](Report part) {
    if (!report.defaults.empty()) part.defaults.clear();
    report.append(std::move(part));
  };
  if (all || experiment == "A1") add(runA1(options, seconds_per_view));
  if (all || experiment == "A2") add(runA2(options));
  if (all || experiment == "A3") add(runA3(options, seconds_per_view));
  return report;
}

int reproduce(const GlobalOptions& global, const ReproduceOptions& options) {
  requireFolder(options.output);
  Console console(global);
  const ExperimentOptions chosen = experimentOptions(global, options, console);
  Report report;
  try {
    report = runAll(options.experiment, chosen);
  } catch (const Cancelled&) {
    throw Interrupted(options.output + ": interrupted; nothing was written");
  }
  console.clear();
  report.title = "Reproduction of experiment" +
                 std::string(options.experiment == "all" ? "s A1, A2, A3" : " ") +
                 (options.experiment == "all" ? "" : options.experiment) + (options.quick ? " (quick)" : "");
  report.setup = experiments::machineText();
  report.setup.push_back(versionText(false));
  report.setup.push_back("command: " + global.command_line);
  for (const std::string& line : report.setup) say(global, line);
  for (const experiments::Table& table : report.tables)
    if (table.name != "a1_steps") say(global, "\n" + experiments::tableText(table));
  say(global, experiments::summaryText(report));
  const auto files = experiments::writeReport(report, options.output);
  say(global, fmt::format("{} files in {}", files.size(), options.output));
  if (global.json == "-")
    fmt::print("{}", experiments::reportJson(report));
  else if (!global.json.empty())
    saveFile(global.json, experiments::reportJson(report));
  return 0;
}

}  // namespace

void addReproduce(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto o = std::make_shared<ReproduceOptions>();
  CLI::App* command =
      app.add_subcommand("reproduce", "Run the experiments of the papers and print their tables");
  command
      ->add_option("experiment", o->experiment,
                   "A1: uniform against hierarchical ray tracing; A2: mean "
                   "against maximum; A3: evaluation rate")
      ->required()
      ->check(CLI::IsMember({"A1", "A2", "A3", "all"}));
  command->add_option("-o,--output", o->output, "Folder for CSV, JSON and one HTML page")
      ->required()
      ->type_name("DIR");
  command->add_flag("--quick", o->quick, "One object, one size, fewer modes and steps");
  command
      ->add_option("--mesh", o->meshes, "Also on this object (PLY, OBJ, STL); with --quick instead of ours")
      ->type_name("FILE");
  command->add_option("--up", o->up, "Axis of the meshes that points up")
      ->check(CLI::IsMember({"x", "y", "z"}));
  command->add_option("--sizes", o->sizes_m, "Largest extents of the objects, metres (default: 0.20,0.35)")
      ->delimiter(',')
      ->type_name("M,M");
  command->add_option("--dataset", o->dataset, "Recorded sequence for A3")->type_name("DIR");
  command->footer("Example: vantage reproduce A1 --quick -o reproduction");
  command->callback([&global, &action, o] { action = [&global, o] { return reproduce(global, *o); }; });
}

}  // namespace vantage::app
