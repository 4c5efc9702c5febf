#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/exploration/planner_kind.h"
#include "core/exploration/step_record.h"
#include "core/volume/occupancy_octree.h"
#include "core/volume/state_pyramid.h"
#include "core/volume/tsdf_volume.h"

namespace vantage {

/// The probabilistic map of the hierarchical planner.
struct OctreeMapConfig {
  double voxel_size_m = 0.01;  ///< l, edge of a finest voxel, metres
  /// OBB (section 1): what is to be reconstructed. Unknown at the start, and only hits in it count. A box
  /// without volume stands for the workspace.
  Box object_box = Box(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  VoxelState outside = VoxelState::Free;  ///< everything else at the start (D-A10): Free or Unknown
  /// Simulation: table, panel and room are in the map from the start, outside the object's box (10.4: "room,
  /// walls, table known"); otherwise a view from below a table looks through it until it was scanned from
  /// there.
  bool known_scene = false;
  OccupancyConfig occupancy;
  void validate() const;
};

/// Which maps a run keeps and how.
struct WorldConfig {
  bool keep_volume = true;
  bool keep_octree = false;
  GridGeometry volume;  ///< of the TSDF; its bounds are those of the octree too
  FusionConfig fusion;
  OctreeMapConfig octree;
  Box object_box;         ///< of the octree, with volume
  int coarse_levels = 0;  ///< of the pyramid
};

/// Products of a scan that a run stores.
struct MapChanges {
  std::shared_ptr<const std::vector<TsdfBrick>> volume;    ///< null if that map is not kept
  std::shared_ptr<const std::vector<OctreeBrick>> octree;  ///< the same
};

/// Balls around the sensor that are taken as empty, since it is there (D-B28): radii, metres, 0 = none.
struct SensorBubble {
  double volume_m = 0.0;
  double octree_m = 0.0;  ///< only where everything is unknown at the start
};

/// The maps that the planners of a run need. Every frame goes into all of them.
class WorldModel {
 public:
  /// \throws std::invalid_argument, std::runtime_error as the maps do.
  explicit WorldModel(const WorldConfig& config);

  /// Fuses one depth image.
  void fuse(const DepthImage& depth, const Pose& T_world_camera, const PinholeCamera& camera,
            const SensorBubble& bubble);
  /// Takes a ball as empty where the octree knows nothing: a recorded sensor has been there.
  void clearOctree(const Eigen::Vector3d& center_world, double radius_m);
  /// Marks the octree's voxels outside the object's box as occupied whose centre lies in `box` and `inside`.
  void occupyOctree(const Box& box, const std::function<bool(const Eigen::Vector3d&)>& inside);
  /// Brings the state grids up to date; what changed since the last call. The octree's initial content counts
  /// as changed the first time.
  MapChanges finishScan();

  const TsdfVolume* volume() const { return volume_ ? &*volume_ : nullptr; }
  const StateGrid* surfaceStates() const { return volume_ ? &states_ : nullptr; }
  const OccupancyOctree* octree() const { return octree_ ? &*octree_ : nullptr; }
  const StatePyramid* pyramid() const { return octree_ ? &pyramid_ : nullptr; }
  /// Of the map that a planner works on. \pre it is kept
  const StateGrid& statesOf(PlannerKind kind) const { return usesOctree(kind) ? pyramid_.finest() : states_; }

 private:
  WorldConfig config_;
  std::optional<TsdfVolume> volume_;
  StateGrid states_;
  BrickSet volume_changed_;
  std::optional<OccupancyOctree> octree_;
  StatePyramid pyramid_;
  BrickSet octree_changed_;
};

}  // namespace vantage
