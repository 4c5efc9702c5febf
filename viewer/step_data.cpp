#include "viewer/step_data.h"

namespace vantage {

PlannerKind plannerKindOf(const RunHeader& header, const StepRecord& record) {
  const std::string& names = record.planner.empty() ? header.planner : record.planner;
  return names.empty() ? PlannerKind::Contour : plannersFromText(names).front();
}

}  // namespace vantage
