#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/motion/robot_model.h"

namespace vantage {

/// A query for a point in space or a configuration of joints; all vectors have the same size, 1 ..
/// kMaxArmJoints. Start and goal must be valid.
struct RrtQuery {
  JointVector start, goal;
  JointVector lower, upper;  ///< of the samples; they hold start and goal
  std::function<bool(const JointVector&)> valid;
  std::function<bool(const JointVector&, const JointVector&)> segment_valid;
  double range = 0.3;           ///< longest tree edge, Euclidean, in the unit of the values
  int iterations = 4000;        ///< samples drawn at most
  double safety_time_s = 30.0;  ///< wall clock abort
  std::uint64_t seed = 1;
};

struct RrtResult {
  std::vector<JointVector> path;  ///< from start to goal, empty if none was found
  int iterations = 0;             ///< samples drawn
  bool timed_out = false;         ///< the wall clock struck first
};

/// RRT-Connect of OMPL with samples of our own generator: the result depends on the query alone, unless it
/// timed out.
RrtResult rrtConnect(const RrtQuery& query);

}  // namespace vantage
