#pragma once

#include <optional>
#include <vector>

#include "viewer/scene_frame.h"
#include "viewer/view_settings.h"

namespace vantage {

/// The rays of one candidate view as the hierarchical planner cast them.
struct ViewTrace {
  const ViewUtility* view = nullptr;  ///< never null in a trace that was made
  int coarse_levels = 0;              ///< m of the step's planner
  RayCounts counts = {};
  std::vector<TracedRay> rays = {};  ///< in the order in which they were cast
};

/// The view whose rays are drawn: that of the style, else the chosen one, else the best; null if the step has
/// no candidates on an octree. \throws InputError naming the range if the style asks for a view
/// that is no candidate.
const ViewUtility* tracedView(const SceneFrame& frame, const LayerStyle& style);

/// Casts the rays of that view again; empty if there is none.
std::optional<ViewTrace> traceView(const SceneFrame& frame, const LayerStyle& style);

/// Rays of the starting level that are drawn, at most style.coarse_rays, every n-th row and column, and the
/// rays below them: indices into the trace, ascending.
struct DrawnRays {
  std::vector<std::size_t> coarse, refined;
};
DrawnRays thinned(const ViewTrace& trace, const RayTree& tree, int most);

/// Unit direction of a ray in the sensor's frame.
Eigen::Vector3d directionOf(const RayTree& tree, const TracedRay& ray);

/// Different nodes of a level on which rays with a fate end, ascending by index.
std::vector<std::size_t> nodesHit(const ViewTrace& trace, const StatePyramid& pyramid, int level,
                                  RayFate fate);

}  // namespace vantage
