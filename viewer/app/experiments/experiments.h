#pragma once

// The experiments of the hierarchical planner (A1, A2, A3) on scenes of our own, on given meshes and on
// recorded data: ratios, orderings and pass criteria, each with its value.

#include <functional>
#include <string>
#include <vector>

#include "core/run_control.h"
#include "viewer/app/experiments/objects.h"
#include "viewer/app/experiments/report.h"

namespace vantage {
struct Settings;
}

namespace vantage::experiments {

/// What is to be run and how.
struct ExperimentOptions {
  bool quick = false;                          ///< a reduced set that takes minutes
  std::vector<ObjectSource> meshes;            ///< beside the stand-ins
  std::vector<double> sizes_m = {0.20, 0.35};  ///< largest extents of the objects; quick: the first alone
  std::string dataset;                         ///< folder of a recorded sequence for A3, may be empty
  int max_steps = 20;                          ///< planning steps of a run
  int repeats = 5;                             ///< of phases shorter than a second
  std::function<void(Settings&)> tune;         ///< changes every run's settings; may be empty
  std::function<void(const std::string&)> say = [](const std::string&) {};  ///< a line for people
  RunControl control;
};

/// Objects and sizes that A1 runs over.
std::vector<std::pair<ObjectSource, double>> tableObjects(const ExperimentOptions& options);

/// Simulated reconstruction, uniform against hierarchical ray tracing. `seconds_per_view`: mean evaluation
/// time of a candidate in each hierarchical run at m = 2, resume, for A3.
Report runA1(const ExperimentOptions& options, std::vector<double>& seconds_per_view);
/// Mean against maximum for inner nodes.
Report runA2(const ExperimentOptions& options);
/// Evaluation rate with views drawn in the workspace: simulated room and recorded sequence.
/// \param seconds_per_view of A1; if empty, one run of A1 measures it
Report runA3(const ExperimentOptions& options, const std::vector<double>& seconds_per_view);

/// Processor, threads and memory of this machine, a line each.
std::vector<std::string> machineText();

/// Defaults that the paper does not give (section 8 of the hierarchical specification), as they were used.
std::vector<DefaultUsed> defaultsUsed(const Settings& settings);

}  // namespace vantage::experiments
