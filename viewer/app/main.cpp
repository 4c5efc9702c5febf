#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/gpu/egl_context.h"
#include "io/error.h"
#include "io/suggest.h"
#include "viewer/app/command.h"
#include "viewer/app/console.h"
#include "viewer/window.h"

namespace {

using namespace vantage;
using namespace vantage::app;

constexpr int kDone = 0, kFailed = 1, kBadInput = 2, kNoDisplay = 3;

/// One line on standard error, whatever the text holds.
int fail(int code, std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::fprintf(stderr, "vantage: %s\n", message.c_str());
  return code;
}

void addGlobalOptions(CLI::App& app, GlobalOptions& global) {
  app.add_flag("-v,--verbose", global.verbose, "Log every stage with its counts and duration");
  app.add_flag("-q,--quiet", global.quiet, "Print errors and requested results only");
  app.add_flag("--log-json", global.log_json, "Log lines as JSON objects");
  app.add_option("--threads", global.threads, "Worker threads, 0 = one per core")
      ->check(CLI::Range(0, 1024))
      ->type_name("N");
  app.add_option("--compute", global.compute, "Compute engine")->check(CLI::IsMember({"auto", "cpu"}));
  app.add_option("--seed", global.seed, "Seed of noise and path planning")
      ->check([](const std::string& text) {
        const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
        return digits && text.size() < 16
                   ? ""
                   : "'" + text + "' is no seed; give a whole number from 0 to 999999999999999";
      })
      ->type_name("N");
  app.add_option("--config", global.config_files, "Configuration file, applied over the scene; repeatable")
      ->type_name("FILE.toml")
      ->allow_extra_args(false);
  app.add_option("--set", global.assignments,
                 "One setting, e.g. saliency.isolation_distance_m=0.01; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_option("--json", global.json, "Write machine-readable results, - = standard output")
      ->type_name("FILE");
}

/// Names of the options that a command line may hold after `command`.
std::vector<std::string> optionNames(const CLI::App& app, const CLI::App* command) {
  std::vector<std::string> names;
  for (const CLI::App* parser : {&app, command}) {
    if (!parser) continue;
    for (const CLI::Option* option : parser->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  const std::string match = nearest(word, known);
  return match.empty() ? "" : "; did you mean '" + match + "'?";
}

std::vector<std::string> commandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// Refuses what no parser wanted, with the nearest thing it could have been.
std::optional<std::string> unexpected(const CLI::App& app, const CLI::App* command) {
  const std::vector<std::string> extras = app.remaining(true);
  if (extras.empty()) return std::nullopt;
  const std::string& word = extras.front();
  const std::string where = command ? command->get_name() + ": " : "";
  const std::string help =
      "; see 'vantage " + (command ? command->get_name() + " " : std::string()) + "--help'";
  if (word.size() > 1 && word[0] == '-') {
    const std::string name = word.substr(0, word.find('='));
    return where + "unknown option '" + name + "'" + suggestion(name, optionNames(app, command)) + help;
  }
  if (!command) return "unknown command '" + word + "'" + suggestion(word, commandNames(app)) + help;
  return where + "unexpected argument '" + word + "'" + help;
}

void addCommands(CLI::App& app, const GlobalOptions& global, Action& action) {
  addExplore(app, global, action);
  addView(app, global, action);
  addSnapshot(app, global, action);
  addFilter(app, global, action);
  addFuse(app, global, action);
  addContours(app, global, action);
  addViews(app, global, action);
  addSegment(app, global, action);
  addGain(app, global, action);
  addPlan(app, global, action);
  addPath(app, global, action);
  addScenes(app, global, action);
  addRobots(app, global, action);
  addDevices(app, global, action);
  addCompare(app, global, action);
  addConfig(app, global, action);
  addInfo(app, global, action);
  addReproduce(app, global, action);
  addDoctor(app, global, action);
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    command->allow_extras();
    command->fallthrough();
    command->footer(command->get_footer() +
                    "\nOptions of every command (--set, --config, --json, --threads, --seed, -q, -v ...): "
                    "vantage --help");
  }
}

/// Parses the line. Returns an exit code if that is all there is to do.
std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  std::optional<std::string> refusal;
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    refusal = e.what();
  }
  const auto chosen = app.get_subcommands();
  const CLI::App* command = chosen.empty() ? nullptr : chosen.front();
  if (const auto message = unexpected(app, command)) return fail(kBadInput, *message);
  if (!refusal) return std::nullopt;
  const std::string name = command ? command->get_name() : "";
  return fail(kBadInput, (command ? name + ": " : "") + *refusal + "; see 'vantage " + name +
                             (command ? " " : "") + "--help'");
}

/// Runs the chosen command with the threads it was given.
int run(const GlobalOptions& global, const Action& action) {
  const int threads =
      global.threads > 0 ? global.threads : static_cast<int>(std::thread::hardware_concurrency());
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::max(1, threads));
  setUpLog(global);
  const int code = action();
  if (std::fflush(stdout) != 0 || std::ferror(stdout))
    return fail(kFailed, "standard output: cannot be written in full; check the free space");
  return code;
}

int parseAndRun(int argc, char** argv) {
  GlobalOptions global;
  Action action;
  CLI::App app(
      "Vantage explores unknown scenes with a depth camera, decides where to look next, and shows why.");
  app.name("vantage");
  app.fallthrough();
  app.allow_extras();
  app.require_subcommand(0, 1);
  bool show_version = false;
  app.add_flag("--version", show_version,
               "Print the version; with -v also of the libraries and the GL driver");
  addGlobalOptions(app, global);
  addCommands(app, global, action);
  for (int a = 0; a < argc; ++a) global.command_line += (a ? " " : "") + std::string(a ? argv[a] : "vantage");

  if (const auto code = parse(app, argc, argv)) return *code;
  if (show_version) {
    std::printf("%s", versionText(global.verbose).c_str());
    return kDone;
  }
  if (!action) {
    std::printf("%s", app.help().c_str());
    return kBadInput;
  }
  return run(global, action);
}

}  // namespace

int main(int argc, char** argv) {
  watchStopSignals();
  try {
    return parseAndRun(argc, argv);
  } catch (const GlUnavailable& e) {
    return fail(kNoDisplay, e.what());
  } catch (const WindowUnavailable& e) {
    return fail(kNoDisplay, e.what());
  } catch (const InputError& e) {
    return fail(kBadInput, e.what());
  } catch (const std::invalid_argument& e) {
    return fail(kBadInput, e.what());
  } catch (const Interrupted& e) {
    return fail(kFailed, e.what());
  } catch (const Cancelled&) {
    return fail(kFailed, "interrupted; nothing more was written");
  } catch (const std::bad_alloc&) {
    return fail(kFailed, "memory: not enough for this work; choose a smaller volume or a larger voxel");
  } catch (const std::exception& e) {
    return fail(kFailed, e.what());
  }
}
