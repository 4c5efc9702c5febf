#include "viewer/app/inputs.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "hardware/openni_camera.h"
#include "hardware/recording_camera.h"
#include "hardware/replay_depth_camera.h"
#include "hardware/ros_bridge.h"
#include "hardware/simulated_arm.h"
#include "hardware/simulated_depth_camera.h"
#include "hardware/simulated_robot.h"
#include "io/octree_file.h"
#include "io/robot_file.h"
#include "io/run_robot.h"
#include "io/scene_file.h"
#include "io/scene_truth.h"
#include "io/volume_file.h"
#include "viewer/app/console.h"
#include "viewer/file_kind.h"

namespace vantage::app {
namespace {

constexpr const char* kFreeFlyer = "free";

/// The command line's part: --config, --set, --seed.
void applyCommandLine(Settings& settings, const GlobalOptions& global) {
  for (const std::string& file : global.config_files) applyTomlFile(settings, file);
  for (const std::string& assignment : global.assignments) applyAssignment(settings, assignment);
  if (global.seed) applyAssignment(settings, fmt::format("exploration.seed={}", *global.seed), "--seed");
}

/// Settings derived from the data set where it lies now, under what the user says.
Settings layeredSettings(const GlobalOptions& global, const Dataset& dataset) {
  Settings settings = settingsForDataset(dataset);
  applyUserConfig(settings);
  applyCommandLine(settings, global);
  return settings;
}

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

ExplorationInput openReplay(const GlobalOptions& global, const std::string& folder) {
  Dataset dataset = openDataset(folder);
  ExplorationInput input;
  input.name = std::filesystem::canonical(folder).filename().string();
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

/// A camera, and what keeps its images from coming (empty text: nothing does).
struct LiveCamera {
  std::unique_ptr<DepthCamera> camera;
  std::function<std::string()> trouble;
};

template <class Camera>
LiveCamera openCamera(const std::string& name, const PinholeCamera& settings) {
  auto camera = std::make_unique<Camera>(name, Eigen::Vector2d(settings.min_range_m, settings.max_range_m));
  const Camera& opened = *camera;
  return {std::move(camera), [&opened] { return opened.trouble(); }};
}

/// A live camera in the hand of a live arm.
ExplorationInput openLive(const GlobalOptions& global, const ExplorationRequest& request) {
  if (request.robot == kFreeFlyer || request.controller.empty())
    throw InputError(request.input,
                     "a live camera has to be held by an arm, which tells where it is; give --robot NAME and "
                     "--controller DEVICE ('vantage robots', 'vantage devices')");
  ExplorationInput input;
  input.name = "live";
  input.live = true;
  Settings& s = input.settings;
  applyUserConfig(s);
  takeNothingForFree(s);
  applyCommandLine(s, global);
  s.validate();
  const std::string controller = nameOf(kRos, request.controller);
  if (controller.empty())
    throw InputError("--controller " + request.controller,
                     "is no controller; 'vantage devices' lists them, e.g. ros:/arm/follow_joint_trajectory");
  const std::string openni = nameOf(kOpenNi, request.input);
  LiveCamera live = openni.empty() ? openCamera<RosCamera>(nameOf(kRos, request.input), s.camera)
                                   : openCamera<OpenNiCamera>(openni, s.camera);
  input.camera = std::move(live.camera);
  s.camera = input.camera->model();
  giveArm<EyeInHandCamera>(input, request.robot, [&](const RobotModel& model) {
    return liveArm(model, s, rosArmLink(model, {controller, request.joint_states}), live.trouble);
  });
  return input;
}

struct RunMap {
  std::string path;
  std::string step;  ///< empty = the last map
};

std::optional<RunMap> asRunMap(const std::string& map) {
  const std::size_t hash = map.rfind('#');
  if (hash != std::string::npos) return RunMap{map.substr(0, hash), map.substr(hash + 1)};
  if (std::filesystem::path(map).extension() == ".vantage") return RunMap{map, ""};
  return std::nullopt;
}

/// The step that a RUN#STEP names; closingStep() for the map after the last scan.
int findStep(const RunReader& run, const RunMap& map) {
  const std::vector<int> steps = run.steps();
  if (steps.empty()) throw InputError(map.path, "holds no finished step yet");
  if (map.step == "end" || map.step.empty()) {
    if (run.hasClosing()) return run.closingStep();
    if (map.step.empty()) return steps.back();
    throw InputError(map.path + "#end",
                     "the run has no closing scan; name a step, 1 .. " + std::to_string(steps.back()));
  }
  int step = 0;
  const auto [end, error] = std::from_chars(map.step.data(), map.step.data() + map.step.size(), step);
  if (error != std::errc() || end != map.step.data() + map.step.size() ||
      std::find(steps.begin(), steps.end(), step) == steps.end())
    throw InputError(map.path + "#" + map.step,
                     fmt::format("no such step; allowed: {} .. {} or 'end'", steps.front(), steps.back()));
  return step;
}

[[noreturn]] void refuseOctree(const std::string& map) {
  throw InputError(map,
                   "is an octree, and this command works on a TSDF; give a .vti file (vantage fuse DATASET "
                   "-o MAP.vti) or a run of the contour planner");
}

/// What an earlier step means for the one that is loaded.
void addEarlier(LoadedMap& loaded, const StepRecord& record) {
  loaded.exclusions.add(record, loaded.settings.exploration.contour.gain);
  for (const ScanPose& pose : record.scan) loaded.frames_taken.insert(pose.frame);
}

LoadedMap loadRunMap(const GlobalOptions& global, const RunMap& map, MapNeed need) {
  const RunReader run(map.path);
  LoadedMap loaded;
  applyUserConfig(loaded.settings);
  applyToml(loaded.settings, run.header().config_toml, map.path);
  const bool keeps_volume = loaded.settings.exploration.needsVolume(),
             keeps_octree = run.header().octree.has_value();
  if (need == MapNeed::Tsdf && !keeps_volume) refuseOctree(map.path);
  applyCommandLine(loaded.settings, global);
  loaded.settings.validate();
  const int step = findStep(run, map);
  if (keeps_volume) {
    loaded.volume = TsdfVolume(run.header().volume);
    run.moveVolume(loaded.volume, 0, step);
  }
  if (keeps_octree && need != MapNeed::Tsdf) {
    loaded.octree = emptyOctree(run.header());
    run.moveOctree(*loaded.octree, 0, step);
  }
  loaded.step = step;
  for (const int earlier : run.steps())
    if (earlier < step) addEarlier(loaded, run.step(earlier, RunDetail::NoVolume));
  loaded.record =
      step == run.closingStep() ? run.closing(RunDetail::NoVolume) : run.step(step, RunDetail::NoVolume);
  for (const ScanPose& pose : loaded.record->scan) loaded.frames_taken.insert(pose.frame);
  loaded.motion = motionPlannerOf(run.header(), loaded.settings);
  if (run.header().replay) loaded.recording = run.header().input;
  return loaded;
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
  const bool recorded = std::filesystem::is_directory(name);
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

Settings commandSettings(const GlobalOptions& global) {
  Settings settings;
  applyUserConfig(settings);
  applyCommandLine(settings, global);
  settings.validate();
  return settings;
}

Settings sceneSettings(const GlobalOptions& global, const std::string& scene) {
  Settings settings;
  applyUserConfig(settings);
  if (std::filesystem::is_directory(scene)) {
    Dataset dataset = openDataset(scene);
    return datasetSettings(global, dataset);
  }
  requireScene(scene);
  if (!scene.empty()) applyScene(settings, loadScene(scene));
  applyCommandLine(settings, global);
  settings.validate();
  return settings;
}

Settings datasetSettings(const GlobalOptions& global, Dataset& dataset) {
  for (const std::string& warning : dataset.warnings) warn(warning);
  Settings settings = layeredSettings(global, dataset);
  if (!settings.T_world_dataset().isApprox(dataset.T_world_dataset, 1e-12)) {
    placeDataset(dataset, settings.T_world_dataset());
    settings = layeredSettings(global, dataset);
  }
  settings.validate();
  return settings;
}

LoadedMap loadMap(const GlobalOptions& global, const std::string& map, MapNeed need) {
  if (const auto run = asRunMap(map)) return loadRunMap(global, *run, need);
  LoadedMap loaded;
  loaded.settings = commandSettings(global);
  const std::string ending = std::filesystem::path(map).extension().string();
  const bool is_octree = ending == ".bt" || ending == ".ot" || kindOf(map) == FileKind::Octree;
  if (is_octree && need == MapNeed::Tsdf) refuseOctree(map);
  if (is_octree) {
    loaded.octree = readOctree(map, loaded.settings.exploration.octree.occupancy);
    return loaded;
  }
  std::vector<std::string> warnings;
  loaded.volume = readVolume(map, warnings);
  for (const std::string& warning : warnings) warn(warning);
  return loaded;
}

Box mappedBox(const LoadedMap& map) {
  if (map.record) return map.settings.exploration.volume.bounds();
  return map.hasVolume() ? map.volume.geometry().bounds() : map.octree->geometry().bounds();
}

bool overlap(const Box& a, const Box& b) {
  return (a.min().array() < b.max().array()).all() && (b.min().array() < a.max().array()).all();
}

Box objectBoxOf(const LoadedMap& map) {
  const ExplorationConfig& exploration = map.settings.exploration;
  const bool configured = exploration.octree.object_box.volume() > 0.0;
  const Box box = map.octree && !configured ? map.octree->objectBox() : exploration.objectBox();
  const Box mapped = mappedBox(map);
  if (overlap(box, mapped)) return box;
  const auto text = [](const Box& b) {
    return fmt::format("({:g}, {:g}, {:g}) .. ({:g}, {:g}, {:g}) m", b.min().x(), b.min().y(), b.min().z(),
                       b.max().x(), b.max().y(), b.max().z());
  };
  throw InputError("octree.object_min_m, octree.object_max_m",
                   fmt::format("the object's box {} lies outside the map {}; give one inside it (--set "
                               "octree.object_min_m=[x,y,z] --set octree.object_max_m=[x,y,z])",
                               text(box), text(mapped)));
}

std::vector<ScanPose> posesLeft(const LoadedMap& map) {
  std::vector<ScanPose> left;
  if (map.recording.empty()) return left;
  if (map.record->utilities)
    for (const ViewUtility& view : map.record->utilities->views)
      if (view.frame >= 0) left.push_back({view.T_world_camera, view.frame});
  if (!left.empty()) return left;
  if (!std::filesystem::is_directory(map.recording))
    throw InputError(
        map.recording,
        "the recording of this run is not here, and without it nobody knows which poses are left; "
        "put it back, or plan without: --set candidates.recorded=false --set "
        "dataset.serve_distance_m=0");
  Dataset dataset = openDataset(map.recording);
  placeDataset(dataset, map.settings.T_world_dataset());
  for (const DatasetFrame& frame : dataset.frames)
    if (!map.frames_taken.contains(frame.number)) left.push_back({frame.T_world_camera, frame.number});
  return left;
}

void requireCollisionCell(const Settings& settings, double voxel_size_m) {
  const double cell_m = settings.free_flyer.cell_m;
  if (cell_m >= voxel_size_m) return;
  throw InputError(
      fmt::format("robot.cell_m = {:g}", cell_m),
      fmt::format("a collision cell of {:g} m is smaller than the map's voxels of {:g} m; allowed: "
                  "{:g} .. 10 (--set robot.cell_m={:g})",
                  cell_m, voxel_size_m, voxel_size_m, voxel_size_m));
}

bool sameFile(const std::string& a, const std::string& b) {
  const auto place = [](const std::string& path) {
    std::error_code error;
    const auto absolute = std::filesystem::weakly_canonical(
        std::filesystem::absolute(path.substr(0, path.find('#')), error), error);
    return path == "-" || error ? path : absolute.string();
  };
  return place(a) == place(b);
}

void requireDistinctFiles(const std::vector<std::pair<std::string, std::string>>& files) {
  for (std::size_t a = 0; a < files.size(); ++a)
    for (std::size_t b = a + 1; b < files.size(); ++b)
      if (!files[a].second.empty() && sameFile(files[a].second, files[b].second))
        throw InputError(files[b].first + " " + files[b].second,
                         "is the same file as " + files[a].first + "; choose another name");
}

void requireScene(const std::string& name) {
  const std::string ending = std::filesystem::path(name.substr(0, name.find('#'))).extension().string();
  for (const char* other : {".bt", ".ot", ".vti", ".vantage", ".pcd", ".ply", ".obj", ".csv", ".png"})
    if (ending == other && !std::filesystem::is_directory(name))
      throw InputError(
          name, fmt::format("is a {} file, and a scene is wanted; give the name of one (vantage scenes), a "
                            "scene's .toml, or the folder of a recording",
                            other));
}

void requireEnding(const std::string& option, const std::string& path,
                   const std::vector<std::string>& endings) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (std::find(endings.begin(), endings.end(), ending) != endings.end()) return;
  throw InputError(option + " " + path,
                   fmt::format("has another kind of name; allowed endings: {}", fmt::join(endings, ", ")));
}

int threadsInUse() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace vantage::app
