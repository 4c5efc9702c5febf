#pragma once

#include "viewer/app/experiments/b2_first_step.h"

namespace vantage::experiments {

/// Adds the saliency comparisons of B2 as pictures (Fig. 9 and 10) to its report. One camera and one colour
/// scale, 0 to 1. Where there can be none (no OpenGL), a note says why. \throws Cancelled
void addSaliencyPictures(const FirstStep& first, const RunControl& control, Report& report);

}  // namespace vantage::experiments
