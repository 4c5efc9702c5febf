#include "viewer/view_hits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/raycasting/first_hits.h"
#include "io/error.h"

namespace vantage {
namespace {

void add(RayGroup& group, std::size_t voxel) {
  ++group.rays;
  group.voxels.push_back(voxel);
}

void finish(RayGroup& group) {
  std::ranges::sort(group.voxels);
  group.voxels.erase(std::unique(group.voxels.begin(), group.voxels.end()), group.voxels.end());
}

/// The region of a search's scores.
VisibilityQuery queryOf(const SceneFrame& frame, const SegmentSearch& search) {
  VisibilityQuery query;
  query.outside = frame.header.contour_config.gain.outside;
  if (search.sphere.radius > 0.0)
    query.sphere = search.sphere;
  else
    query.bounds = frame.header.workspace;
  return query;
}

}  // namespace

double leavesAt(const Sphere& ball, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d to_center = ball.center - origin;
  const double along = to_center.dot(direction);
  const double half2 = ball.radius * ball.radius - (to_center.squaredNorm() - along * along);
  return half2 < 0.0 ? -1.0 : along + std::sqrt(half2);
}

double leavesAt(const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double enter = -std::numeric_limits<double>::infinity(), leave = std::numeric_limits<double>::infinity();
  if (box.isEmpty()) return -1.0;
  for (int a = 0; a < 3; ++a) {
    const double low = (box.min()[a] - origin[a]) / direction[a],
                 high = (box.max()[a] - origin[a]) / direction[a];
    if (std::isnan(low) || std::isnan(high)) continue;  // along a face
    enter = std::max(enter, std::min(low, high));
    leave = std::min(leave, std::max(low, high));
  }
  return leave < enter ? -1.0 : leave;
}

std::optional<std::uint32_t> shownView(const SceneFrame& frame, const LayerStyle& style) {
  if (!frame.record.search || !frame.record.positions || frame.record.positions->empty()) return std::nullopt;
  const std::size_t candidates = frame.record.positions->size() * rollsOf(frame.header);
  if (style.view_id) {
    if (static_cast<std::size_t>(*style.view_id) >= candidates)
      throw InputError("view_id = " + std::to_string(*style.view_id),
                       "is no candidate of step " + std::to_string(frame.record.step) + "; allowed: 0 .. " +
                           std::to_string(candidates - 1));
    return static_cast<std::uint32_t>(*style.view_id);
  }
  if (frame.record.search->chosen) return frame.record.search->chosen->id;
  const SegmentSearch* search = shownSearch(frame.record);
  return search && !search->scores.empty() ? std::optional(search->scores.front().id) : std::nullopt;
}

std::optional<ViewHits> castView(const SceneFrame& frame, const LayerStyle& style) {
  const StepRecord& record = frame.record;
  const auto id = shownView(frame, style);
  const auto group = id ? groupOf(frame, *id) : std::nullopt;
  if (!group) return std::nullopt;
  const SegmentSearch& search = record.search->segments[*group];
  const ContourPlannerConfig& config = frame.header.contour_config;
  const PinholeCamera camera = frame.header.camera.reduced(config.gain.reduction);
  ViewHits hits;
  hits.view = *id;
  hits.region = search.sphere;
  hits.T_world_camera = *poseOfCandidate(frame, *id);
  hits.rays = static_cast<std::uint64_t>(camera.width) * camera.height;
  const Eigen::Vector3d origin = hits.T_world_camera.translation();
  for (const FirstHit& hit : firstHits(frame.states, camera, hits.T_world_camera, queryOf(frame, search))) {
    const Eigen::Vector3d along = (hits.T_world_camera.linear() * camera.ray(hit.u, hit.v)).normalized();
    const double leaves_m = search.sphere.radius > 0.0 ? leavesAt(search.sphere, origin, along)
                                                       : leavesAt(frame.header.workspace, origin, along);
    if (!hit.counts && leaves_m <= hit.distance_m) continue;  // nothing of the region lies behind it
    const bool unknown = hit.state == VoxelState::Unknown;
    add(hit.too_near ? hits.too_near
        : hit.counts ? (unknown ? hits.counted : hits.known)
        : unknown    ? hits.unknown_before
                     : hits.occluded,
        hit.voxel);
  }
  for (RayGroup* rays : {&hits.counted, &hits.known, &hits.occluded, &hits.unknown_before, &hits.too_near})
    finish(*rays);
  return hits;
}

}  // namespace vantage
