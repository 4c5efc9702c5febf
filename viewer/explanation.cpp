#include "viewer/explanation.h"

#include <algorithm>

#include "viewer/explanation_parts.h"

namespace vantage {
namespace {

const CandidateRow* findRow(const std::vector<CandidateRow>& rows, std::uint32_t id) {
  const auto found =
      std::ranges::find_if(rows, [&](const CandidateRow& r) { return !r.pending() && r.id == id; });
  return found == rows.end() ? nullptr : &*found;
}

/// The view that would have been taken had the chosen one not been there: the next one that was not refused.
const CandidateRow* nextAfter(const std::vector<CandidateRow>& rows, const CandidateRow& chosen) {
  const CandidateRow* next = nullptr;
  for (const CandidateRow& row : rows) {
    if (!row.rank || !chosen.rank || *row.rank <= *chosen.rank || isUnreachable(row.reachability)) continue;
    if (!next || *row.rank < *next->rank) next = &row;
  }
  return next;
}

bool isScored(const ExplainedView& view) {
  return view.frame.record.search->segments[*view.group].scored;
}

}  // namespace

Explanation explain(const SceneFrame& shown, std::uint32_t id) {
  return explain(shown, candidateRows(shown), id);
}

Explanation explain(const SceneFrame& shown, const std::vector<CandidateRow>& rows, std::uint32_t id) {
  const auto winner = std::ranges::find_if(rows, &CandidateRow::chosen);
  ExplainedView view{.frame = shown,
                     .id = id,
                     .row = findRow(rows, id),
                     .chosen = winner == rows.end() ? nullptr : &*winner,
                     .other = nullptr,
                     .group = groupOf(shown, id)};
  Explanation result{.id = id};
  if (!view.row && !view.group) {
    result.sentence = rows.empty() ? "No views were evaluated in this step."
                                   : "View " + std::to_string(id) + " is no candidate of this step.";
    return result;
  }
  result.is_winner = view.row && view.row == view.chosen;
  view.other = result.is_winner ? nextAfter(rows, *view.chosen) : view.chosen;
  if (view.row) result.row = *view.row;
  if (view.other) result.other = view.other->id;
  const bool contour = shown.record.search && !shown.record.utilities;
  result.missing = view.row ? "not computed" : isScored(view) ? "not scored" : "not scored yet";
  result.sentence = contour ? contourReason(view) : utilityReason(view);
  result.factors = contour ? contourFactors(view) : utilityFactors(view);
  return result;
}

bool CountedRegion::operator==(const CountedRegion& other) const {
  const auto same = [](const Sphere& a, const Sphere& b) {
    return a.center == b.center && a.radius == b.radius;
  };
  return T_world_camera.matrix() == other.T_world_camera.matrix() && outside == other.outside &&
         bounds.min() == other.bounds.min() && bounds.max() == other.bounds.max() &&
         sphere.has_value() == other.sphere.has_value() && (!sphere || same(*sphere, *other.sphere));
}

std::optional<CountedRegion> countedRegion(const SceneFrame& shown, const CandidateRow& row) {
  if (row.pending()) return std::nullopt;
  CountedRegion region;
  if (const UtilitySearch* search = shown.record.utilities.get()) {
    const auto view = std::ranges::find(search->views, row.id, &ViewUtility::id);
    if (view == search->views.end() || !onOctree(shown)) return std::nullopt;
    region.T_world_camera = view->T_world_camera;
    region.bounds = shown.header.octree->object_box;
    return region;
  }
  const ViewSearch* search = shown.record.search.get();
  const auto pose = poseOfCandidate(shown, row.id);
  if (!search || row.group >= search->segments.size() || !pose) return std::nullopt;
  region.T_world_camera = *pose;
  region.outside = shown.header.contour_config.gain.outside;
  if (const Sphere& sphere = search->segments[row.group].sphere; sphere.radius > 0.0)
    region.sphere = sphere;
  else
    region.bounds = shown.header.workspace;  // the baseline
  return region;
}

std::uint64_t countedVoxels(const SceneFrame& shown, const CandidateRow& row) {
  const auto region = countedRegion(shown, row);
  return region ? countedVoxels(shown, *region) : 0;
}

std::uint64_t countedVoxels(const SceneFrame& shown, const CountedRegion& region) {
  if (shown.record.utilities) {
    HierarchicalQuery query;
    query.bounds = region.bounds;
    query.distinct_voxels = true;
    return castUniformRays(shown.pyramid->finest(), *shown.tree, region.T_world_camera, query).unknown_voxels;
  }
  VisibilityQuery query;
  query.outside = region.outside;
  query.sphere = region.sphere;
  if (!region.bounds.isEmpty()) query.bounds = region.bounds;
  query.distinct_voxels = true;
  return castUniform(shown.states, shown.header.camera, region.T_world_camera, query).unknown_voxels;
}

}  // namespace vantage
