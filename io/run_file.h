#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/exploration/explorer.h"
#include "core/exploration/step_record.h"
#include "core/geometry/triangle_mesh.h"

namespace vantage {

/// What the hierarchical planner of a run worked with.
struct OctreeHeader {
  HierarchicalPlannerConfig planner;
  OctreeMapConfig map;
  Box object_box;  ///< the object's box, with volume
};

/// What a run is about; written once at its start.
struct RunHeader {
  std::string input;    ///< scene name or path, data set path
  std::string planner;  ///< names with commas between them, see plannersFromText()
  std::string robot;    ///< "free" or an arm's name
  std::string command_line;
  std::string version;      ///< of the program that wrote it
  std::string scene_toml;   ///< text of the scene file, empty for a data set
  std::string config_toml;  ///< effective configuration with every value's origin as comments
  std::uint64_t seed = 0;
  int threads = 0;
  std::string compute = "cpu";
  PinholeCamera camera;
  GridGeometry volume;
  Box workspace;
  ContourPlannerConfig contour_config;
  FreeFlyerConfig free_flyer;
  bool replay = false;                 ///< the camera served recorded frames
  TriangleMesh truth;                  ///< the true scene, empty if not known
  std::optional<OctreeHeader> octree;  ///< empty if the run has no octree
};

/// How much of a record is read.
enum class RunDetail {
  All,
  NoVolume
};  ///< NoVolume leaves the changed bricks empty; advanceVolume() and advanceOctree() give the maps

/// One stored product, for listings.
struct ProductInfo {
  int step = 0;
  std::string stage, name;
  std::uint64_t raw_bytes = 0;     ///< before compression
  std::uint64_t stored_bytes = 0;  ///< in the file
};

/// Writes a run file (SQLite, one transaction per step): a crash at any instant loses at most the step in
/// progress, and readers may follow. While it is open, `PATH-wal` and `PATH-shm` lie beside it; they go when
/// it is closed.
class RunWriter {
 public:
  /// Creates or replaces the file. \throws InputError if it cannot be created.
  RunWriter(const std::filesystem::path& path, const RunHeader& header);
  ~RunWriter();
  RunWriter(const RunWriter&) = delete;

  /// Adds a finished step, or the closing record (record.closing), which goes under the number after the last
  /// step. \throws std::runtime_error naming the file, e.g. when the disk is full; steps written before stay
  /// readable. \throws std::invalid_argument if the step is not above the last one written.
  void write(const StepRecord& record);
  /// Adds what is known of a stored step once its view's scan is fused: realised_voxels and served.
  void setRealised(const StepRecord& record);
  /// Stores why the run ended and folds the side files into one.
  void finish(const std::string& stop_reason);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Reads a run file, also while it is written. One step is decoded at a time.
class RunReader {
 public:
  /// \throws InputError: missing, not a run file, damaged, or of a newer version.
  explicit RunReader(const std::filesystem::path& path);
  ~RunReader();
  RunReader(const RunReader&) = delete;

  const RunHeader& header() const;
  std::vector<int> steps() const;                 ///< numbers of the recorded steps, ascending
  bool hasClosing() const;                        ///< the scan at the last view is there
  std::optional<std::string> stopReason() const;  ///< empty while the run goes on or was cut off

  /// The record of a step with all its products. \throws InputError if there is no such step.
  StepRecord step(int step, RunDetail detail = RunDetail::All) const;
  StepRecord closing(RunDetail detail = RunDetail::All) const;

  /// What is stored, by step, stage and name.
  std::vector<ProductInfo> products() const;

  /// The volume as it was when `step` was planned: applies the bricks of the steps after `from_step` up to
  /// `step` to `volume`, which holds the state of `from_step` (0 = empty volume). closingStep() names the map
  /// after the last scan. Returns the bricks that changed.
  BrickSet advanceVolume(TsdfVolume& volume, int from_step, int step) const;
  /// The same for the octree of the hierarchical planner; make it with emptyOctree().
  BrickSet advanceOctree(OccupancyOctree& octree, int from_step, int step) const;
  int closingStep() const;  ///< last step + 1

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Octree of a run before its first scan: nothing stored. \throws std::invalid_argument if the run has none,
/// std::runtime_error if it does not fit in memory.
OccupancyOctree emptyOctree(const RunHeader& header);

}  // namespace vantage
