#pragma once

// The experiments of the hierarchical planner (A1, A2, A3) and of the contour-based one (B1 to B4) on scenes
// of our own, on given meshes and on recorded data: ratios, orderings and pass criteria, each with its value.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/run_control.h"
#include "viewer/app/experiments/objects.h"
#include "viewer/app/experiments/report.h"

namespace vantage {
struct DepthFilterConfig;
struct Settings;
}  // namespace vantage

namespace vantage::experiments {

/// What is to be run and how.
struct ExperimentOptions {
  bool quick = false;                          ///< a reduced set that takes minutes
  std::vector<ObjectSource> meshes;            ///< A1: beside the stand-ins; quick, and A2: in their place
  std::vector<double> sizes_m = {0.20, 0.35};  ///< largest extents of the objects, not empty; A2: the first
  std::string dataset;                         ///< folder of a recorded sequence for A3, may be empty
  int max_steps = 20;                          ///< planning steps of a run
  int repeats = 5;                             ///< of phases shorter than a second
  std::optional<std::uint64_t>
      seeds;  ///< B1, B2: of every series; empty: five of the core, one of the others
  std::filesystem::path
      keep;             ///< folder for finished runs of B1 and B2, taken over by the next call; empty: none
  std::string program;  ///< version and commit: runs of another program are not taken over
  std::function<void(Settings&)> tune;  ///< changes every run's settings; may be empty
  std::function<void(const std::string&)> say = [](const std::string&) {};  ///< a line for people
  RunControl control;
};

/// Objects and sizes that A1 runs over.
std::vector<std::pair<ObjectSource, double>> tableObjects(const ExperimentOptions& options);
/// The one that A2 runs on: the first mesh if there is one.
std::pair<ObjectSource, double> meanObject(const ExperimentOptions& options);

// An experiment that is interrupted reports what was finished and names the rest in Report::not_run.

/// Simulated reconstruction, uniform against hierarchical ray tracing. `seconds_per_view`: mean evaluation
/// time of a candidate in each hierarchical run at m = 2, resume, for A3.
Report runA1(const ExperimentOptions& options, std::vector<double>& seconds_per_view);
/// Mean against maximum for inner nodes.
Report runA2(const ExperimentOptions& options);
/// Evaluation rate with views drawn in the workspace: simulated room and recorded sequence.
/// \param seconds_per_view of A1; if empty, one run like those of A1 measures it
Report runA3(const ExperimentOptions& options, const std::vector<double>& seconds_per_view);

/// The contour-based planner against the standard baseline on four tabletop scenes.
Report runB1(const ExperimentOptions& options);
/// Parts of the contour-based planner changed one at a time.
Report runB2(const ExperimentOptions& options);
/// Outliers that depth filters leave on a scene of planes.
Report runB3(const ExperimentOptions& options);
/// False discovery rate of the shadow filter at a bar before a wall.
Report runB4(const ExperimentOptions& options);

/// What can be known to stop an experiment before it runs: meshes, recorded data, settings.
/// \throws InputError naming it
void checkA1(const ExperimentOptions& options);
void checkA2(const ExperimentOptions& options);
void checkA3(const ExperimentOptions& options);
void checkB1(const ExperimentOptions& options);
void checkB2(const ExperimentOptions& options);
void checkB3(const ExperimentOptions& options);

/// Processor, threads and memory of this machine, a line each.
std::vector<std::string> machineText();

/// Defaults that the paper does not give (section 8 of the hierarchical specification), as they were used.
/// \param where experiment that used them \param simulated the scene is known, not recorded
std::vector<DefaultUsed> defaultsUsed(const Settings& settings, const std::string& where, bool simulated);
/// The same of section 10 of the contour-based specification.
std::vector<DefaultUsed> contourDefaultsUsed(const Settings& settings, const std::string& where);
/// Constants of the depth filters that the paper does not give.
std::vector<DefaultUsed> filterDefaultsUsed(const DepthFilterConfig& filter, const std::string& where);
/// Puts the value that an experiment has of its own. \throws std::logic_error if there is no such default
void setDefault(std::vector<DefaultUsed>& defaults, const std::string& name, const std::string& value);
/// Sizes of the objects that were on the table.
DefaultUsed sizesUsed(const std::vector<std::pair<ObjectSource, double>>& objects, const std::string& where);

}  // namespace vantage::experiments
