#pragma once

#include <string>
#include <string_view>

#include "core/exploration/explorer.h"

namespace vantage::experiments {

/// Stop reason of a run whose steps were used up.
inline constexpr std::string_view kStepsDone = "steps done";

/// Why a run of the hierarchical planner ended, in words for tables.
/// \param last the run's last search, null if there was none \param stop_gain h_stop
std::string stopWords(const ExplorationResult& ended, const UtilitySearch* last, double stop_gain);

}  // namespace vantage::experiments
