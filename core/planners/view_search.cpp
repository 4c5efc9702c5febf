#include <chrono>
#include <stdexcept>
#include <string>
#include <unordered_map>

#include "core/planners/contour_groups.h"
#include "core/planners/view_selection.h"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// True if no roll of the position can do better. The wall clock may strike at one pose and spare the next.
bool holdsForPosition(const MotionPlan& plan) {
  const Reachability verdict = plan.verdict;
  if (plan.by_orientation) return false;
  return verdict == Reachability::OutOfReach || verdict == Reachability::InCollision ||
         verdict == Reachability::NotConnected || verdict == Reachability::NoPath;
}

void checkInput(const ViewSearchInput& input, const ContourPlannerConfig& config) {
  config.validate();
  input.camera.validate();
  for (std::size_t n = 0; n < input.positions.size(); ++n) {
    const ViewPosition& position = input.positions[n];
    const std::size_t first_id = n * config.views.rolls;
    if (position.first_id == first_id && position.group < input.points.size()) continue;
    throw std::invalid_argument("view search: position " + std::to_string(n) + " has first id " +
                                std::to_string(position.first_id) + " and contour point " +
                                std::to_string(position.group) + "; it must have " +
                                std::to_string(first_id) + " and one of the " +
                                std::to_string(input.points.size()) + " points given");
  }
}

/// Lines 7-17 of Algorithm 1 with everything that they collect.
class Selection {
 public:
  Selection(const ViewSearchInput& input, const ContourPlannerConfig& config, const GroupScores& scores,
            const ReachPose& reach, const RunControl& control)
      : input_(input), config_(config), scores_(scores), reach_(reach), control_(control) {}

  ViewSelection run() {
    result_.segments = contourGroups(input_, config_);
    result_.counts.poses_generated =
        input_.positions.size() * static_cast<std::uint64_t>(config_.views.rolls);
    for (std::uint32_t s = 0; s < result_.segments.size() && !result_.chosen; ++s) {
      if (!score(result_.segments[s])) return {std::move(result_), s};
      choose(s);
    }
    return {std::move(result_), std::nullopt};
  }

 private:
  bool score(SegmentSearch& segment) {
    const auto start = Clock::now();
    const bool known = scores_(segment, result_.counts);
    result_.evaluation_s += secondsSince(start);
    return known;
  }

  /// Lines 12-14: the first pose in rank order above the threshold that can be reached.
  void choose(std::uint32_t s) {
    SegmentSearch& segment = result_.segments[s];
    for (std::uint32_t rank = 0; rank < segment.scores.size(); ++rank) {
      PoseScore& score = segment.scores[rank];
      if (!(score.gain > config_.gain.gain_threshold)) return;
      if (score.executed_before) {
        ++result_.counts.poses_executed_before;
        continue;
      }
      MotionPlan plan = motionTo(score.id);
      score.reachability = plan.verdict;
      if (plan.verdict == Reachability::Reachable) {
        take(s, rank, std::move(plan));
        return;
      }
      ++result_.counts.poses_unreachable;
    }
  }

  const ViewPosition& positionOf(std::uint32_t id) const {
    return input_.positions[id / config_.views.rolls];
  }
  Pose poseOf(std::uint32_t id) const {
    return rolledPose(positionOf(id), static_cast<int>(id % config_.views.rolls), config_.views);
  }

  MotionPlan motionTo(std::uint32_t id) {
    const std::uint32_t position = id / config_.views.rolls;
    if (const auto known = unreachable_.find(position); known != unreachable_.end()) {
      MotionPlan plan;
      plan.verdict = known->second;
      return plan;
    }
    control_.check();
    const auto start = Clock::now();
    MotionPlan plan = reach_(poseOf(id));
    result_.motion_planning_s += secondsSince(start);
    ++result_.counts.paths_planned;
    if (holdsForPosition(plan)) unreachable_.emplace(position, plan.verdict);
    return plan;
  }

  void take(std::uint32_t s, std::uint32_t rank, MotionPlan plan) {
    const SegmentSearch& segment = result_.segments[s];
    ContourChosenView& view = result_.chosen.emplace();
    view.id = segment.scores[rank].id;
    view.contour_point = positionOf(view.id).group;
    view.search = s;
    view.rank = rank;
    view.T_world_camera = poseOf(view.id);
    view.gain = segment.scores[rank].gain;
    view.path = std::move(plan);
  }

  const ViewSearchInput& input_;
  const ContourPlannerConfig& config_;
  const GroupScores& scores_;
  const ReachPose& reach_;
  const RunControl& control_;
  std::unordered_map<std::uint32_t, Reachability> unreachable_;  ///< by position
  ViewSearch result_;
};

}  // namespace

ViewSelection selectView(const ViewSearchInput& input, const ContourPlannerConfig& config,
                         const GroupScores& scores, const ReachPose& reach, const RunControl& control) {
  checkInput(input, config);
  return Selection(input, config, scores, reach, control).run();
}

ViewSearch searchView(const ViewSearchInput& input, const ContourPlannerConfig& config,
                      const ReachPose& reach, const RunControl& control) {
  const GroupScores cast = [&](SegmentSearch& group, SearchCounts& counts) {
    scoreSegment(input, config, group, counts, control);
    return true;
  };
  ViewSearch search = selectView(input, config, cast, reach, control).search;
  if (search.chosen)
    search.chosen->gain_voxels =
        countVoxels(input, config, search.segments[search.chosen->search], search.chosen->T_world_camera);
  return search;
}

}  // namespace vantage
