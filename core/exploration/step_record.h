#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/exploration/ports.h"
#include "core/perception/depth_filters.h"
#include "core/planners/contour_planner.h"
#include "core/planners/hierarchical_planner.h"
#include "core/volume/tsdf_volume.h"

namespace vantage {

/// Stages of a step in the order in which they are done and published. `Done`: the step is complete and ready
/// to be stored. `Realised`: the scan at its view has been fused by the next step, so realised_voxels and
/// served are known.
enum class Stage {
  Sense,
  Fuse,
  Contours,
  Surface,
  Segmentation,
  Saliency,
  Generation,
  Evaluation,
  Motion,
  Done,
  Realised
};
std::string_view toString(Stage stage);

/// Wall-clock seconds of each phase; absent = the phase did not run.
struct Timings {
  std::optional<double> sense, filter, fuse, contours, surface, segmentation, saliency, generation,
      evaluation, collision_map, motion_planning, motion;
};

/// One brick of the volume as it is after this step's fusion.
struct TsdfBrick {
  std::uint32_t brick = 0;
  std::vector<TsdfVoxel> voxels;
};

/// One brick of the octree's finest voxels as it is after this step's fusion.
struct OctreeBrick {
  std::uint32_t brick = 0;
  std::vector<float> log_odds;  ///< x fastest within the brick; NaN = not stored, i.e. unknown
};

/// Numbers that describe the map after a scan: of the TSDF, or of the octree if that is the only map.
struct MapMetrics {
  std::uint64_t unknown_voxels = 0;                   ///< in the workspace
  std::optional<std::uint64_t> unknown_near_objects;  ///< U_tau, needs ground truth
  std::optional<std::uint64_t> unknown_in_boxes;      ///< U_box, needs ground truth
  std::optional<double> coverage;                     ///< share in [0,1], needs ground truth
};

/// Octree voxels in the object's box after a scan.
struct BoxMetrics {
  std::uint64_t unknown = 0;
  std::uint64_t occupied = 0;
};

/// Everything about one step: scan, map, products of every planning stage, decision and motion. Products are
/// shared and immutable; a record only ever grows. Step k >= 1 plans NBV k; the closing record holds the scan
/// taken at the last view.
struct StepRecord {
  int step = 1;
  bool closing = false;
  Stage stage = Stage::Sense;  ///< last stage that is complete
  std::string planner;         ///< name of the PlannerKind

  std::vector<ScanPose> scan;
  std::shared_ptr<const std::vector<JointVector>> joints;        ///< of an arm, for each scan pose; else null
  std::shared_ptr<const DepthFrame> depth;                       ///< last frame of the scan
  std::shared_ptr<const FilteredDepth> filtered;                 ///< its filtered image; null without filters
  std::shared_ptr<const std::vector<TsdfBrick>> changed_bricks;  ///< since the step before; ascending
  std::shared_ptr<const std::vector<OctreeBrick>> changed_octree_bricks;  ///< the same, of the octree
  MapMetrics metrics;
  std::shared_ptr<const BoxMetrics> box;  ///< null without an octree

  std::shared_ptr<const Contours> contours;
  std::shared_ptr<const SurfaceCloud> surface;
  std::shared_ptr<const Labels> labels;
  std::shared_ptr<const Saliency> saliency;
  std::shared_ptr<const std::vector<std::uint32_t>> point_labels;  ///< segment label per contour point
  std::shared_ptr<const std::vector<ViewPosition>> positions;
  std::shared_ptr<const ViewSearch> search;        ///< of the contour planner and its baseline
  std::shared_ptr<const UtilitySearch> utilities;  ///< of the hierarchical planner and its baseline

  std::shared_ptr<const JointTrajectory> trajectory;  ///< that the arm was sent; null for others
  std::optional<bool> toward_object;                  ///< needs ground truth and a chosen view
  std::optional<std::uint64_t> realised_voxels;       ///< at Stage::Realised
  /// Replay: the frame that served the chosen view, at Stage::Realised.
  std::optional<ScanPose> served;
  Timings timings;

  /// The next best view, null if there is none.
  const ChosenView* chosen() const {
    if (search && search->chosen) return &*search->chosen;
    return utilities && utilities->chosen ? &*utilities->chosen : nullptr;
  }
  bool hasView() const { return chosen() != nullptr; }
  /// Work of the evaluation, null before it.
  const SearchCounts* counts() const {
    return search ? &search->counts : utilities ? &utilities->counts : nullptr;
  }
};

using StepObserver = std::function<void(std::shared_ptr<const StepRecord>)>;

}  // namespace vantage
