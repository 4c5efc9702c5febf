#pragma once

#include <vector>

#include "core/planners/hierarchical_planner.h"

namespace vantage::experiments {

/// Median; 0 for none.
double median(std::vector<double> values);

/// The candidates of an evaluation that has been made.
std::vector<ViewCandidate> candidatesOf(const UtilitySearch& search);

/// Seconds of one evaluation stage.
struct EvaluationTime {
  double wall_s = 0.0;
  double cpu_s = 0.0;  ///< of all threads: on a shared machine it tells more than the clock on the wall
};

/// Times the evaluation stage on the inputs of a step (evaluation.md, section 1). Wall clock: a first
/// evaluation of a second or more stands, a shorter one was the warm-up, and the median of `repeats` counts.
/// With no repeats nothing is measured: the first evaluation stands, and there is no CPU time.
/// \param first the step's own evaluation
/// \throws std::logic_error if the inputs are not the step's: other views are scored
EvaluationTime evaluationTime(const UtilityInput& input, const HierarchicalPlannerConfig& config,
                              const UtilitySearch& first, int repeats, const RunControl& control);

}  // namespace vantage::experiments
