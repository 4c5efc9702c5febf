#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vantage::app {

/// Options of every command.
struct GlobalOptions {
  bool verbose = false;
  bool quiet = false;
  bool log_json = false;         ///< log lines as JSON objects
  int threads = 0;               ///< 0 = one per core
  std::string compute = "auto";  ///< "auto" or "cpu"
  std::optional<std::uint64_t> seed;
  std::vector<std::string> config_files;  ///< --config, in order
  std::vector<std::string> assignments;   ///< --set, in order
  std::string json;                       ///< --json FILE, "-" = standard output
  std::string command_line;               ///< as typed
};

/// What the chosen command does; set by its callback, run after the whole line is parsed. Returns the exit
/// code.
using Action = std::function<int()>;

/// Each adds one command; all live in a file of their own. `global` and `action` outlive the parser.
void addExplore(CLI::App& app, const GlobalOptions& global, Action& action);
void addView(CLI::App& app, const GlobalOptions& global, Action& action);
void addSnapshot(CLI::App& app, const GlobalOptions& global, Action& action);
void addFilter(CLI::App& app, const GlobalOptions& global, Action& action);
void addFuse(CLI::App& app, const GlobalOptions& global, Action& action);
void addContours(CLI::App& app, const GlobalOptions& global, Action& action);
void addViews(CLI::App& app, const GlobalOptions& global, Action& action);
void addSegment(CLI::App& app, const GlobalOptions& global, Action& action);
void addGain(CLI::App& app, const GlobalOptions& global, Action& action);
void addPlan(CLI::App& app, const GlobalOptions& global, Action& action);
void addPath(CLI::App& app, const GlobalOptions& global, Action& action);
void addCompare(CLI::App& app, const GlobalOptions& global, Action& action);
void addScenes(CLI::App& app, const GlobalOptions& global, Action& action);
void addRobots(CLI::App& app, const GlobalOptions& global, Action& action);
void addDevices(CLI::App& app, const GlobalOptions& global, Action& action);
void addConfig(CLI::App& app, const GlobalOptions& global, Action& action);
void addInfo(CLI::App& app, const GlobalOptions& global, Action& action);
void addReproduce(CLI::App& app, const GlobalOptions& global, Action& action);
void addDoctor(CLI::App& app, const GlobalOptions& global, Action& action);

/// Accepts the name of a planner, or several with commas between them (plannersFromText()).
CLI::Validator isPlanner();

/// `vantage --version`; with `verbose` also the libraries and the GL driver.
std::string versionText(bool verbose);

}  // namespace vantage::app
