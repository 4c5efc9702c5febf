#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/exploration/ports.h"
#include "core/geometry/triangle_mesh.h"
#include "io/config_file.h"
#include "io/run_file.h"
#include "viewer/app/command.h"

namespace vantage::app {

/// Everything an exploration needs, wired from a scene or a data set.
struct ExplorationInput {
  std::string name;        ///< scene name or the data set's name
  std::string scene_text;  ///< scene TOML, empty for a data set
  bool replay = false;
  Settings settings;
  std::vector<std::unique_ptr<DepthCamera>> behind;  ///< cameras that `camera` refers to
  std::unique_ptr<DepthCamera> camera;
  std::unique_ptr<Robot> robot;
  std::optional<ArmHeader> arm;        ///< empty for the free flyer
  std::unique_ptr<GroundTruth> truth;  ///< null for a data set
  TriangleMesh truth_mesh;
};

/// What the command line says about an exploration.
struct ExplorationRequest {
  std::string input;  ///< embedded scene, scene TOML, data set (folder or .bag), or a live camera
  std::string planner;
  std::optional<int> steps;
  std::string robot = "free";  ///< or an embedded arm or a URDF file; recorded data have none but "free"
  std::string controller;      ///< of a live arm, e.g. "ros:/arm/follow"
  std::string joint_states = "/joint_states";
  std::string record;  ///< folder for the frames as a data set, empty = none
};

/// Name of a live device rather than of a scene or data set.
bool isDevice(const std::string& name);

/// Opens what is to be explored. Settings: defaults < user file < scene or data set < --config < --set;
/// planner and steps override them. \throws InputError
ExplorationInput openExplorationInput(const GlobalOptions& global, const ExplorationRequest& request);

}  // namespace vantage::app
