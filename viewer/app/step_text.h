#pragma once

#include <string>

#include "core/exploration/step_record.h"

namespace vantage::app {

/// One line about the last stage of a record, for the log: step, stage, count, duration.
std::string stageText(const StepRecord& record);

/// Which recorded frame served the view of a step at Stage::Realised, and how far from it; one line.
std::string servedText(const StepRecord& record);

/// What a finished step did and why, for people; two lines.
/// \param stop_gain h_stop of the hierarchical planner
std::string stepText(const StepRecord& record, double stop_gain);

}  // namespace vantage::app
