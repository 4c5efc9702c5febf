#pragma once

#include <functional>
#include <span>

#include "core/exploration/step_record.h"
#include "core/run_control.h"

namespace vantage {

/// What one planning step needs to know.
struct PlanViewInput {
  const TsdfVolume& volume;
  const StateGrid& states;  ///< of the volume
  const PinholeCamera& camera;
  const Box& workspace;
  const ContourPlannerConfig& config;
  std::span<const Pose> executed = {};                  ///< poses taken so far (D-B15)
  std::span<const Eigen::Vector3d> disappointing = {};  ///< contour points not to be offered again (D-B33)
};

/// Algorithm 1, Monica & Aleotti 2017, one named call per stage: fills the planning products and timings of
/// `record` and calls `publish` after each of the stages Contours to Evaluation. The standard baseline skips
/// segmentation and saliency.
/// \throws Cancelled
void planView(StepRecord& record, const PlanViewInput& input, const ReachPose& reach,
              const std::function<void(Stage)>& publish, const RunControl& control);

}  // namespace vantage
