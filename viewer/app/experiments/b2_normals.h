#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viewer/app/experiments/b2_first_step.h"

namespace vantage::experiments {

/// What the poses of an object's contour points gain that look against one kind of normal, reachable or not.
struct ObjectGain {
  std::uint64_t contour_points = 0;
  double best = 0.0;  ///< of the best pose, rays; 0 without contour points
  double mean = 0.0;  ///< over the contour points, of each one's best pose
};

/// View C against view B (D-B5) at one object.
struct NormalsAtObject {
  std::string object;
  ObjectGain frontier, surface;
  /// Gain with surface normals / with frontier normals; 0 if the latter gain nothing.
  double ratio(double ObjectGain::*gain) const {
    return frontier.*gain > 0.0 ? surface.*gain / frontier.*gain : 0.0;
  }
};

/// Both kinds of normals at every object that has a segment of its own, in the order in which they are tried.
/// The segments are those of the step, the contour points are found anew.
std::vector<NormalsAtObject> compareNormals(const FirstStep& first);

/// B2 (a): a row for each object.
Table normalsTable(const std::vector<NormalsAtObject>& objects);
/// Less at sharp edges (the boxes of S1), about as much at round objects.
Claim judgeNormals(const std::vector<NormalsAtObject>& objects);

}  // namespace vantage::experiments
