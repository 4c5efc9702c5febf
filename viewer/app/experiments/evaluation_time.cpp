#include "viewer/app/experiments/evaluation_time.h"

#include <algorithm>
#include <ctime>
#include <stdexcept>

namespace vantage::experiments {

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

std::vector<ViewCandidate> candidatesOf(const UtilitySearch& search) {
  std::vector<ViewCandidate> candidates;
  candidates.reserve(search.views.size());
  for (const ViewUtility& view : search.views)
    candidates.push_back({view.id, view.T_world_camera, view.frame});
  return candidates;
}

EvaluationTime evaluationTime(const UtilityInput& input, const HierarchicalPlannerConfig& config,
                              const UtilitySearch& first, int repeats, const RunControl& control) {
  if (repeats < 1) return {first.evaluation_s, 0.0};
  const ReachPose nowhere = [](const Pose&) { return MotionPlan{}; };
  HierarchicalPlannerConfig alone = config;
  alone.stop_gain = 1e9;  // nothing is chosen, so nothing but the evaluation is done
  const bool long_enough = first.evaluation_s >= 1.0;
  std::vector<double> wall, cpu;
  for (int n = 0; n < (long_enough ? 1 : repeats); ++n) {
    const std::clock_t start = std::clock();
    const UtilitySearch again = searchUtility(input, alone, nowhere, control);
    wall.push_back(again.evaluation_s);
    cpu.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    if (again.counts.poses_scored != first.counts.poses_scored ||
        again.counts.voxels_visited != first.counts.voxels_visited)
      throw std::logic_error("the evaluation that is timed is not the step's own");
  }
  return {long_enough ? first.evaluation_s : median(std::move(wall)), median(std::move(cpu))};
}

}  // namespace vantage::experiments
