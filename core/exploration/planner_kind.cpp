#include "core/exploration/planner_kind.h"

#include <stdexcept>

namespace vantage {
namespace {

PlannerKind plannerNamed(std::string_view name) {
  std::string allowed;
  for (const PlannerKind kind : kPlannerKinds) {
    if (name == toString(kind)) return kind;
    allowed += (allowed.empty() ? "" : " | ") + std::string(toString(kind));
  }
  throw std::invalid_argument("'" + std::string(name) + "' is no planner; allowed: " + allowed +
                              ", or several with commas between them, one for each view");
}

}  // namespace

std::string_view toString(PlannerKind kind) {
  constexpr std::string_view kNames[] = {"contour", "standard", "hierarchical", "uniform"};
  return kNames[static_cast<int>(kind)];
}

std::vector<PlannerKind> plannersFromText(std::string_view text) {
  std::vector<PlannerKind> planners;
  for (;;) {
    const std::size_t comma = text.find(',');
    planners.push_back(plannerNamed(text.substr(0, comma)));
    if (comma == std::string_view::npos) return planners;
    text.remove_prefix(comma + 1);
  }
}

std::string plannersToText(const std::vector<PlannerKind>& planners) {
  std::string text;
  for (const PlannerKind kind : planners) text += (text.empty() ? "" : ",") + std::string(toString(kind));
  return text;
}

}  // namespace vantage
