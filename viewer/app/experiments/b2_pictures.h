#pragma once

#include "viewer/app/experiments/experiments.h"

namespace vantage::experiments {

/// Adds the saliency comparisons of B2 as pictures (Fig. 9 and 10) to its report: scene S1 after the initial
/// scan with seed 1, which is made here, so that they do not depend on runs that were kept. One camera and
/// one colour scale, 0 to 1. Where there can be none (interrupted, no OpenGL), a note says why.
void addSaliencyPictures(const ExperimentOptions& options, Report& report);

}  // namespace vantage::experiments
