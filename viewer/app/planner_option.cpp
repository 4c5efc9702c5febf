#include "core/exploration/planner_kind.h"
#include "viewer/app/command.h"

namespace vantage::app {

CLI::Validator isPlanner() {
  std::string names;
  for (const PlannerKind kind : kPlannerKinds)
    names += (names.empty() ? "" : "|") + std::string(toString(kind));
  return {[](const std::string& text) -> std::string {
            try {
              plannersFromText(text);
              return {};
            } catch (const std::invalid_argument& error) {
              return error.what();
            }
          },
          names, "planner"};
}

}  // namespace vantage::app
