#pragma once

#include <string>

#include "core/exploration/step_record.h"

namespace vantage::app {

/// One line about the last stage of a record, for the log: step, stage, count, duration.
std::string stageText(const StepRecord& record);

/// Which recorded frame served the view of a step at Stage::Realised, and how far from it; one line.
std::string servedText(const StepRecord& record);

/// What a finished step did and why, for people; one line.
std::string stepText(const StepRecord& record);

}  // namespace vantage::app
