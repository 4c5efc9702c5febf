#pragma once

#include <optional>

#include "viewer/scene_frame.h"

namespace vantage {

/// The maps of a recorded run as they are drawn, step after step: the TSDF's states for planners that work on
/// it, the octree's for the others. A map is made when a step first needs it and brought forward once per
/// step.
class StepMaps {
 public:
  /// The reader must outlive the maps.
  explicit StepMaps(const RunReader& reader) : reader_(reader) {}

  /// Brings the map of the record's planner to its step. Steps must ascend. The frame refers to the record
  /// and these maps, until the next call. \throws InputError, std::runtime_error as RunReader does.
  SceneFrame at(const StepRecord& record);

 private:
  void advanceVolume(int step);
  void advanceOctree(int step);

  const RunReader& reader_;
  std::optional<TsdfVolume> volume_;
  StateGrid states_;
  int volume_step_ = 0;
  std::optional<OccupancyOctree> octree_;
  StatePyramid pyramid_;
  RayTree tree_;
  int octree_step_ = 0;
};

/// Planner of a recorded step; of the run's first if the record does not say.
PlannerKind plannerKindOf(const RunHeader& header, const StepRecord& record);

}  // namespace vantage
