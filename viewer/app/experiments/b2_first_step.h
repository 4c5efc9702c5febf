#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/exploration/step_record.h"
#include "io/run_file.h"
#include "viewer/app/experiments/b1_segments.h"
#include "viewer/app/experiments/experiments.h"

namespace vantage::experiments {

/// Scene S1 when its first view is chosen, and on which objects the segments lie.
struct FirstStep {
  RunHeader header;  ///< camera, volume, workspace and planner; the rest is empty
  std::shared_ptr<const StepRecord> record;
  TsdfVolume volume;             ///< on which the view was planned
  StateGrid states;              ///< of it
  std::vector<SegmentRow> rows;  ///< one a group of contour points, in the order of ViewSearch::segments
};

/// The initial scan with the experiment's settings and seed 1, and what is planned on it; a few seconds.
/// Needs no run that was kept. \param changes settings of the variant, "key=value" \throws Cancelled
FirstStep firstStep(const ExperimentOptions& options, const std::vector<std::string>& changes = {});

}  // namespace vantage::experiments
