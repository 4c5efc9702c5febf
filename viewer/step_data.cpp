#include "viewer/step_data.h"

#include <cmath>
#include <stdexcept>

namespace vantage {
namespace {

PlannerKind plannerNamed(const RunHeader& header, const std::string& of_step) {
  const std::string& names = of_step.empty() ? header.planner : of_step;
  return names.empty() ? PlannerKind::Contour : plannersFromText(names).front();
}

/// Also of planners that are not known here.
bool onOctree(const RunHeader& header, const std::string& of_step) {
  try {
    return header.octree && usesOctree(plannerNamed(header, of_step));
  } catch (const std::invalid_argument&) {
    return false;
  }
}

}  // namespace

PlannerKind plannerKindOf(const RunHeader& header, const StepRecord& record) {
  return plannerNamed(header, record.planner);
}

double unknownVolume_m3(const RunHeader& header, const StepSummary& step) {
  const double edge_m =
      onOctree(header, step.planner) ? header.octree->map.voxel_size_m : header.volume.voxel_size_m;
  return static_cast<double>(step.unknown_voxels) * std::pow(edge_m, 3);
}

}  // namespace vantage
