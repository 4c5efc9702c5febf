#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "io/config_file.h"
#include "io/dataset.h"
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
  std::vector<std::string> experiments, meshes;
  std::string output, dataset, up;
  std::vector<double> sizes_m;
  std::optional<std::uint64_t> seeds;
  bool quick = false;
};

const std::vector<std::string> kExperiments = {"A1", "A2", "A3", "B1", "B2", "B3", "B4"};

/// What the user chose, in the order in which it runs: A1 first, since A3 compares with it.
struct Choice {
  std::vector<std::string> names;

  explicit Choice(const std::vector<std::string>& asked) {
    const auto isAsked = [&](const std::string& name) {
      return std::ranges::find(asked, name) != asked.end();
    };
    for (const std::string& name : kExperiments)
      if (isAsked(name) || isAsked("all")) names.push_back(name);
  }
  bool has(const std::string& name) const { return std::ranges::find(names, name) != names.end(); }
  std::string text() const { return fmt::format("{}", fmt::join(names, ", ")); }
};

/// Refuses options that would change nothing.
void requireEffect(const GlobalOptions& global, const Choice& choice, const ReproduceOptions& o) {
  const auto refuse = [&](const char* option, const std::string& why) { throw InputError(option, why); };
  if (!o.dataset.empty() && !choice.has("A3"))
    refuse("--dataset", "is used by A3 alone; add A3 or leave the option out");
  if (o.seeds && !choice.has("B1") && !choice.has("B2"))
    refuse("--seeds", "counts the runs of B1 and B2; add one of them or leave the option out");
  if (!o.up.empty() && o.meshes.empty())
    refuse("--up", "turns meshes; add --mesh FILE or leave the option out");
  if (choice.names == std::vector<std::string>{"B4"} &&
      !(global.assignments.empty() && global.config_files.empty()))
    refuse(global.assignments.empty() ? "--config" : "--set",
           "changes nothing: the scene and the filter of B4 are exact; leave the option out");
  if (choice.has("A1")) return;
  const std::size_t most = choice.has("A2") ? 1 : 0;
  const std::string why = choice.has("A2") ? "A2 takes one; give one or add A1"
                                           : choice.text() + " has scenes of its own; add A1 or A2";
  if (o.meshes.size() > most) refuse("--mesh", why);
  if (o.sizes_m.size() > most) refuse("--sizes", why);
}

UpAxis upAxis(const std::string& name) {
  return name == "x" ? UpAxis::X : name == "y" ? UpAxis::Y : UpAxis::Z;
}

/// The command line's part of the configuration; the user's own file is left out, so that results compare.
void tune(Settings& settings, const GlobalOptions& global) {
  for (const std::string& file : global.config_files) applyTomlFile(settings, file);
  for (const std::string& assignment : global.assignments) applyAssignment(settings, assignment);
  if (global.seed) applyAssignment(settings, fmt::format("exploration.seed={}", *global.seed), "--seed");
}

std::vector<double> sizesOf(const ReproduceOptions& options) {
  for (const double size_m : options.sizes_m)
    if (!(size_m >= 0.02 && size_m <= 0.6))
      throw InputError(fmt::format("--sizes {}", size_m), "objects of 0.02 to 0.6 m fit on the table");
  if (!options.sizes_m.empty()) return options.sizes_m;
  return options.quick ? std::vector{0.20} : std::vector{0.20, 0.35};
}

/// This build of the program: what another one made is not taken over.
std::string programText() {
  std::error_code error;
  const auto built = std::filesystem::last_write_time("/proc/self/exe", error);
  return versionText(false) + (error ? "" : std::to_string(built.time_since_epoch().count()));
}

ExperimentOptions experimentOptions(const GlobalOptions& global, const ReproduceOptions& options,
                                    Console& console) {
  ExperimentOptions result;
  result.quick = options.quick;
  result.sizes_m = sizesOf(options);
  for (const std::string& mesh : options.meshes)
    result.meshes.push_back(experiments::meshObject(mesh, upAxis(options.up)));
  result.dataset = options.dataset;
  result.max_steps = options.quick ? 6 : 20;  // 20: section 8 of the hierarchical specification
  result.tune = [&global](Settings& settings) { tune(settings, global); };
  result.say = [&global, &console](const std::string& line) {
    console.clear();
    say(global, line);
  };
  result.control = console.control();
  result.seeds = options.seeds;
  result.keep = std::filesystem::path(options.output) / "runs";
  result.program = programText();
  return result;
}

void requireFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!std::filesystem::is_directory(path))
    throw InputError("-o " + path, "is no folder and cannot be made one; choose another name");
  requireCreatable(std::filesystem::path(path) / "report.html");
}

/// What can be refused is refused before hours are spent.
void check(const Choice& choice, const ExperimentOptions& options) {
  if (!options.dataset.empty() && !isDatasetPath(options.dataset))
    throw InputError("--dataset " + options.dataset, "is no recording; give a folder with one, or a .bag");
  if (choice.has("A1")) checkA1(options);
  if (choice.has("A2")) checkA2(options);
  if (choice.has("A3")) checkA3(options);
  if (choice.has("B1")) checkB1(options);
  if (choice.has("B2")) checkB2(options);
  if (choice.has("B3")) checkB3(options);
}

/// \param report gets what is finished, even if a later experiment fails
void runChosen(const Choice& choice, const ExperimentOptions& options, Report& report) {
  std::vector<double> seconds_per_view;
  const auto add = [&](Report part) {
    part.markInterruption();
    report.append(std::move(part));
  };
  if (choice.has("A1")) add(runA1(options, seconds_per_view));
  if (choice.has("A2")) add(runA2(options));
  if (choice.has("A3")) add(runA3(options, seconds_per_view));
  if (choice.has("B1")) add(runB1(options));
  if (choice.has("B2")) add(runB2(options));
  if (choice.has("B3")) add(runB3(options));
  if (choice.has("B4")) add(runB4(options));
}

void printReport(const GlobalOptions& global, const Report& report) {
  for (const std::string& line : report.setup) say(global, line);
  for (const experiments::Table& table : report.tables)
    if (table.name != "a1_steps" && table.name != "b1") say(global, "\n" + experiments::tableText(table));
  say(global, experiments::summaryText(report));
}

/// Prints and writes the report. Returns the number of files in the folder.
std::size_t publish(const GlobalOptions& global, const ReproduceOptions& options, Report& report) {
  report.title =
      fmt::format("Reproduction of {}{}{}", Choice(options.experiments).text(),
                  options.quick ? " (quick)" : "", report.not_run.empty() ? "" : ", not run to the end");
  report.setup = experiments::machineText();
  report.setup.push_back(versionText(false));
  report.setup.push_back("command: " + global.command_line);
  printReport(global, report);
  const auto files = experiments::writeReport(report, options.output);
  say(global, fmt::format("{} files in {}", files.size(), options.output));
  if (global.json == "-")
    fmt::print("{}", experiments::reportJson(report));
  else if (!global.json.empty())
    saveFile(global.json, experiments::reportJson(report));
  return files.size();
}

int reproduce(const GlobalOptions& global, const ReproduceOptions& options) {
  const Choice choice(options.experiments);
  requireEffect(global, choice, options);
  requireFolder(options.output);
  if (!global.json.empty() && global.json != "-") requireCreatable(global.json);
  Console console(global);
  const ExperimentOptions chosen = experimentOptions(global, options, console);
  check(choice, chosen);
  Report report;
  try {
    runChosen(choice, chosen, report);
  } catch (...) {  // of hours of work what is finished is kept
    console.clear();
    report.not_run.push_back("the experiment that failed, and what follows it");
    if (!report.tables.empty()) publish(global, options, report);
    throw;
  }
  console.clear();
  if (report.tables.empty()) throw Interrupted(options.output + ": interrupted; nothing was written");
  const std::size_t files = publish(global, options, report);
  if (!report.not_run.empty())
    throw Interrupted(fmt::format("{}: interrupted; {} files hold what was finished; not run: {}",
                                  options.output, files, fmt::join(report.not_run, "; ")));
  return 0;
}

}  // namespace

void addReproduce(CLI::App& app, const GlobalOptions& global, Action& action) {
  auto o = std::make_shared<ReproduceOptions>();
  CLI::App* command =
      app.add_subcommand("reproduce", "Run the experiments of the papers and print their tables");
  command
      ->add_option("experiment", o->experiments,
                   "One or more; A1: uniform against hierarchical ray tracing; A2: mean against maximum; A3: "
                   "evaluation "
                   "rate; B1: contour-based planner against the standard one; B2: its parts, changed one at "
                   "a time; B3: outliers that depth filters leave; "
                   "B4: false discovery rate of the shadow filter")
      ->required()
      ->check(CLI::IsMember([] {
        std::vector<std::string> names = kExperiments;
        names.push_back("all");
        return names;
      }()));
  command->add_option("-o,--output", o->output, "Folder for CSV, JSON and one HTML page")
      ->required()
      ->type_name("DIR");
  command->add_flag("--quick", o->quick,
                    "One object and size, or those of --mesh and --sizes; fewer modes and steps");
  command
      ->add_option(
          "--mesh", o->meshes,
          "PLY, OBJ or STL; A1: also on this object, repeatable; with --quick, and in A2, instead of "
          "ours")
      ->allow_extra_args(false)
      ->type_name("FILE");
  command->add_option("--up", o->up, "Axis of the meshes that points up (default: z)")
      ->check(CLI::IsMember({"x", "y", "z"}));
  command
      ->add_option("--sizes", o->sizes_m,
                   "Largest extents of the objects, metres (default: 0.20,0.35; with --quick 0.20)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("M,M");
  command
      ->add_option("--seeds", o->seeds,
                   "Runs of each scene and method in B1, of each variant in B2 (default: 5 of the core "
                   "series, else 1)")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  command->add_option("--dataset", o->dataset, "Recorded sequence for A3")->type_name("DIR");
  command->footer("Example: vantage reproduce A1 --quick -o reproduction");
  command->callback([&global, &action, o] { action = [&global, o] { return reproduce(global, *o); }; });
}

}  // namespace vantage::app
