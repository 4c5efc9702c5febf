#include "viewer/app/inputs.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "io/octree_file.h"
#include "io/run_robot.h"
#include "io/scene_file.h"
#include "io/volume_file.h"
#include "viewer/app/console.h"
#include "viewer/file_kind.h"

namespace vantage::app {
namespace {

/// Settings derived from the data set where it lies now, under what the user says.
Settings layeredSettings(const GlobalOptions& global, const Dataset& dataset) {
  Settings settings = settingsForDataset(dataset);
  applyUserConfig(settings);
  applyCommandLine(settings, global);
  return settings;
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

void applyCommandLine(Settings& settings, const GlobalOptions& global) {
  for (const std::string& file : global.config_files) applyTomlFile(settings, file);
  for (const std::string& assignment : global.assignments) applyAssignment(settings, assignment);
  if (global.seed) applyAssignment(settings, fmt::format("exploration.seed={}", *global.seed), "--seed");
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
  if (isDatasetPath(scene)) {
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
  if (!std::filesystem::exists(map.recording))
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
    if (ending == other && !isDatasetPath(name))
      throw InputError(
          name, fmt::format("is a {} file, and a scene is wanted; give the name of one (vantage scenes), a "
                            "scene's .toml, or a recording (folder or .bag)",
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
