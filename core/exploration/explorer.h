#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/exploration/planner_kind.h"
#include "core/exploration/ports.h"
#include "core/exploration/step_record.h"
#include "core/exploration/world_model.h"
#include "core/perception/depth_filters.h"
#include "core/run_control.h"

namespace vantage {

/// Initial scan and scanning motion (D-B27, D-B28).
struct ScanConfig {
  int initial_frames = 30;          ///< >= 1; of a data set: recorded frames taken at the start
  double initial_arc_m = 0.6;       ///< length of the arc, metres
  double initial_distance_m = 1.0;  ///< to the scene centre, metres
  double initial_elevation_rad = 0.52359877559829887;  ///< radians; 30 deg
  double initial_azimuth_rad = -1.5707963267948966;    ///< of the arc's middle from +x, radians; -y
  Eigen::Vector3d scene_center_m = {0.0, 0.0, 0.10};   ///< world
  double clear_radius_m = 0.3;                         ///< start bubble, metres
  int frames = 15;                                     ///< per NBV
  double tilt_rad = 0.05235987755982988;               ///< amplitude of the tilt, radians; 3 deg
  bool operator==(const ScanConfig&) const = default;
  void validate() const;
};

struct ExplorationConfig {
  /// Planner of each NBV in turn, not empty; the last one goes on.
  std::vector<PlannerKind> planners = {PlannerKind::Contour};
  ContourPlannerConfig contour;  ///< its segment_by_segment follows the planner of the step
  HierarchicalPlannerConfig hierarchical;
  OctreeMapConfig octree;
  DepthFilterConfig filter;  ///< of every frame before it is fused
  FusionConfig fusion;
  ScanConfig scan;
  GridGeometry volume = {{-1.5, -1.0, -0.05}, 3.0 / 512.0, {512, 341, 200}};
  Box workspace = {Eigen::Vector3d(-1.0, -0.66, 0.0), Eigen::Vector3d(1.0, 0.66, 1.0)};
  int steps = 5;                     ///< NBVs
  bool enforce_reachability = true;  ///< false: obstacles and paths are only reported (replayed data)
  /// Recorded data: how near a frame must have been taken to serve a view, metres and radians; 0 = the
  /// nearest frame serves, however far.
  double serve_distance_m = 0.0;
  double serve_angle_rad = 0.17453292519943295;  ///< 10 deg
  bool recorded_candidates =
      false;  ///< recorded data: the poses left are candidates of the hierarchical planner
  std::uint64_t seed = 1;
  void validate() const;

  PlannerKind plannerOf(int step) const;  ///< step >= 1
  bool needsVolume() const;               ///< some planner works on the TSDF
  bool needsOctree() const;               ///< some planner works on the octree
  /// Recorded data: a frame that is left was taken near enough to serve a view (evaluation.md, A3).
  bool serves(const std::vector<ScanPose>& left, const Pose& view) const;
  /// The object's box: OctreeMapConfig::object_box, else the workspace.
  Box objectBox() const;
  /// What the maps are made of.
  WorldConfig world() const;
};

struct ExplorationResult {
  std::string stop_reason;  ///< "steps done", "finished", "no frames left", "cancelled" or "device lost"
  int steps = 0;            ///< records completed
  std::string lost = {};    ///< of a run that failed: which device was lost, and what it did last
};

/// The exploration loop. Owns the maps; publishes a growing record after every stage.
class Explorer {
 public:
  /// \param truth may be null.
  Explorer(ExplorationConfig config, DepthCamera& camera, Robot& robot, const GroundTruth* truth);
  ~Explorer();

  void addObserver(StepObserver observer);

  /// Runs all steps and the closing scan. On cancellation the records published as Stage::Done stay valid and
  /// the result says "cancelled"; when a device is lost, "device lost".
  ExplorationResult run(const RunControl& control);

  const WorldModel& world() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Camera poses of the initial scan: an arc around the scene centre.
std::vector<Pose> initialScanPoses(const ScanConfig& config);

/// Camera poses of the scan at a view: the view tilted about its image x axis along one period of a sine.
std::vector<Pose> tiltedScanPoses(const Pose& T_world_camera, const ScanConfig& config);

}  // namespace vantage
