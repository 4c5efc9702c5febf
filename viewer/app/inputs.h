#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/exploration/plan_view.h"
#include "core/volume/occupancy_octree.h"
#include "io/config_file.h"
#include "io/dataset.h"
#include "io/run_file.h"
#include "viewer/app/command.h"

namespace vantage::app {

/// The command line's part of the settings: --config, --set, --seed. \throws InputError
void applyCommandLine(Settings& settings, const GlobalOptions& global);

/// Settings of commands that take no scene: defaults < user file < --config < --set. \throws InputError
Settings commandSettings(const GlobalOptions& global);

/// Settings of a scene, or of none if `scene` is empty. \throws InputError
Settings sceneSettings(const GlobalOptions& global, const std::string& scene);

/// Settings of a data set: derived from it < user file < --config < --set. Moves it if they place it
/// elsewhere in the world. \throws InputError
Settings datasetSettings(const GlobalOptions& global, Dataset& dataset);

/// What a command works on.
enum class MapNeed { Tsdf, Either };

/// A map from a file and what is known about where it came from.
struct LoadedMap {
  TsdfVolume volume;                      ///< without voxels if the map is an octree alone
  std::optional<OccupancyOctree> octree;  ///< of `.bt`, `.ot`, and of runs that keep one
  bool hasVolume() const { return !volume.voxels().empty(); }
  std::optional<StepRecord> record;  ///< of RUN#STEP
  int step = 1;                      ///< of RUN#STEP
  Exclusions exclusions;             ///< what the run's earlier steps left out
  std::string recording;             ///< of a replay: path of the data set
  std::set<int> frames_taken;        ///< of a replay: numbers of the frames that were served up to the step
  std::shared_ptr<MotionPlanner> motion;  ///< of the run's robot; null for maps that are no run's
  Settings settings;  ///< commandSettings(), over the run's own configuration for RUN#STEP
};

/// MAP: a `.vti`, `.bt` or `.ot` file, `RUN.vantage` (its last map), `RUN.vantage#STEP` or `RUN.vantage#end`.
/// Warnings are printed. \throws InputError, also for a map of the kind that is not needed.
LoadedMap loadMap(const GlobalOptions& global, const std::string& map, MapNeed need = MapNeed::Tsdf);

/// Space in which the planners of a map work: the mapped volume of a run, else all that the file covers.
Box mappedBox(const LoadedMap& map);

/// The object's box: octree.object_min_m and octree.object_max_m, else that of the octree, else the
/// workspace. \throws InputError if it lies outside the map.
Box objectBoxOf(const LoadedMap& map);

/// Boxes that share some volume.
bool overlap(const Box& a, const Box& b);

/// Recorded poses whose frames no scan up to the step has taken, in recorded order; none unless the map is of
/// a replay. \throws InputError if the recording is gone and the step does not tell.
std::vector<ScanPose> posesLeft(const LoadedMap& map);

/// Refuses a collision cell that is smaller than the voxels of the map. \throws InputError
void requireCollisionCell(const Settings& settings, double voxel_size_m);

/// Two spellings of one path; a step of a run is of the run's file.
bool sameFile(const std::string& a, const std::string& b);

/// Refuses outputs that would overwrite an input or each other. Pairs of a name for messages and a path;
/// empty paths do not count. \throws InputError
void requireDistinctFiles(const std::vector<std::pair<std::string, std::string>>& files);

/// Refuses what is no scene by its name: maps, runs, clouds, tables. \throws InputError
void requireScene(const std::string& name);

/// Refuses a file name without one of these endings. \throws InputError
void requireEnding(const std::string& option, const std::string& path,
                   const std::vector<std::string>& endings);

/// Worker threads that parallel work uses now.
int threadsInUse();

}  // namespace vantage::app
