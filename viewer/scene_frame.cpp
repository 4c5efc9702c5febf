#include "viewer/scene_frame.h"

#include <unordered_set>

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

Pose candidatePose(const SceneFrame& frame, std::uint32_t id) {
  const ContourViewConfig& config = frame.header.planner_config.views;
  const std::uint32_t rolls = static_cast<std::uint32_t>(std::max(1, config.rolls));
  const std::uint32_t position = id / rolls;
  if (!frame.record.positions || position >= frame.record.positions->size()) return Pose::Identity();
  // Turned about the optical axis from the pose of roll 0, as rolledPose() does.
  const double roll_rad = 2.0 * 3.14159265358979323846 * (id % rolls) / rolls;
  Pose pose = (*frame.record.positions)[position].T_world_camera;
  pose.rotate(Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()));
  return pose;
}

std::vector<RankedPosition> rankedPositions(const SceneFrame& frame, const SegmentSearch& search) {
  std::vector<RankedPosition> ranked;
  if (!frame.record.positions) return ranked;
  const std::uint32_t rolls =
      static_cast<std::uint32_t>(std::max(1, frame.header.planner_config.views.rolls));
  const double threshold = frame.header.planner_config.gain.gain_threshold;
  std::unordered_set<std::uint32_t> seen;
  for (const PoseScore& score : search.scores) {
    if (score.gain <= threshold) break;
    if (score.id / rolls >= frame.record.positions->size() || !seen.insert(score.id / rolls).second) continue;
    ranked.push_back(
        {candidatePose(frame, score.id), score.gain, score.id, score.reachability, score.executed_before});
  }
  return ranked;
}

}  // namespace vantage
