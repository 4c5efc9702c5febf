#pragma once

#include "core/exploration/explorer.h"
#include "core/exploration/map_metrics.h"

namespace vantage {

/// Measures the maps of a run against the truth, if there is one (evaluation.md, section 2). Keeps references
/// to what it is made of.
class RunMeter {
 public:
  /// \param truth may be null
  RunMeter(const ExplorationConfig& config, const WorldModel& world, const GroundTruth* truth);

  /// Unknown space, of the TSDF if it is kept, and what the object's box holds.
  void measureMap(StepRecord& record) const;
  /// By the fused surface, or by occupied voxels where the octree is the only map.
  void measureCoverage(StepRecord& record) const;
  /// Whether the view that was chosen looks at an object.
  void markTowardObject(StepRecord& record) const;
  /// Unknown voxels of the region that the step's planner wants to see.
  std::uint64_t unknownInRegion(const StepRecord& record) const;

 private:
  const ExplorationConfig& config_;
  const WorldModel& world_;
  const GroundTruth* truth_;
  Box object_box_;
  MapMetricsCounter counter_;
};

}  // namespace vantage
