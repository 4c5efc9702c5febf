#include "viewer/app/experiments/evaluation_time.h"

#include <algorithm>

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

double evaluationTime_s(const UtilityInput& input, const HierarchicalPlannerConfig& config, double first_s,
                        int repeats, const RunControl& control) {
  if (first_s >= 1.0 || repeats < 1) return first_s;
  const ReachPose nowhere = [](const Pose&) { return MotionPlan{}; };
  HierarchicalPlannerConfig alone = config;
  alone.stop_gain = 1e9;  // nothing is chosen, so nothing but the evaluation is done
  std::vector<double> times;
  for (int n = 0; n < repeats; ++n)
    times.push_back(searchUtility(input, alone, nowhere, control).evaluation_s);
  return median(std::move(times));
}

}  // namespace vantage::experiments
