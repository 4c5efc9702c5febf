#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/exploration/step_record.h"
#include "core/volume/state_pyramid.h"
#include "io/run_file.h"
#include "viewer/view_settings.h"

namespace vantage {

/// One step of a run as it is drawn. Refers to what it shows; all of it must outlive the frame's use.
struct SceneFrame {
  const RunHeader& header;
  const StepRecord& record;
  const StateGrid& states;              ///< of the map that the step was planned on
  const TriangleMesh* truth = nullptr;  ///< null if not known
  /// The octree's nodes at all levels, null if the step was not planned on it; `states` is its finest level.
  const StatePyramid* pyramid = nullptr;
  const RayTree* tree = nullptr;  ///< rays of the hierarchical planner; null if there are none
  /// Stands for the content of `states` and `pyramid`, which is never changed under it: layers of the map are
  /// kept when the next frame has the same. Null = not known, nothing of the map is kept.
  std::shared_ptr<const void> map = nullptr;
};

/// Name of the planner of a step.
const std::string& plannerOf(const SceneFrame& frame);

/// The step was planned on the octree, which is there to be drawn.
bool onOctree(const SceneFrame& frame);

/// Coarse levels at which the step's planner began to trace: the configured ones, 0 for the uniform baseline.
/// \pre onOctree()
int coarseLevels(const SceneFrame& frame);

/// Nodes that are in the object's box: their centres lie in this one. A node is in the box if it intersects
/// it, a finest voxel if its centre is inside (D-A8). \pre onOctree()
Box nodesInBox(const SceneFrame& frame, int level);

/// Where occupied voxels are drawn: the workspace and a little under it, its floor. Empty without one.
Box occupiedBox(const SceneFrame& frame);

/// Where slices are drawn: the part of the grid in the workspace.
Box slicedBox(const SceneFrame& frame);

/// What a candidate of the step sees: the planner's ray sensor on the octree, else the camera.
PinholeCamera viewCamera(const SceneFrame& frame);

/// The search that the pictures of views are about: the chosen one's, else the last that was scored, else
/// null.
const SegmentSearch* shownSearch(const StepRecord& record);

/// The path planner was asked and said no.
constexpr bool isUnreachable(Reachability reachability) {
  return reachability != Reachability::Reachable && reachability != Reachability::NotChecked;
}

/// A view position with the best of its rolls.
struct RankedPosition {
  Pose T_world_camera = Pose::Identity();
  double gain = 0.0;  ///< rays, or utility
  std::uint32_t id = 0;
  Reachability reachability = Reachability::NotChecked;
  bool executed_before = false;
  bool unreachable() const { return isUnreachable(reachability); }
};

/// Pose of any candidate of the step, of whichever planner; nothing if there is no such candidate.
std::optional<Pose> poseOfCandidate(const SceneFrame& frame, std::uint32_t id);

/// Candidates of the contour planners at one position: their ids are its index times this, and the roll.
std::uint32_t rollsOf(const RunHeader& header);
/// Position of a candidate of the contour planners; null if there is none.
const ViewPosition* positionOf(const SceneFrame& frame, std::uint32_t id);
/// The search that such a candidate belongs to, scored or not: an index into ViewSearch::segments (D-B33).
std::optional<std::uint32_t> groupOf(const SceneFrame& frame, std::uint32_t id);

/// Positions of a search by decreasing gain, each once with its best roll; those below the gain threshold are
/// left out.
std::vector<RankedPosition> rankedPositions(const SceneFrame& frame, const SegmentSearch& search);

/// Views by decreasing utility.
std::vector<RankedPosition> rankedViews(const UtilitySearch& search);

/// The ranked views of the step's shown search or utilities that are drawn: style.ranked_views that can be
/// reached, and style.unreachable_views better ones that cannot.
std::vector<RankedPosition> drawnViews(const SceneFrame& frame, const LayerStyle& style);

/// Distance from the chosen view to what it looks at: its contour point, else the middle of the object's box,
/// metres. \pre the record has a view
double lookDistance(const SceneFrame& frame);

/// How long the frustum of the chosen view is drawn, metres. \pre the record has a view
double chosenFrustumLength(const SceneFrame& frame);

}  // namespace vantage
