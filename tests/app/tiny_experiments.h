#pragma once

// Experiments of the hierarchical planner on tiny maps: 4 cm voxels, 80 candidates, a few steps.

#include <algorithm>
#include <fstream>
#include <stop_token>
#include <string>

#include "io/config_file.h"
#include "tests/support/process.h"
#include "viewer/app/experiments/experiments.h"

namespace vantage::experiments {

/// Changes the settings of a run so that a step takes milliseconds.
inline void makeTiny(Settings& settings) {
  ExplorationConfig& e = settings.exploration;
  e.octree.voxel_size_m = 0.04;
  e.hierarchical.icosphere_subdivisions = 1;
  e.hierarchical.workspace_views = 60;
  e.hierarchical.min_occupied = 5;
  e.hierarchical.stop_gain = 2;
  e.steps = std::min(e.steps, 3);
  settings.camera = settings.camera.reduced(4);
}

inline ExperimentOptions tinyOptions() {
  ExperimentOptions options;
  options.quick = true;
  options.sizes_m = {0.35};
  options.max_steps = 2;
  options.repeats = 1;
  options.tune = makeTiny;
  return options;
}

/// Options whose run is interrupted once so many lines were said.
struct Interruption {
  explicit Interruption(int lines) {
    options.control.stop = stop.get_token();
    options.say = [this, lines](const std::string&) {
      if (++said == lines) stop.request_stop();
    };
  }
  std::stop_source stop;
  int said = 0;
  ExperimentOptions options = tinyOptions();
};

/// A wedge of 2 x 1 x 4 units, the long edge along y.
inline std::string writeWedge(const test::TemporaryFolder& folder) {
  const std::string path = folder / "wedge.obj";
  std::ofstream(path) << "v 0 0 0\nv 2 0 0\nv 0 0 1\nv 2 0 1\nv 0 4 0\nv 2 4 0\n"
                         "f 1 2 4 3\nf 1 5 6 2\nf 3 4 6 5\nf 1 3 5\nf 2 6 4\n";
  return path;
}

}  // namespace vantage::experiments
