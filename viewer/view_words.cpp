#include "viewer/view_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "viewer/captions.h"

namespace vantage {
namespace {

/// The segment of a group; null for points without one.
const Segment* segmentOf(const StepRecord& record, std::size_t search) {
  const std::int32_t segment = record.search->segments[search].segment;
  if (segment < 0 || !record.saliency || segment >= static_cast<int>(record.saliency->segments.size()))
    return nullptr;
  return &record.saliency->segments[segment];
}

}  // namespace

std::string plural(std::uint64_t count, const std::string& noun) {
  return grouped(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string whole(double value) {
  return grouped(static_cast<std::uint64_t>(std::llround(std::max(0.0, value))));
}

std::string rounded(double value, int digits) {
  std::array<char, 64> text;
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

std::string fixed(double value, int decimals) {
  std::array<char, 64> text;
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

std::string searchName(const StepRecord& record, std::size_t search) {
  const std::string number = "no. " + std::to_string(search + 1);
  const Segment* segment = segmentOf(record, search);
  if (!segment) return number + " (contour points without a segment)";
  return number + " (label " + std::to_string(segment->label) + ", saliency " +
         fixed(record.search->segments[search].saliency) + ")";
}

std::string segmentName(const SceneFrame& frame, std::size_t search) {
  if (const Segment* segment = segmentOf(frame.record, search)) return std::to_string(segment->label);
  return plannerOf(frame) == "standard" ? "all" : "none";
}

std::string refusalWord(Reachability verdict) {
  switch (verdict) {
    case Reachability::OutOfReach:
      return "out of reach";
    case Reachability::InCollision:
      return "in collision";
    case Reachability::NotConnected:
      return "cut off";
    case Reachability::NoPath:
      return "without a path";
    case Reachability::TimedOut:
      return "out of time";
    case Reachability::NoFrame:
      return "without a frame";
    case Reachability::NoIk:
      return "beyond the joints";
    case Reachability::SelfCollision:
      return "touching itself";
    case Reachability::Reachable:
    case Reachability::NotChecked:
      break;
  }
  return "";
}

std::string refusals(const SegmentSearch& search, double threshold) {
  std::map<Reachability, std::uint64_t> counts;
  for (const PoseScore& score : search.scores) {
    if (score.gain <= threshold) break;
    if (isUnreachable(score.reachability)) ++counts[score.reachability];
  }
  std::string text;
  for (const auto& [verdict, count] : counts)
    text += (text.empty() ? "" : ", ") + grouped(count) + " " + refusalWord(verdict);
  return text;
}

std::string countUnit(const RunHeader& header, const StepRecord& record) {
  const bool octree = record.utilities || (!record.search && header.octree);
  const bool rays = octree ? !header.octree || header.octree->planner.count == GainCount::Rays
                           : header.contour_config.gain.count == GainMeasure::Rays;
  return rays ? "rays" : "voxels";
}

std::string countUnit(const SceneFrame& frame) {
  return countUnit(frame.header, frame.record);
}

}  // namespace vantage
