#include "core/planners/hierarchical_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/geometry/check.h"
#include "core/planners/utility_selection.h"

namespace vantage {
namespace {

/// Voxels that an interval overlaps; a border shared with it is no overlap. A point has its own voxel.
std::pair<int, int> overlapped(double low, double high) {
  constexpr double kRounding = 1e-9;  // voxels
  const double first = std::floor(low + kRounding);
  return {static_cast<int>(first), static_cast<int>(std::max(first, std::ceil(high - kRounding) - 1))};
}

/// reg(v), eq. 2, or by the share of known surface (D-A15).
bool overlapsKnownSurface(const ViewUtility& view, const HierarchicalPlannerConfig& config) {
  if (config.min_overlap <= 0.0) return view.occupied >= config.min_occupied;
  const double seen = view.occupied + view.unknown;
  return seen > 0.0 && view.occupied >= config.min_overlap * seen;
}

}  // namespace

void HierarchicalPlannerConfig::validate() const {
  constexpr double kTiny = std::numeric_limits<double>::min();
  sensor.validate();
  requireInRange("rays.coarse_levels", coarse_levels, 0, StatePyramid::kMaxCoarseLevels);
  requireInRange("candidates.subdivisions", icosphere_subdivisions, 0, 6);
  requireInRange("candidates.radius_m", sphere_radius_m, kTiny, 1e6);
  requireInRange("candidates.workspace_views", workspace_views, 0, 10'000'000);
  requireInRange("utility.body_m", body_m, 0.0, 1000.0);
  requireInRange("utility.min_occupied", min_occupied, 0.0, 1e9);
  requireInRange("utility.min_overlap", min_overlap, 0.0, 1.0);
  requireInRange("utility.stop_gain", stop_gain, 0.0, 1e9);
  requireInRange("utility.executed_distance_m", executed_distance_m, 0.0, 1000.0);
  requireInRange("utility.executed_angle_rad", executed_angle_rad, 0.0, std::numbers::pi);
  requireInRange("utility.rotation_weight_m_per_rad", rotation_weight_m_per_rad, 0.0, 1e6);
  // D-A4: rays that stand for their leaves have no voxels of their own.
  if (count == GainCount::Voxels && !refine_unknown && coarse_levels > 0)
    throw std::invalid_argument(
        "rays.count = voxels needs rays.refine_unknown = true or "
        "rays.coarse_levels = 0; unknown nodes are not refined to voxels otherwise");
}

std::string_view tokenOf(ViewRejection rejection) {
  switch (rejection) {
    case ViewRejection::Position:
      return "position";
    case ViewRejection::Registration:
      return "registration";
    case ViewRejection::Executed:
      return "executed";
    case ViewRejection::None:
      break;
  }
  return "";
}

HierarchicalQuery queryOf(const Box& object_box, const HierarchicalPlannerConfig& config) {
  HierarchicalQuery query;
  query.bounds = object_box;
  query.start = config.child_start;
  query.refine_unknown = config.refine_unknown;
  query.distinct_voxels = config.count == GainCount::Voxels;
  return query;
}

bool bodyFits(const StateGrid& states, const Eigen::Vector3d& center_world, double body_m) {
  const GridGeometry& geometry = states.geometry();
  if (geometry.count() == 0 || !center_world.allFinite()) return false;
  // Voxel i covers [i, i + 1).
  const Eigen::Vector3d center = geometry.toGrid(center_world).array() + 0.5;
  const double half = body_m / geometry.voxel_size_m / 2;
  Eigen::Vector3i low, high;
  for (int a = 0; a < 3; ++a) {
    if (center[a] - half < -1.0 || center[a] + half > geometry.size[a] + 1.0) return false;
    std::tie(low[a], high[a]) = overlapped(center[a] - half, center[a] + half);
  }
  if (!geometry.contains(low) || !geometry.contains(high)) return false;
  for (int k = low.z(); k <= high.z(); ++k)
    for (int j = low.y(); j <= high.y(); ++j)
      for (int i = low.x(); i <= high.x(); ++i)
        if (states.at(i, j, k) != VoxelState::Free) return false;
  return true;
}

double configurationDistance(const Pose& a, const Pose& b, double rotation_weight_m_per_rad) {
  return std::hypot((a.translation() - b.translation()).norm(),
                    rotation_weight_m_per_rad * angleBetween(a, b));
}

bool takenBefore(const Pose& pose, std::span<const Pose> executed, const HierarchicalPlannerConfig& config) {
  return config.exclude_executed && std::ranges::any_of(executed, [&](const Pose& e) {
           return isNear(e, pose, config.executed_distance_m, config.executed_angle_rad);
         });
}

void judgeView(ViewUtility& view, const HierarchicalPlannerConfig& config, const Pose& current,
               std::uint64_t box_unknown) {
  view.surface = view.distance = view.utility = 0.0;
  view.rejection = ViewRejection::Registration;  // Eq. 2
  if (!overlapsKnownSurface(view, config)) return;

  view.rejection = ViewRejection::None;
  view.surface = box_unknown == 0 ? 0.0 : view.unknown / static_cast<double>(box_unknown);  // Eq. 3
  view.distance = 1.0 / (1.0 + configurationDistance(view.T_world_camera, current,
                                                     config.rotation_weight_m_per_rad));  // Eq. 5
  view.utility = view.surface * view.distance;  // Eq. 1, without a vision angle (D-A19)
}

ViewUtility evaluateView(const UtilityInput& input, const HierarchicalPlannerConfig& config,
                         const ViewCandidate& candidate, std::uint64_t box_unknown) {
  ViewUtility view;
  view.id = candidate.id;
  view.frame = candidate.frame;
  view.T_world_camera = candidate.T_world_camera;
  const Pose& pose = candidate.T_world_camera;

  view.rejection = ViewRejection::Executed;
  if (takenBefore(pose, input.executed, config)) return view;

  view.rejection = ViewRejection::Position;  // pos(v)
  if (!bodyFits(input.pyramid.finest(), pose.translation(), config.body_m)) return view;
  const HierarchicalQuery query = queryOf(input.object_box, config);
  view.rays = config.coarse_levels == 0
                  ? castUniformRays(input.pyramid.finest(), input.tree, pose, query)
                  : castHierarchical(input.pyramid, input.tree, config.coarse_levels, pose, query);
  if (view.rays.sensor_blocked) return view;  // D-A12
  const bool voxels = config.count == GainCount::Voxels;
  view.unknown = static_cast<double>(voxels ? view.rays.unknown_voxels : view.rays.unknown);
  view.occupied = static_cast<double>(voxels ? view.rays.occupied_voxels : view.rays.occupied);

  judgeView(view, config, input.current, box_unknown);
  return view;
}

std::vector<ViewCandidate> makeCandidates(const HierarchicalPlannerConfig& config, const Box& object_box,
                                          const Box& workspace, std::uint64_t seed) {
  if (config.generator == CandidateGenerator::Workspace)
    return workspaceViews(workspace, config.workspace_views, seed);
  return icosphereViews(object_box.center(), config.sphere_radius_m, config.icosphere_subdivisions);
}

}  // namespace vantage
