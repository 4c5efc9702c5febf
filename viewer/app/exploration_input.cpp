#include "viewer/app/exploration_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "hardware/live_arm.h"
#include "hardware/openni_camera.h"
#include "hardware/recording_camera.h"
#include "hardware/replay_depth_camera.h"
#include "hardware/ros_bridge.h"
#include "hardware/simulated_arm.h"
#include "hardware/simulated_depth_camera.h"
#include "hardware/simulated_robot.h"
#include "io/dataset.h"
#include "io/robot_file.h"
#include "io/scene_file.h"
#include "io/scene_truth.h"
#include "viewer/app/console.h"
#include "viewer/app/inputs.h"

namespace vantage::app {
namespace {

constexpr const char* kFreeFlyer = "free";

/// Where views could be taken: in the mapped volume, above the lowest height of the sensor.
FeasibleViews feasibleViews(const Settings& settings) {
  FeasibleViews views;
  views.region = settings.exploration.volume.bounds();
  views.region.min().z() = std::max(views.region.min().z(), settings.free_flyer.min_height_m);
  views.body_radius_m = settings.free_flyer.body_radius_m;
  views.distance_m = settings.exploration.contour.views.distances_m.front();
  return views;
}

/// The octree's planners take all but the object's box for free (D-A10), which no arm may.
void takeNothingForFree(Settings& settings) {
  applyAssignment(settings, "octree.outside=unknown", "--robot");
}

/// Puts the camera into the hand of an arm. \param start makes the arm of a model \tparam HandCamera of that
/// arm
template <class HandCamera, class StartArm>
void giveArm(ExplorationInput& input, const std::string& robot, const StartArm& start) {
  const Settings& s = input.settings;
  if (!s.exploration.enforce_reachability)
    throw InputError("exploration.enforce_reachability = false",
                     "an arm can't go where it can't; leave it on, or explore with --robot free");
  if (s.exploration.needsOctree() && s.exploration.octree.outside == VoxelState::Free)
    warn("octree.outside = \"free\": the arm moves through all that was never seen outside the object's box");
  const RobotModel model = loadRobot(robot);
  try {
    auto arm = start(model);
    input.arm = ArmHeader{model, arm->planner().T_world_base(), s.arm.clear_boxes};
    input.behind.push_back(std::move(input.camera));
    input.camera = std::make_unique<HandCamera>(*input.behind.back(), *arm);
    input.robot = std::move(arm);
  } catch (const ArmRefusal& refusal) {
    throw InputError("--robot " + robot, refusal.what());
  } catch (const std::invalid_argument& error) {
    throw InputError("--robot " + robot, error.what());
  }
}

ExplorationInput openScene(const GlobalOptions& global, const std::string& name, const std::string& robot) {
  const SceneFile scene = loadScene(name);
  ExplorationInput input;
  input.name = scene.name;
  input.scene_text = scene.text;
  Settings& s = input.settings;
  applyUserConfig(s);
  applyScene(s, scene);
  if (robot != kFreeFlyer) takeNothingForFree(s);
  applyCommandLine(s, global);
  s.validate();
  input.camera = std::make_unique<SimulatedDepthCamera>(
      scene, SimulatedCameraConfig{s.camera, s.sensor, s.exploration.seed});
  if (robot == kFreeFlyer)
    input.robot = std::make_unique<FreeFlyer>(s.free_flyer, initialScanPoses(s.exploration.scan).back());
  else
    giveArm<SimulatedHandCamera>(input, robot, [&](const RobotModel& model) { return startedArm(model, s); });
  input.truth = std::make_unique<SceneTruth>(scene, feasibleViews(s));
  input.truth_mesh = sceneMesh(scene, false);
  return input;
}

ExplorationInput openReplay(const GlobalOptions& global, const std::string& path) {
  Dataset dataset = openDataset(path);
  ExplorationInput input;
  input.name = std::filesystem::canonical(path).filename().string();
  input.replay = true;
  input.settings = datasetSettings(global, dataset);
  input.robot = std::make_unique<FreeFlyer>(input.settings.free_flyer, dataset.frames.front().T_world_camera);
  input.camera = std::make_unique<ReplayDepthCamera>(std::move(dataset));
  return input;
}

constexpr std::string_view kRos = "ros:", kOpenNi = "openni2:";

/// The part of a device's name behind its kind; empty if it is of another.
std::string nameOf(std::string_view kind, const std::string& device) {
  return device.starts_with(kind) ? device.substr(kind.size()) : std::string();
}

std::unique_ptr<LiveCamera> openCamera(const std::string& device, const PinholeCamera& settings) {
  const Eigen::Vector2d range_m(settings.min_range_m, settings.max_range_m);
  if (const std::string topic = nameOf(kRos, device); !topic.empty()) return openRosCamera(topic, range_m);
  if (const std::string uri = nameOf(kOpenNi, device); !uri.empty()) return openOpenNiCamera(uri, range_m);
  throw InputError(device, "names no camera; 'vantage devices' lists them, e.g. ros:/camera/depth/image_raw");
}

/// The arm's surroundings are no default: those of the simulated table are elsewhere.
void requirePlace(const Settings& settings) {
  for (const char* key : {"arm.base_m", "arm.clear_boxes_m"})
    if (!settings.origins.contains(key))
      throw InputError(
          key,
          "has to be given for an arm that truly moves: where it stands, and which boxes you vouch to "
          "hold nothing but the arm (--config lab.toml)");
}

/// A live camera in the hand of a live arm.
ExplorationInput openLive(const GlobalOptions& global, const ExplorationRequest& request) {
  if (request.robot == kFreeFlyer || request.controller.empty())
    throw InputError(request.input,
                     "a live camera has to be held by an arm, which tells where it is; give --robot NAME and "
                     "--controller DEVICE ('vantage robots', 'vantage devices')");
  ExplorationInput input;
  input.name = "live";
  Settings& s = input.settings;
  applyUserConfig(s);
  takeNothingForFree(s);
  applyCommandLine(s, global);
  s.validate();
  const std::string controller = nameOf(kRos, request.controller);
  if (controller.empty())
    throw InputError("--controller " + request.controller,
                     "is no controller; 'vantage devices' lists them, e.g. ros:/arm/follow_joint_trajectory");
  requirePlace(s);
  auto camera = openCamera(request.input, s.camera);
  const auto watch = [&live = *camera] { return live.trouble(); };
  input.camera = std::move(camera);
  s.camera = input.camera->model();
  giveArm<EyeInHandCamera>(input, request.robot, [&](const RobotModel& model) {
    return liveArm(model, s, rosArmLink(model, {controller, request.joint_states}), watch);
  });
  return input;
}

}  // namespace

bool isDevice(const std::string& name) {
  return name.starts_with(kRos) || name.starts_with(kOpenNi);
}

ExplorationInput openExplorationInput(const GlobalOptions& global, const ExplorationRequest& request) {
  const std::string &name = request.input, &robot = request.robot;
  GlobalOptions options = global;  // --planner and --steps are short for settings and beat them
  if (!request.planner.empty())
    options.assignments.push_back(fmt::format("exploration.planner={}", request.planner));
  if (request.steps) options.assignments.push_back(fmt::format("exploration.steps={}", *request.steps));
  const bool live = isDevice(name);
  if (!live) requireScene(name);
  if (!live && !request.controller.empty())
    throw InputError(
        "--controller " + request.controller,
        name + " is no live camera; give one of 'vantage devices' in its place, or leave it out");
  const bool recorded = isDatasetPath(name);
  if (recorded && robot != kFreeFlyer)
    throw InputError("--robot " + robot, name + " is a recording, which no arm moves; leave --robot out");
  ExplorationInput input = live       ? openLive(options, request)
                           : recorded ? openReplay(options, name)
                                      : openScene(options, name, robot);
  if (!request.record.empty()) {
    input.behind.push_back(std::move(input.camera));
    input.camera = std::make_unique<RecordingCamera>(*input.behind.back(), request.record, input.settings);
  }
  return input;
}

}  // namespace vantage::app
