#include "viewer/scene_frame.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "core/exploration/planner_kind.h"

namespace vantage {

const SegmentSearch* shownSearch(const StepRecord& record) {
  if (!record.search) return nullptr;
  const ViewSearch& search = *record.search;
  if (search.chosen && search.chosen->search < search.segments.size())
    return &search.segments[search.chosen->search];
  const SegmentSearch* last = nullptr;
  for (const SegmentSearch& segment : search.segments) {
    if (segment.scored) last = &segment;
  }
  return last;
}

const std::string& plannerOf(const SceneFrame& frame) {
  return frame.record.planner.empty() ? frame.header.planner : frame.record.planner;
}

bool onOctree(const SceneFrame& frame) {
  return frame.pyramid && frame.tree && frame.header.octree && frame.pyramid->coarseLevels() >= 0;
}

int coarseLevels(const SceneFrame& frame) {
  return plannerOf(frame) == toString(PlannerKind::Uniform) ? 0 : frame.header.octree->planner.coarse_levels;
}

Box nodesInBox(const SceneFrame& frame, int level) {
  const Box& box = frame.header.octree->object_box;
  if (level == 0 || box.isEmpty()) return box;
  constexpr double kTouching = 1.0 - 1e-6;  // nodes that only share a border do not intersect it
  const double half_m = frame.pyramid->level(level).geometry().voxel_size_m / 2 * kTouching;
  return {box.min().array() - half_m, box.max().array() + half_m};
}

Box occupiedBox(const SceneFrame& frame) {
  constexpr double kSupportMargin_m = 0.04;
  Box box = frame.header.workspace;
  if (!box.isEmpty()) box.min().z() -= kSupportMargin_m;
  return box;
}

Box slicedBox(const SceneFrame& frame) {
  const GridGeometry& geometry = frame.states.geometry();
  if (geometry.count() == 0) return {};
  const Box& workspace = frame.header.workspace;
  return workspace.isEmpty() ? geometry.bounds() : geometry.bounds().intersection(workspace);
}

PinholeCamera viewCamera(const SceneFrame& frame) {
  if (!onOctree(frame)) return frame.header.camera;
  constexpr int kAcross = 1000;  // pixels; only the aperture matters
  const RaySensor& sensor = frame.header.octree->planner.sensor;
  const double tan_h = std::tan(sensor.horizontal_fov_rad / 2), tan_v = std::tan(sensor.vertical_fov_rad / 2);
  return cameraFromFov(kAcross, std::max(1, static_cast<int>(std::lround(kAcross * tan_v / tan_h))),
                       sensor.horizontal_fov_rad);
}

std::optional<Pose> poseOfCandidate(const SceneFrame& frame, std::uint32_t id) {
  if (frame.record.utilities) {
    const auto& views = frame.record.utilities->views;
    const auto found = std::ranges::find(views, id, &ViewUtility::id);
    return found == views.end() ? std::nullopt : std::optional(found->T_world_camera);
  }
  const ViewPosition* position = positionOf(frame, id);
  if (!position) return std::nullopt;
  const std::uint32_t roll = id % rollsOf(frame.header);
  if (roll == 0) return position->T_world_camera;
  return rolledPose(*position, static_cast<int>(roll), frame.header.contour_config.views);
}

std::uint32_t rollsOf(const RunHeader& header) {
  return static_cast<std::uint32_t>(std::max(1, header.contour_config.views.rolls));
}

const ViewPosition* positionOf(const SceneFrame& frame, std::uint32_t id) {
  const std::size_t index = id / rollsOf(frame.header);
  const auto& positions = frame.record.positions;
  return positions && index < positions->size() ? &(*positions)[index] : nullptr;
}

std::optional<std::uint32_t> groupOf(const SceneFrame& frame, std::uint32_t id) {
  const ViewPosition* position = positionOf(frame, id);
  if (!position || !frame.record.search) return std::nullopt;
  const auto& groups = frame.record.search->segments;
  for (std::uint32_t g = 0; g < groups.size(); ++g)
    if (std::ranges::find(groups[g].contour_points, position->group) != groups[g].contour_points.end())
      return g;
  return std::nullopt;
}

std::vector<RankedPosition> rankedPositions(const SceneFrame& frame, const SegmentSearch& search) {
  std::vector<RankedPosition> ranked;
  if (!frame.record.positions) return ranked;
  const std::uint32_t rolls = rollsOf(frame.header);
  const double threshold = frame.header.contour_config.gain.gain_threshold;
  std::unordered_set<std::uint32_t> seen;
  for (const PoseScore& score : search.scores) {
    if (score.gain <= threshold) break;
    if (!seen.insert(score.id / rolls).second) continue;
    if (const auto pose = poseOfCandidate(frame, score.id))
      ranked.push_back({*pose, score.gain, score.id, score.reachability, score.executed_before});
  }
  return ranked;
}

std::vector<RankedPosition> drawnViews(const SceneFrame& frame, const LayerStyle& style) {
  std::vector<RankedPosition> ranked, drawn;
  if (const SegmentSearch* search = shownSearch(frame.record))
    ranked = rankedPositions(frame, *search);
  else if (frame.record.utilities)
    ranked = rankedViews(*frame.record.utilities);
  int reachable = 0, unreachable = 0;
  for (const RankedPosition& view : ranked) {
    if (view.unreachable() ? unreachable++ < style.unreachable_views : reachable++ < style.ranked_views)
      drawn.push_back(view);
  }
  return drawn;
}

std::vector<RankedPosition> rankedViews(const UtilitySearch& search) {
  std::vector<RankedPosition> ranked;
  for (const std::uint32_t index : search.ranking) {
    const ViewUtility& view = search.views[index];
    ranked.push_back({view.T_world_camera, view.utility, view.id, view.reachability, false});
  }
  return ranked;
}

double lookDistance(const SceneFrame& frame) {
  const auto& contours = frame.record.contours;
  const ChosenView& chosen = *frame.record.chosen();
  if (frame.record.utilities && frame.header.octree)
    return std::max(0.05,
                    (frame.header.octree->object_box.center() - chosen.T_world_camera.translation()).norm());
  const auto& search = frame.record.search;
  if (!contours || !search || search->chosen->contour_point >= contours->points.size()) return 0.8;
  return std::max(
      0.05, (contours->points[search->chosen->contour_point].position_m - chosen.T_world_camera.translation())
                .norm());
}

double chosenFrustumLength(const SceneFrame& frame) {
  constexpr double kLongest_m = 0.30;
  return std::min(lookDistance(frame), kLongest_m);
}

}  // namespace vantage
