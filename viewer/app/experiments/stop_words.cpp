#include "viewer/app/experiments/stop_words.h"

#include <fmt/format.h>

namespace vantage::experiments {
namespace {

std::string finishedWords(const UtilitySearch& last, double stop_gain) {
  switch (endOf(last, stop_gain)) {
    case SearchEnd::NoSurvivor:
      if (last.views.empty()) return "no candidates";
      return fmt::format("no view survives: {} by position, {} by registration, {} taken before",
                         last.rejected_position, last.rejected_registration,
                         last.counts.poses_executed_before);
    case SearchEnd::LittleUnknown:
      return fmt::format("no view sees h_stop: {:g} unknown at most, {:g} asked for", last.best_unknown,
                         stop_gain);
    case SearchEnd::Unreachable:
      return fmt::format("no view that shows enough can be reached: {} tried", last.counts.paths_planned);
    case SearchEnd::Chosen:
      break;
  }
  return "";
}

}  // namespace

std::string stopWords(const ExplorationResult& ended, const UtilitySearch* last, double stop_gain) {
  if (ended.stop_reason == kStepsDone) return fmt::format("cut off after {} steps", ended.steps);
  if (ended.stop_reason != "finished" || !last) return ended.stop_reason;
  const std::string words = finishedWords(*last, stop_gain);
  return words.empty() ? ended.stop_reason : "finished: " + words;
}

}  // namespace vantage::experiments
