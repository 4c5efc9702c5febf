#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/exploration/stage_set.h"
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

/// What one planning step of the hierarchical planner needs to know.
struct PlanUtilityInput {
  const StatePyramid& pyramid;
  const RayTree& tree;
  const Box& object_box;
  const Box& workspace;  ///< the mapped space: workspace views are drawn in all of it (D-A16 drops many)
  std::span<const ScanPose> recorded = {};  ///< offered beside the generated candidates
  const Pose& current;                      ///< p.q of eq. 5
  const HierarchicalPlannerConfig& config;
  std::span<const Pose> executed = {};  ///< poses taken so far
  std::uint64_t seed = 1;               ///< of the step's workspace views
};

/// Seed of the path planner for the n-th pose tried in a step.
inline std::uint64_t pathSeed(std::uint64_t run_seed, int step, std::uint64_t tried) {
  return (run_seed << 32) + static_cast<std::uint64_t>(step) * 1000003 + tried;
}

/// Where the sensor cannot be at all (OutOfReach) no view is judged; with `enforce` off, on recorded data,
/// other obstacles are only reported: the pose counts as reachable and `reported` keeps the true plan.
MotionPlan judged(MotionPlan plan, bool enforce, MotionPlan& reported);

/// Puts the true plan of a chosen pose in the place of the one that let it be chosen (see judged()).
void reportMotion(StepRecord& record, const MotionPlan& reported);

/// Poses and contour points that later steps leave out because of a finished step (D-B15, D-B33).
struct Exclusions {
  std::vector<Pose> executed;
  std::vector<Eigen::Vector3d> disappointing;
  /// Takes over a step at Stage::Realised, or at Stage::Done if it was the last.
  void add(const StepRecord& record, const GainConfig& config);
};

/// Algorithm 1, Monica & Aleotti 2017, one named call per stage: fills the planning products and timings of
/// `record` and calls `publish` after each of the stages Contours to Evaluation. The standard baseline skips
/// segmentation and saliency.
/// \param stages those to do, with their dependents; the products of the others are taken from the record,
/// and segments that it keeps are scored anew for the configured B_th and weighting. The products of the
/// stages to do are dropped first: when they are cancelled the record holds no product of an older
/// configuration after one of a newer.
/// \throws Cancelled before, between and within stages; std::invalid_argument if the record lacks a product
/// that is to be kept
void planView(StepRecord& record, const PlanViewInput& input, const ReachPose& reach,
              const std::function<void(Stage)>& publish, const RunControl& control,
              const StageSet& stages = StageSet::from(Stage::Contours));

/// Steps 3-5 of Algorithm 1, Vasquez-Gomez et al. 2013: candidates, cascade, choice. Calls `publish` after
/// the stages Generation and Evaluation. The uniform baseline is the same with no coarse levels.
/// \param stages without Generation: the candidates are those of the recorded views
/// \throws Cancelled; std::invalid_argument if they are wanted and the record has none
void planUtility(StepRecord& record, const PlanUtilityInput& input, const ReachPose& reach,
                 const std::function<void(Stage)>& publish, const RunControl& control,
                 const StageSet& stages = StageSet::from(Stage::Generation));

}  // namespace vantage
