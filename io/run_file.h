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
#include "core/motion/robot_model.h"

namespace vantage {

/// What the hierarchical planner of a run worked with.
struct OctreeHeader {
  HierarchicalPlannerConfig planner;
  OctreeMapConfig map;
  Box object_box;  ///< the object's box, with volume
};

/// What a run with an arm adds to the header.
struct ArmHeader {
  RobotModel model;
  Pose T_world_base = Pose::Identity();
  std::vector<Box> clear_boxes;  ///< vouched for, world
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
  std::optional<ArmHeader> arm;        ///< empty for the free flyer
};

/// How much of a record is read.
enum class RunDetail {
  All,
  NoVolume
};  ///< NoVolume leaves the changed bricks empty; moveVolume() and moveOctree() give the maps

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

/// What lies at the path of a run that was opened.
enum class RunFileState {
  Same,
  Replaced,  ///< another file, or a finished run that changed
  Gone
};

/// Key figures of a step; empty = not known, or not of its planner.
struct StepSummary {
  int step = 0;
  bool closing = false;  ///< the scan at the last view: figures of the map alone
  std::string planner;   ///< name of the PlannerKind; empty in old runs and of the closing scan
  bool has_view = false;
  std::uint64_t unknown_voxels = 0;                   ///< in the workspace
  std::optional<std::uint64_t> unknown_near_objects;  ///< U_tau
  std::optional<std::uint64_t> unknown_in_boxes;      ///< U_box
  std::optional<double> coverage;                     ///< share in [0, 1]
  std::optional<std::uint64_t> box_unknown;           ///< octree voxels in the object's box
  std::optional<std::uint64_t> box_occupied;
  // Of the chosen view:
  std::optional<double> gain;  ///< as predicted: rays, or utility
  std::optional<std::uint64_t> gain_voxels;
  std::optional<std::uint64_t> realised_voxels;  ///< known once the next scan is fused
  std::optional<double> saliency, utility, path_length_m;
  std::optional<bool> toward_object;
  // Work:
  std::optional<std::uint64_t> segments, poses_generated, poses_scored, rays;
  double planning_s = 0.0;  ///< contours to motion planning
  bool operator==(const StepSummary&) const = default;
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

  /// What can be told of the steps without their products, by step; the closing scan is the last.
  std::vector<StepSummary> summaries() const;
  /// Whether what was opened still lies at its path. A run in progress may grow and stay the same.
  RunFileState fileState() const;

  /// What is stored, by step, stage and name.
  std::vector<ProductInfo> products() const;

  /// Brings a volume from `from_step`, whose state it holds (0 = empty volume), to the state in which `step`
  /// was planned, in either direction. closingStep() names the map after the last scan. Returns the bricks
  /// that may have changed. \throws InputError, and then the volume is between the two; std::invalid_argument
  /// for steps out of range or another geometry.
  BrickSet moveVolume(TsdfVolume& volume, int from_step, int step) const;
  /// The same for the octree of the hierarchical planner; make it with emptyOctree().
  BrickSet moveOctree(OccupancyOctree& octree, int from_step, int step) const;
  int closingStep() const;  ///< last step + 1

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Octree of a run before its first scan: nothing stored. \throws std::invalid_argument if the run has none,
/// std::runtime_error if it does not fit in memory.
OccupancyOctree emptyOctree(const RunHeader& header);

}  // namespace vantage
