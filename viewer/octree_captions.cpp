// Key figures of the hierarchical planner and its octree.
#include <algorithm>

#include "viewer/captions.h"
#include "viewer/view_trace.h"
#include "viewer/view_words.h"

namespace vantage {
namespace {

constexpr const char* kNoOctree =
    "This product does not exist: the step was planned on contours in the TSDF, not by rays in an octree.";

/// "Of 320 views 140 fell out by position, 33 by registration, 2 were taken before."
std::string fallenText(const UtilitySearch& search) {
  std::string text = "Of " + grouped(search.views.size()) + " views " + grouped(search.rejected_position) +
                     " fell out by position, " + grouped(search.rejected_registration) + " by registration";
  if (const std::uint64_t taken = search.counts.poses_executed_before; taken > 0)
    text += ", " + grouped(taken) + (taken == 1 ? " was" : " were") + " taken before";
  return text + ".";
}

/// "; 2 better ones are unreachable"
std::string betterText(const UtilitySearch& search) {
  const std::uint64_t unreachable = search.counts.poses_unreachable;
  if (unreachable == 0) return "";
  return " " + grouped(unreachable) +
         (unreachable == 1 ? " better one is unreachable." : " better ones are unreachable.");
}

/// The view that would have been next: the first in the ranking that is not the chosen one and not refused.
const ViewUtility* nextBest(const UtilitySearch& search) {
  for (const std::uint32_t index : search.ranking) {
    const ViewUtility& view = search.views[index];
    if ((!search.chosen || view.id != search.chosen->id) && !isUnreachable(view.reachability)) return &view;
  }
  return nullptr;
}

/// Of a replay it is often that no frame is left near the views.
std::string whyNone(const UtilitySearch& search) {
  const auto frameless = std::ranges::count(search.views, Reachability::NoFrame, &ViewUtility::reachability);
  return static_cast<std::uint64_t>(frameless) == search.counts.poses_unreachable
             ? "no recorded frame is left near any of them"
             : "none can be reached";
}

std::string noneChosen(const SceneFrame& frame, const UtilitySearch& search) {
  const double stop = frame.header.octree ? frame.header.octree->planner.stop_gain : 0.0;
  const std::string unit = " " + countUnit(frame), fallen = fallenText(search);
  const SearchEnd end = endOf(search, stop);
  const std::string none = "No view was chosen: ";
  if (end == SearchEnd::NoSurvivor) return none + "none is left. " + fallen;
  const std::uint64_t enough = search.counts.poses_above_threshold;
  if (end == SearchEnd::Unreachable && search.counts.poses_unreachable > 0)
    return none + grouped(enough) + (enough == 1 ? " sees" : " see") + " enough, " + whole(stop) +
           " unknown" + unit + " or more, but " + whyNone(search) + ". " + fallen;
  return none + "the best of the " + grouped(search.ranking.size()) + " left sees " +
         whole(search.best_unknown) + " unknown" + unit + ", the planner stops below " + whole(stop) + ". " +
         fallen;
}

}  // namespace

std::string utilityFigures(const SceneFrame& frame, const LayerStyle&) {
  if (!frame.record.utilities)
    return onOctree(frame)
               ? "No views were evaluated."
               : "This product does not exist: the step's planner scores contour views, not by utility.";
  const UtilitySearch& search = *frame.record.utilities;
  const ViewUtility* view = chosenUtility(search);
  if (!view) return noneChosen(frame, search);
  const std::string unit = " " + countUnit(frame);
  std::string text = "View " + std::to_string(view->id) + ": " + whole(view->unknown) + " unknown and " +
                     whole(view->occupied) + " known" + unit + " in the object's box; surface factor " +
                     rounded(view->surface, 3) + " (seen" + unit + " per unknown voxel) × distance factor " +
                     fixed(view->distance) + " = utility " + rounded(view->utility, 3) + ". ";
  if (frame.header.octree && view->unknown < frame.header.octree->planner.stop_gain)
    text += "That is fewer than the " + whole(frame.header.octree->planner.stop_gain) +
            " of the stop rule; another view sees " + whole(search.best_unknown) + ". ";
  if (const ViewUtility* next = nextBest(search))
    text += "Next best: view " + std::to_string(next->id) + ", " + rounded(next->utility, 3) + ". ";
  return text + fallenText(search) + betterText(search);
}

std::string octreeFigures(const SceneFrame& frame, const LayerStyle& style) {
  if (!onOctree(frame)) return kNoOctree;
  const int level = std::min(style.octree_level.value_or(coarseLevels(frame)), frame.pyramid->coarseLevels());
  const StateGrid& nodes = frame.pyramid->level(level);
  const Box box = nodesInBox(frame, level);
  const auto count = [&](VoxelState state) { return grouped(nodes.count(state, box)); };
  std::string text = "Depth " + std::to_string(OccupancyOctree::kDepth - level) + " of the octree, " +
                     (level > 0 ? "nodes" : "voxels") + " of " + lengthText(nodes.geometry().voxel_size_m) +
                     (level > 0 ? ". Nodes that meet the object's box: " : ". In the object's box: ") +
                     count(VoxelState::Occupied) + " occupied, " + count(VoxelState::Unknown) + " unknown, " +
                     count(VoxelState::Free) + " free.";
  if (level == 0) return text;
  const bool max = frame.header.octree->map.occupancy.inner == InnerRule::Max;
  return text + (max ? " A node is free if all of it is, occupied if anything in it is, else unknown."
                     : " A node has the label of the mean of its voxels.");
}

std::string rayFigures(const SceneFrame& frame, const LayerStyle& style) {
  if (!onOctree(frame)) return kNoOctree;
  const std::optional<ViewTrace> trace = traceView(frame, style);
  if (!trace) return "There is no view whose rays could be drawn.";
  const RayLevel& start = frame.tree->level(trace->coarse_levels);
  const RayCounts& n = trace->counts;
  const std::string view = "View " + std::to_string(trace->view->id);
  if (n.sensor_blocked) return view + ": the sensor stands in something that is not free, no ray is cast.";
  std::string text = view + ": " + grouped(start.count()) + " rays through " +
                     (trace->coarse_levels > 0 ? "nodes" : "voxels") + " of " +
                     lengthText(start.voxel_size_m);
  if (trace->coarse_levels > 0)
    text += ", refined where they hit something occupied: " + grouped(n.finest_rays_cast) + " of " +
            grouped(n.rays) + " finest rays cast";
  text +=
      ". Counted: " + grouped(n.unknown) + " finest rays on unknown, " + grouped(n.occupied) + " on occupied";
  text += trace->coarse_levels > 0 ? "; a ray that ends coarse counts for all finest ones below it." : ".";
  const DrawnRays drawn = thinned(*trace, *frame.tree, style.coarse_rays);
  if (drawn.coarse.size() < start.count())
    text += " Drawn: " + grouped(drawn.coarse.size()) + " of them" +
            (drawn.refined.empty() ? "." : " and the finer ones below.");
  return text;
}

}  // namespace vantage
