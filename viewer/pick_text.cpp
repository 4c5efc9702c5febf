#include "viewer/pick_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "viewer/captions.h"
#include "viewer/view_words.h"

namespace vantage {
namespace {

template <class... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 256> text;
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

std::string nameOf(VoxelState state) {
  return state == VoxelState::Occupied ? "occupied" : state == VoxelState::Free ? "free" : "unknown";
}

std::string placeText(const Eigen::Vector3d& p) {
  return format("(%.3f, %.3f, %.3f) m", p.x(), p.y(), p.z());
}

/// "1st", "2nd", "11th".
std::string ordinal(std::size_t place) {
  const bool teen = place % 100 / 10 == 1;
  const char* ending = teen              ? "th"
                       : place % 10 == 1 ? "st"
                       : place % 10 == 2 ? "nd"
                       : place % 10 == 3 ? "rd"
                                         : "th";
  return std::to_string(place) + ending;
}

/// Where a segment comes in the order in which segments are tried, as the numbers in the picture: ", no. 2 of
/// 5 ..."; empty before it is known. \param index into SaliencyResult::segments
std::string triedText(const StepRecord& record, std::size_t index) {
  if (!record.search) return "";
  const auto& order = record.search->segments;
  const auto at = std::ranges::find(order, static_cast<std::int32_t>(index), &SegmentSearch::segment);
  if (at == order.end()) return ", not tried: it has no contour points";
  const auto place = static_cast<std::size_t>(at - order.begin()) + 1;
  return ", no. " + std::to_string(place) + " of " + std::to_string(order.size()) + " in the order of trying";
}

/// What the hierarchical planner computed of a view before the test that it failed.
std::string utilityText(const CandidateRow& row) {
  std::string text;
  if (row.survived())
    text = format("utility %.4f = surface %.3f x distance factor %.3f; ", row.score, row.surface,
                  row.distance_factor);
  if (!row.cast()) return "";
  return text + "unknown " + whole(row.unknown) + ", occupied " + whole(row.occupied);
}

std::string viewText(const Picked& picked, const StepData& step, const std::vector<CandidateRow>& rows) {
  const auto row =
      std::ranges::find_if(rows, [&](const CandidateRow& r) { return !r.pending() && r.id == picked.id; });
  std::string text = "view " + std::to_string(picked.id);
  if (row == rows.end()) return text + ", not scored\nat " + placeText(picked.p_world);
  text += (row->rank ? ", rank " + std::to_string(*row->rank) : ", no rank") + ": " + verdictWord(*row);
  if (step.record->utilities) {
    const std::string factors = utilityText(*row);
    return factors.empty() ? text : text + "\n" + factors;
  }
  text += "\ngain " + whole(row->score) + " " + countUnit(*step.header, *step.record);
  if (row->segment > 0)
    text +=
        format("; segment %u, saliency %.3f, tried ", row->segment, row->saliency) + ordinal(row->group + 1);
  return text;
}

std::string contourText(const Picked& picked, const StepData& step) {
  const auto& contours = step.record->contours;
  if (!contours || picked.id >= contours->points.size()) return "";
  const ContourPoint& point = contours->points[picked.id];
  std::string text = "contour point " + std::to_string(picked.id) + " at " + placeText(point.position_m);
  if (step.record->point_labels && picked.id < step.record->point_labels->size())
    text += ", of segment " + std::to_string((*step.record->point_labels)[picked.id]);
  return text;
}

std::string segmentText(const Picked& picked, const StepData& step) {
  const auto& saliency = step.record->saliency;
  if (!saliency || picked.id == 0 || picked.id > saliency->segments.size()) return "";
  const std::size_t index = picked.id - 1;
  const Segment& s = saliency->segments[index];
  return "segment with label " + std::to_string(s.label) + triedText(*step.record, index) + ", " +
         plural(s.points, "point") + "\n" +
         format("saliency %.3f = F %.3f x d_min/d_max %.3f\n", s.saliency, s.isolation, s.roundness) +
         format("d_min %.1f cm, d_max %.1f cm, radius %.1f cm\n", 100.0 * s.extent_m[2],
                100.0 * s.extent_m[0], 100.0 * s.radius_m);
}

std::string voxelText(const Picked& picked, const StepData& step) {
  const Eigen::Vector3i& v = picked.voxel;
  std::string text = format("voxel %d, %d, %d: ", v.x(), v.y(), v.z()) + nameOf(picked.state);
  if (step.volume && !step.volume->voxels().empty() && step.volume->geometry().contains(v)) {
    const std::size_t index = step.volume->geometry().index(v);
    const TsdfVoxel voxel = step.volume->voxels()[index];
    text += voxel.weight > 0 ? format("; tsdf %+.3f, weight %d", voxel.distance(), int(voxel.weight))
                             : "; no tsdf, weight 0: never observed";
  } else if (step.octree && step.octree->geometry().contains(v)) {
    const auto log_odds = step.octree->logOdds(v);
    text += log_odds ? format("; occupancy %.3f", 1.0 / (1.0 + std::exp(-*log_odds))) : "; not stored";
  }
  return text + "\nat " + placeText(picked.p_world);
}

}  // namespace

std::string textOf(const Picked& picked, const StepData& step, const std::vector<CandidateRow>& rows) {
  switch (picked.kind) {
    case PickedKind::Frustum:
      return viewText(picked, step, rows);
    case PickedKind::ContourPoint:
      return contourText(picked, step);
    case PickedKind::Segment:
      return segmentText(picked, step) + voxelText(picked, step);
    case PickedKind::Voxel:
      return voxelText(picked, step);
  }
  return "";
}

}  // namespace vantage
