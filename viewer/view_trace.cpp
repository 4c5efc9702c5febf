#include "viewer/view_trace.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "io/error.h"

namespace vantage {
namespace {

struct RayPlace {
  std::uint32_t row = 0, column = 0;
};

/// The ray of the starting level above a ray.
RayPlace startOf(const RayTree& tree, const TracedRay& ray, int coarse_levels) {
  RayPlace at{ray.ray / tree.level(ray.level).columns.count(),
              ray.ray % tree.level(ray.level).columns.count()};
  for (int level = ray.level; level < coarse_levels; ++level) {
    at.row = tree.level(level).rows.parent[at.row];
    at.column = tree.level(level).columns.parent[at.column];
  }
  return at;
}

}  // namespace

const ViewUtility* tracedView(const SceneFrame& frame, const LayerStyle& style) {
  if (!onOctree(frame) || !frame.record.utilities || frame.record.utilities->views.empty()) return nullptr;
  const UtilitySearch& search = *frame.record.utilities;
  if (style.view_id) {
    const auto found =
        std::ranges::find(search.views, static_cast<std::uint32_t>(*style.view_id), &ViewUtility::id);
    if (found == search.views.end())
      throw InputError("view_id = " + std::to_string(*style.view_id),
                       "is no candidate of step " + std::to_string(frame.record.step) + "; allowed: 0 .. " +
                           std::to_string(search.views.size() - 1));
    return &*found;
  }
  if (const ViewUtility* chosen = chosenUtility(search)) return chosen;
  return search.ranking.empty() ? nullptr : &search.views[search.ranking.front()];
}

std::optional<ViewTrace> traceView(const SceneFrame& frame, const LayerStyle& style) {
  const ViewUtility* view = tracedView(frame, style);
  if (!view) return std::nullopt;
  const HierarchicalPlannerConfig& config = frame.header.octree->planner;
  ViewTrace trace{.view = view, .coarse_levels = coarseLevels(frame)};
  const HierarchicalQuery query = queryOf(frame.header.octree->object_box, config);
  trace.counts = traceHierarchical(*frame.pyramid, *frame.tree, trace.coarse_levels, view->T_world_camera,
                                   query, trace.rays);
  return trace;
}

DrawnRays thinned(const ViewTrace& trace, const RayTree& tree, int most) {
  const RayLevel& start = tree.level(trace.coarse_levels);
  const double share = static_cast<double>(start.count()) / std::max(1, most);
  const auto stride = static_cast<std::uint32_t>(std::max(1.0, std::ceil(std::sqrt(share))));
  DrawnRays drawn;
  for (std::size_t i = 0; i < trace.rays.size(); ++i) {
    const TracedRay& ray = trace.rays[i];
    const RayPlace above = startOf(tree, ray, trace.coarse_levels);
    if (above.row % stride != stride / 2 || above.column % stride != stride / 2) continue;
    (ray.level == trace.coarse_levels ? drawn.coarse : drawn.refined).push_back(i);
  }
  return drawn;
}

Eigen::Vector3d directionOf(const RayTree& tree, const TracedRay& ray) {
  const RayLevel& level = tree.level(ray.level);
  return level.direction(ray.ray / level.columns.count(), ray.ray % level.columns.count());
}

std::vector<std::size_t> nodesHit(const ViewTrace& trace, const StatePyramid& pyramid, int level,
                                  RayFate fate) {
  std::vector<std::size_t> nodes;
  for (const TracedRay& ray : trace.rays) {
    if (ray.level == level && ray.fate == fate && (ray.node.array() >= 0).all())
      nodes.push_back(pyramid.level(level).geometry().index(ray.node));
  }
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace vantage
