#include "viewer/app/experiments/b2_normals.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/planners/contour_groups.h"
#include "viewer/app/experiments/spread.h"

namespace vantage::experiments {
namespace {

/// True object of each segment that has one, by index into Saliency::segments.
std::map<std::int32_t, std::string> objectsOf(const FirstStep& first) {
  std::map<std::int32_t, std::string> objects;
  for (std::size_t i = 0; i < first.rows.size(); ++i)
    if (!first.rows[i].object.empty())
      objects[first.record->search->segments[i].segment] = first.rows[i].object;
  return objects;
}

/// Best gain of each contour point of a scored group, 0 for those that gain nothing.
std::map<std::uint32_t, double> bestOfPoints(const SegmentSearch& group,
                                             const std::vector<ViewPosition>& positions, int rolls) {
  std::map<std::uint32_t, double> best;
  for (const PoseScore& score : group.scores) {
    double& gain = best[positions[score.id / static_cast<std::uint32_t>(rolls)].group];
    gain = std::max(gain, score.gain);
  }
  return best;
}

std::map<std::string, ObjectGain> gainsWith(const FirstStep& first, ContourNormal normal) {
  ContourPlannerConfig config = first.header.contour_config;
  config.contours.normal = normal;
  const StepRecord& record = *first.record;
  const std::vector<ContourPoint> points = extractContours(first.volume, config.contours).points;
  const std::vector<ViewPosition> positions = contourViewPositions(points, config.views);
  const std::vector<std::uint32_t> labels = assignContourPoints(points, *record.surface, *record.labels);
  const ViewSearchInput input{.states = first.states,
                              .camera = first.header.camera,
                              .workspace = first.header.workspace,
                              .points = points,
                              .positions = positions,
                              .point_labels = labels,
                              .saliency = *record.saliency,
                              .executed = {},
                              .disappointing = {}};
  const std::map<std::int32_t, std::string> objects = objectsOf(first);
  std::map<std::string, ObjectGain> gains;
  for (SegmentSearch& group : contourGroups(input, config)) {
    const auto object = objects.find(group.segment);
    if (object == objects.end()) continue;
    SearchCounts counts;
    scoreSegment(input, config, group, counts, {});
    ObjectGain& gain = gains[object->second];
    for (const auto& [point, best] : bestOfPoints(group, positions, config.views.rolls)) {
      gain.best = std::max(gain.best, best);
      gain.mean = (gain.mean * static_cast<double>(gain.contour_points) + best) /
                  static_cast<double>(gain.contour_points + 1);
      ++gain.contour_points;
    }
  }
  return gains;
}

bool isBox(const NormalsAtObject& at) {
  return at.object.starts_with("box");
}

}  // namespace

std::vector<NormalsAtObject> compareNormals(const FirstStep& first) {
  const auto frontier = gainsWith(first, ContourNormal::Frontier);
  const auto surface = gainsWith(first, ContourNormal::Surface);
  std::vector<NormalsAtObject> objects;
  for (const SegmentRow& row : first.rows) {
    const bool listed = std::ranges::find(objects, row.object, &NormalsAtObject::object) != objects.end();
    if (row.object.empty() || listed) continue;
    const auto of = [&](const auto& gains) {
      const auto found = gains.find(row.object);
      return found == gains.end() ? ObjectGain{} : found->second;
    };
    objects.push_back({row.object, of(frontier), of(surface)});
  }
  return objects;
}

Table normalsTable(const std::vector<NormalsAtObject>& objects) {
  Table table{
      "b2_normals",
      "B2 (a): gain of the poses of each object's contour points at the first view, px; view C looks "
      "against the frontier normal, view B against the surface's",
      {"object", "points C", "points B", "best C", "best B", "mean C", "mean B", "best B / C", "mean B / C"},
      {}};
  const auto count = [](std::uint64_t n) { return Cell::number(static_cast<double>(n)); };
  for (const NormalsAtObject& at : objects)
    table.rows.push_back({at.object, count(at.frontier.contour_points), count(at.surface.contour_points),
                          Cell::number(at.frontier.best), Cell::number(at.surface.best),
                          Cell::number(at.frontier.mean), Cell::number(at.surface.mean),
                          Cell::number(at.ratio(&ObjectGain::best), 2),
                          Cell::number(at.ratio(&ObjectGain::mean), 2)});
  return table;
}

Claim judgeNormals(const std::vector<NormalsAtObject>& objects) {
  const auto ratios = [&](bool boxes, double ObjectGain::*gain) {
    std::vector<double> found;
    for (const NormalsAtObject& at : objects)
      if (isBox(at) == boxes) found.push_back(at.ratio(gain));
    return spreadOf(found).mean;
  };
  Claim claim{
      "B2 (a)",
      "with surface normals the best pose gains less at boxes, about as much (0.8 to 1.25) at jugs and "
      "ball",
      "-",
      "not run",
      Verdict::NotRun,
      ""};
  if (objects.empty()) return claim;
  const double boxes = ratios(true, &ObjectGain::best), round = ratios(false, &ObjectGain::best);
  claim.ours = fmt::format("boxes {:.2f}, round objects {:.2f}", boxes, round);
  claim.verdict = passIf(boxes < 1.0 && boxes < round && round >= 0.8 && round <= 1.25);
  claim.remark = fmt::format(
      "surface / frontier, mean of the objects; of the mean over contour points: boxes {:.2f}, round {:.2f}",
      ratios(true, &ObjectGain::mean), ratios(false, &ObjectGain::mean));
  return claim;
}

}  // namespace vantage::experiments
