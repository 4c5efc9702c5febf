#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/geometry/grid_geometry.h"

namespace vantage {

/// A query for a point in space. Start and goal must be valid.
struct RrtQuery {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d goal = Eigen::Vector3d::Zero();
  Box bounds;  ///< of the samples; holds start and goal
  std::function<bool(const Eigen::Vector3d&)> valid;
  std::function<bool(const Eigen::Vector3d&, const Eigen::Vector3d&)> segment_valid;
  double range_m = 0.3;         ///< longest tree edge
  int iterations = 4000;        ///< samples drawn at most
  double safety_time_s = 30.0;  ///< wall clock abort
  std::uint64_t seed = 1;
};

struct RrtResult {
  std::vector<Eigen::Vector3d> path;  ///< from start to goal, empty if none was found
  int iterations = 0;                 ///< samples drawn
  bool timed_out = false;             ///< the wall clock struck first
};

/// RRT-Connect of OMPL with samples of our own generator: the result depends on the query alone, unless it
/// timed out.
RrtResult rrtConnect(const RrtQuery& query);

}  // namespace vantage
