// Steps 4 and 5 of Algorithm 1, Vasquez-Gomez et al. 2013.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/planners/hierarchical_planner.h"

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

class Search {
 public:
  Search(const UtilityInput& input, const HierarchicalPlannerConfig& config, const ReachPose& reach,
         const RunControl& control)
      : input_(input), config_(config), reach_(reach), control_(control) {}

  UtilitySearch run() {
    const auto start = Clock::now();
    evaluateAll();
    rank();
    result_.evaluation_s = secondsSince(start);
    result_.box_occupied = input_.pyramid.finest().count(VoxelState::Occupied, input_.object_box);
    count();
    // D-A18: a search ends the exploration only if no survivor is worth a scan.
    if (result_.best_unknown >= config_.stop_gain) choose();
    return std::move(result_);
  }

 private:
  void evaluateAll() {
    result_.box_unknown = input_.pyramid.finest().count(VoxelState::Unknown, input_.object_box);
    result_.views.resize(input_.candidates.size());
    control_.report("evaluate views", 0, result_.views.size());
    // One by one: some views cost a hundred times as much as others.
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, result_.views.size()),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t n = range.begin(); n != range.end(); ++n) {
            control_.check();
            result_.views[n] = evaluateView(input_, config_, input_.candidates[n], result_.box_unknown);
          }
        },
        tbb::simple_partitioner());
    control_.report("evaluate views", result_.views.size(), result_.views.size());
  }

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

  void take(const ViewUtility& view, MotionPlan plan) {
    ChosenView& chosen = result_.chosen.emplace();
    chosen.id = view.id;
    chosen.T_world_camera = view.T_world_camera;
    chosen.gain = view.unknown;
    chosen.path = std::move(plan);
    HierarchicalQuery query;
    query.bounds = input_.object_box;
    query.distinct_voxels = true;
    chosen.gain_voxels =
        castUniformRays(input_.pyramid.finest(), input_.tree, view.T_world_camera, query).unknown_voxels;
  }

  const UtilityInput& input_;
  const HierarchicalPlannerConfig& config_;
  const ReachPose& reach_;
  const RunControl& control_;
  UtilitySearch result_;
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

UtilitySearch searchUtility(const UtilityInput& input, const HierarchicalPlannerConfig& config,
                            const ReachPose& reach, const RunControl& control) {
  checkInput(input, config);
  return Search(input, config, reach, control).run();
}

}  // namespace vantage
