#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/exploration/explorer.h"
#include "io/config_file.h"
#include "io/scene_truth.h"

namespace vantage::testing {

/// Settings of an embedded scene with assignments `key=value` on top.
Settings sceneSettings(const std::string& scene, const std::vector<std::string>& assignments = {});

/// What a simulated exploration left.
struct SimulatedRun {
  std::vector<StepRecord> steps;  ///< as they were last published
  StepRecord closing;
  std::shared_ptr<const SceneTruth> truth;
  std::string stop_reason;
};

/// Called with every published record and the maps at that time.
using RunObserver = std::function<void(const StepRecord&, const WorldModel&)>;

/// Explores an embedded scene with as many threads.
SimulatedRun exploreScene(const std::string& scene, const Settings& settings, int threads = 2,
                          const RunObserver& observer = {});

/// The same with another camera and robot.
SimulatedRun exploreWith(const std::string& scene, const Settings& settings, DepthCamera& camera,
                         Robot& robot, int threads = 2, const RunObserver& observer = {});

}  // namespace vantage::testing
