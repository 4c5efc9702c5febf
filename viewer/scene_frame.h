#pragma once

#include <cstdint>
#include <vector>

#include "core/exploration/step_record.h"
#include "core/volume/state_grid.h"
#include "io/run_file.h"

namespace vantage {

/// One step of a run as it is drawn. Refers to what it shows; all of it must outlive the frame's use.
struct SceneFrame {
  const RunHeader& header;
  const StepRecord& record;
  const StateGrid& states;              ///< as the step was planned
  const TriangleMesh* truth = nullptr;  ///< null if not known
};

/// The search that the pictures of views are about: the chosen one's, else the last that was scored, else
/// null.
const SegmentSearch* shownSearch(const StepRecord& record);

/// A view position with the best of its rolls.
struct RankedPosition {
  Pose T_world_camera = Pose::Identity();
  double gain = 0.0;  ///< rays
  std::uint32_t id = 0;
  Reachability reachability = Reachability::NotChecked;
  bool executed_before = false;
  bool unreachable() const {
    return reachability != Reachability::Reachable && reachability != Reachability::NotChecked;
  }
};

/// Positions of a search by decreasing gain, each once with its best roll; those below the gain threshold are
/// left out.
std::vector<RankedPosition> rankedPositions(const SceneFrame& frame, const SegmentSearch& search);

/// Pose of a candidate view; identity if its position is not in the record.
Pose candidatePose(const SceneFrame& frame, std::uint32_t id);

}  // namespace vantage
