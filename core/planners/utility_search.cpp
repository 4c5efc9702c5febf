// Steps 4 and 5 of Algorithm 1, Vasquez-Gomez et al. 2013.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/planners/utility_selection.h"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;
double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void checkInput(const UtilityInput& input, const HierarchicalPlannerConfig& config) {
  config.validate();
  const auto refuse = [](const std::string& why) { throw std::invalid_argument("view evaluation: " + why); };
  const int map_levels = input.pyramid.coarseLevels(), tree_levels = input.tree.coarseLevels();
  if (std::min(map_levels, tree_levels) < config.coarse_levels)
    refuse("coarse_levels = " + std::to_string(config.coarse_levels) + ", but the map has " +
           std::to_string(map_levels) + " and the ray tree " + std::to_string(tree_levels) +
           "; make both with as many");
  const double map_m = input.pyramid.finest().geometry().voxel_size_m;
  const double tree_m = input.tree.level(0).voxel_size_m;
  if (std::abs(map_m - tree_m) > 1e-9 * map_m)
    refuse("the ray tree is for voxels of " + std::to_string(tree_m) + " m, the map has voxels of " +
           std::to_string(map_m) + " m; make a ray tree for this map");
  if (!(input.tree.sensor() == config.sensor))
    refuse("the ray tree is of another sensor than the configured one; make one of that sensor");
  if (input.object_box.isEmpty())
    refuse("the object's box is empty; its lower corner must lie below its upper one");
}

std::vector<ViewUtility> evaluateAll(const UtilityInput& input, const HierarchicalPlannerConfig& config,
                                     std::uint64_t box_unknown, const RunControl& control) {
  std::vector<ViewUtility> views(input.candidates.size());
  control.report("evaluate views", 0, views.size());
  // One by one: some views cost a hundred times as much as others.
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, views.size()),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t n = range.begin(); n != range.end(); ++n) {
          control.check();
          views[n] = evaluateView(input, config, input.candidates[n], box_unknown);
        }
      },
      tbb::simple_partitioner());
  control.report("evaluate views", views.size(), views.size());
  return views;
}

/// Everything after the cascade.
class Selection {
 public:
  Selection(UtilitySearch& search, const HierarchicalPlannerConfig& config, const ReachPose& reach,
            const RunControl& control)
      : result_(search), config_(config), reach_(reach), control_(control) {}

  void rank() {
    for (std::uint32_t n = 0; n < result_.views.size(); ++n)
      if (result_.views[n].rejection == ViewRejection::None) result_.ranking.push_back(n);
    std::stable_sort(result_.ranking.begin(), result_.ranking.end(), [&](std::uint32_t a, std::uint32_t b) {
      return result_.views[a].utility > result_.views[b].utility;
    });
    for (const std::uint32_t n : result_.ranking)
      result_.best_unknown = std::max(result_.best_unknown, result_.views[n].unknown);
    result_.literal_stop =
        result_.ranking.empty() || result_.views[result_.ranking.front()].unknown < config_.stop_gain;
  }

  void count() {
    SearchCounts& counts = result_.counts;
    counts.poses_generated = result_.views.size();
    for (const ViewUtility& view : result_.views) {
      counts.rays += view.rays.rays_cast;
      counts.voxels_visited += view.rays.visited;
      result_.finest_rays_cast += view.rays.finest_rays_cast;
      result_.rejected_position += view.rejection == ViewRejection::Position;
      counts.poses_executed_before += view.rejection == ViewRejection::Executed;
      result_.rejected_registration += view.rejection == ViewRejection::Registration;
      counts.poses_above_threshold +=
          view.rejection == ViewRejection::None && view.unknown >= config_.stop_gain;
    }
    counts.poses_scored = counts.poses_generated - result_.rejected_position - counts.poses_executed_before;
  }

  /// Step 5: the best view that the robot can take. A view of no utility shows nothing new.
  void choose() {
    for (const std::uint32_t n : result_.ranking) {
      ViewUtility& view = result_.views[n];
      if (!(view.utility > 0.0)) return;
      control_.check();
      const auto start = Clock::now();
      MotionPlan plan = reach_(view.T_world_camera);  // D-A23: not part of the NBV time
      result_.motion_planning_s += secondsSince(start);
      ++result_.counts.paths_planned;
      view.reachability = plan.verdict;
      if (plan.verdict == Reachability::Reachable) {
        take(view, std::move(plan));
        return;
      }
      ++result_.counts.poses_unreachable;
    }
  }

 private:
  void take(const ViewUtility& view, MotionPlan plan) {
    ChosenView& chosen = result_.chosen.emplace();
    chosen.id = view.id;
    chosen.T_world_camera = view.T_world_camera;
    chosen.gain = view.unknown;
    chosen.path = std::move(plan);
  }

  UtilitySearch& result_;
  const HierarchicalPlannerConfig& config_;
  const ReachPose& reach_;
  const RunControl& control_;
};

}  // namespace

const ViewUtility* chosenUtility(const UtilitySearch& search) {
  if (!search.chosen) return nullptr;
  for (const std::uint32_t n : search.ranking)
    if (search.views[n].id == search.chosen->id) return &search.views[n];
  return nullptr;
}

SearchEnd endOf(const UtilitySearch& search, double stop_gain) {
  if (search.chosen) return SearchEnd::Chosen;
  if (search.ranking.empty()) return SearchEnd::NoSurvivor;
  return search.best_unknown < stop_gain ? SearchEnd::LittleUnknown : SearchEnd::Unreachable;
}

void selectUtility(UtilitySearch& search, const HierarchicalPlannerConfig& config, const ReachPose& reach,
                   const RunControl& control) {
  Selection selection(search, config, reach, control);
  const auto start = Clock::now();
  selection.rank();
  search.evaluation_s += secondsSince(start);
  selection.count();
  // D-A18: a search ends the exploration only if no survivor is worth a scan.
  if (search.best_unknown >= config.stop_gain) selection.choose();
}

std::uint64_t countVoxels(const UtilityInput& input, const Pose& T_world_camera) {
  HierarchicalQuery query;
  query.bounds = input.object_box;
  query.distinct_voxels = true;
  return castUniformRays(input.pyramid.finest(), input.tree, T_world_camera, query).unknown_voxels;
}

UtilitySearch searchUtility(const UtilityInput& input, const HierarchicalPlannerConfig& config,
                            const ReachPose& reach, const RunControl& control) {
  checkInput(input, config);
  UtilitySearch search;
  const auto start = Clock::now();
  search.box_unknown = input.pyramid.finest().count(VoxelState::Unknown, input.object_box);
  search.views = evaluateAll(input, config, search.box_unknown, control);
  search.evaluation_s = secondsSince(start);
  search.box_occupied = input.pyramid.finest().count(VoxelState::Occupied, input.object_box);
  selectUtility(search, config, reach, control);
  if (search.chosen) search.chosen->gain_voxels = countVoxels(input, search.chosen->T_world_camera);
  return search;
}

}  // namespace vantage
