#pragma once

#include <vector>

#include "core/planners/hierarchical_planner.h"

namespace vantage::experiments {

/// Median; 0 for none.
double median(std::vector<double> values);

/// The candidates of an evaluation that has been made.
std::vector<ViewCandidate> candidatesOf(const UtilitySearch& search);

/// Wall-clock seconds of the evaluation stage on the inputs of a step (evaluation.md, section 1): a first
/// evaluation of a second or more stands, a shorter one was the warm-up, and the median of `repeats` counts.
double evaluationTime_s(const UtilityInput& input, const HierarchicalPlannerConfig& config, double first_s,
                        int repeats, const RunControl& control);

}  // namespace vantage::experiments
