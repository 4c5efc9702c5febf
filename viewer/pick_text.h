#pragma once

#include <string>

#include "viewer/candidates.h"
#include "viewer/pick.h"
#include "viewer/step_data.h"

namespace vantage {

/// Everything that is known about what was picked, a line each: of a view its rank and score; of a segment
/// saliency, F, d_min and d_max; of a voxel index, state, TSDF and weight, or its occupancy in an octree.
/// \param rows candidateRows() of the step
std::string textOf(const Picked& picked, const StepData& step, const std::vector<CandidateRow>& rows);

}  // namespace vantage
