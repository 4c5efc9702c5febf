#pragma once

#include <memory>

#include "core/exploration/planner_kind.h"
#include "viewer/scene_frame.h"

namespace vantage {

/// One step as the window shows it, or a file shown like one: immutable, shared between threads. Copies are
/// cheap and keep what they share alive.
struct StepData {
  std::shared_ptr<const RunHeader> header;
  std::shared_ptr<const StepRecord> record;
  std::shared_ptr<const StateGrid> states;        ///< of the map that the step was planned on
  std::shared_ptr<const TsdfVolume> volume;       ///< null for octree planners
  std::shared_ptr<const OccupancyOctree> octree;  ///< null for contour planners
  std::shared_ptr<const StatePyramid> pyramid;    ///< all levels; null unless planned on the octree
  std::shared_ptr<const RayTree> tree;            ///< null unless planned on the octree

  /// Nothing is shown; frame() must not be called.
  bool empty() const { return !header || !record || !states; }
  /// Refers to this data, which must outlive the frame's use; any copy of it keeps it alive. \pre !empty()
  SceneFrame frame() const {
    return {*header, *record, *states, &header->truth, pyramid.get(), tree.get(), states};
  }
};

/// Planner of a recorded step; of the run's first if the record does not say. \throws std::invalid_argument
/// for a name that is not known.
PlannerKind plannerKindOf(const RunHeader& header, const StepRecord& record);

/// What the step did not know of the workspace, cubic metres: planners count it in voxels of their own map.
/// Of a planner that is not known, as if in voxels of the volume.
double unknownVolume_m3(const RunHeader& header, const StepSummary& step);

}  // namespace vantage
