#include "viewer/captions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "viewer/segment_scores.h"
#include "viewer/view_words.h"

namespace vantage {
namespace {

template <class... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 512> text;
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

std::string percent(double share) {
  return format(share > 0.0 && share < 0.095 ? "%.1f %%" : "%.0f %%", 100.0 * share);
}

/// " Path: 1.20 m, straight." of a chosen view that a path leads to.
template <class Search>
std::string pathText(const Search& search) {
  if (!search.chosen || search.chosen->path.length_m <= 0.0) return "";
  return format(" Path: %.2f m, %s.", search.chosen->path.length_m,
                search.chosen->path.straight ? "straight" : "around obstacles");
}

/// The first segments with a saliency that the planner did not take.
std::string otherSaliencyText(const SceneFrame& frame, const LayerStyle& style) {
  constexpr std::size_t kNamed = 4;
  const std::vector<Segment> segments = shownSegments(frame, style);
  const std::vector<std::uint32_t> order = shownOrder(frame, style);
  std::string text = "By " + saliencyWords(style) + " they would be tried in this order:";
  for (std::size_t i = 0; i < std::min(order.size(), kNamed); ++i) {
    const std::int32_t of_segment = frame.record.search->segments[order[i]].segment;
    text += i > 0 ? "; no. " : " no. ";
    text += std::to_string(i + 1);
    if (of_segment < 0) {
      text += " (contour points without a segment)";
      continue;
    }
    const Segment& segment = segments[static_cast<std::size_t>(of_segment)];
    text += " (label " + std::to_string(segment.label) + ", " + fixed(segment.saliency) + ")";
  }
  return text + (order.size() > kNamed ? "; ..." : ".");
}

}  // namespace

std::string grouped(std::uint64_t value) {
  const std::string digits = std::to_string(value);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ' ';
    text += digits[i];
  }
  return text;
}

std::string lengthText(double metres) {
  const auto [value, unit] = metres < 0.01 - 1e-9  ? std::pair{metres * 1e3, "mm"}
                             : metres < 1.0 - 1e-9 ? std::pair{metres * 1e2, "cm"}
                                                   : std::pair{metres, "m"};
  const bool whole = std::abs(value - std::round(value)) < 0.005;
  return format(whole ? "%.0f %s" : value < 10.0 ? "%.1f %s" : "%.0f %s", value, unit);
}

std::string volumeText(double cubic_metres) {
  const auto [value, unit] = cubic_metres < 1e-3 - 1e-12  ? std::pair{cubic_metres * 1e6, "cm³"}
                             : cubic_metres < 1.0 - 1e-12 ? std::pair{cubic_metres * 1e3, "dm³"}
                                                          : std::pair{cubic_metres, "m³"};
  return format(value < 9.995 ? "%.2f %s" : value < 99.95 ? "%.1f %s" : "%.0f %s", value, unit);
}

std::string stepLine(const SceneFrame& frame) {
  const std::string input = std::filesystem::path(frame.header.input).stem().string();
  std::string text = input.empty() ? "run" : input;
  const std::string& planner = plannerOf(frame);
  if (!planner.empty()) text += "  ·  " + planner + " planner";
  if (frame.record.closing) return text + "  ·  map after the last scan";
  text += "  ·  step " + std::to_string(frame.record.step);
  if (frame.record.stage < Stage::Done)
    text += "  ·  after stage " + std::string(toString(frame.record.stage));
  return text;
}

std::string scanFigures(const SceneFrame& frame, const LayerStyle&) {
  const StepRecord& record = frame.record;
  if (!record.depth) return "No depth image was recorded.";
  std::uint64_t valid = 0;
  for (const float depth : record.depth->depth.depth_m) valid += DepthImage::valid(depth);
  const std::uint64_t pixels = std::max<std::size_t>(1, record.depth->depth.depth_m.size());
  const Eigen::Vector3d eye =  // in whole centimetres; adding 0 takes the sign off zero
      (record.depth->T_world_camera.translation() * 100.0).array().round() / 100.0 + 0.0;
  std::string text = plural(std::max<std::size_t>(1, record.scan.size()), "frame") + " fused";
  if (record.depth->frame >= 0) text += format(" (recorded frame %d)", record.depth->frame);
  text += format("; the last one from (%.2f, %.2f, %.2f) m has %s of its pixels valid.", eye.x(), eye.y(),
                 eye.z(), percent(static_cast<double>(valid) / pixels).c_str());
  return text;
}

std::string filterFigures(const SceneFrame& frame, const LayerStyle&) {
  if (!frame.record.filtered) return "No depth filter was switched on.";
  const MaskCounts counts = countMask(frame.record.filtered->mask);
  const std::uint64_t valid = std::max<std::uint64_t>(1, counts.kept + counts.removed());
  const auto share = [&](std::uint64_t pixels) { return percent(static_cast<double>(pixels) / valid); };
  std::string text = grouped(counts.removed()) + " of " + grouped(valid) + " measured pixels were removed (" +
                     share(counts.removed()) + "): shadow " + grouped(counts.shadow) + ", veil " +
                     grouped(counts.veil) + ", shadow and veil " + grouped(counts.both);
  return text + (counts.edge > 0 ? ", edges " + grouped(counts.edge) + "." : ".");
}

std::string stateFigures(const SceneFrame& frame, const LayerStyle&) {
  const Box& box = frame.header.workspace;
  const std::uint64_t unknown = frame.states.count(VoxelState::Unknown, box);
  const std::uint64_t known =
      frame.states.count(VoxelState::Free, box) + frame.states.count(VoxelState::Occupied, box);
  const std::uint64_t all = std::max<std::uint64_t>(1, unknown + known);
  std::string text = "Unknown: " + grouped(unknown) + " of " + grouped(unknown + known) +
                     " voxels of the workspace (" + percent(static_cast<double>(unknown) / all) +
                     "), voxels of " + lengthText(frame.states.geometry().voxel_size_m) + ".";
  if (frame.record.box && onOctree(frame)) {
    text += " In the object's box: " + grouped(frame.record.box->unknown) + " unknown, " +
            grouped(frame.record.box->occupied) + " occupied.";
  } else if (frame.record.metrics.unknown_near_objects) {
    text += " Within 5 cm of the objects: " + grouped(*frame.record.metrics.unknown_near_objects) + ".";
  }
  if (frame.record.metrics.coverage)
    text += " Coverage of the objects: " + percent(*frame.record.metrics.coverage) + ".";
  return text;
}

std::string contourFigures(const SceneFrame& frame, const LayerStyle&) {
  if (onOctree(frame))
    return "The " + plannerOf(frame) + " planner has no contours: it traces rays in the octree.";
  const auto& contours = frame.record.contours;
  if (!contours || contours->voxels.empty())
    return "No contours: no free voxel touches both surface and unknown.";
  std::string text = plural(contours->voxels.size(), "contour voxel") +
                     " (free, beside surface and unknown) reduced to " +
                     plural(contours->points.size(), "contour point");
  const int poses = frame.header.contour_config.views.posesPerPoint();
  if (frame.record.positions) {
    text += " with " + std::to_string(poses) +
            " view poses each: " + plural(contours->points.size() * poses, "pose");
  }
  return text + ".";
}

std::string segmentFigures(const SceneFrame& frame, const LayerStyle& style) {
  if (onOctree(frame))
    return "The " + plannerOf(frame) + " planner has no segments: it traces rays in the octree.";
  const StepRecord& record = frame.record;
  if (!record.saliency || record.saliency->segments.empty()) {
    return plannerOf(frame) == "standard"
               ? "The standard planner does not use segments: it scores all views alike."
               : "The surface has no segments.";
  }
  std::string text = plural(record.saliency->segments.size(), "segment") + ". ";
  if (!record.search || record.search->segments.empty()) return text + "None has contour points.";
  if (asksOtherSaliency(style)) return text + otherSaliencyText(frame, style);
  text += "Tried in the order of saliency: ";
  const auto& searches = record.search->segments;
  const std::size_t shown = std::min<std::size_t>(searches.size(), 4);
  for (std::size_t i = 0; i < shown; ++i) {
    if (i > 0) text += "; ";
    text += searchName(record, i) + " with " + plural(searches[i].poses_generated, "pose");
  }
  return text + (searches.size() > shown ? "; ..." : ".");
}

std::string viewFigures(const SceneFrame& frame, const LayerStyle& style) {
  const StepRecord& record = frame.record;
  if (record.utilities) return utilityFigures(frame, style) + pathText(*record.utilities);
  if (!record.search) return "No views were evaluated.";
  const ViewSearch& search = *record.search;
  const double threshold = frame.header.contour_config.gain.gain_threshold;
  const std::string unit = countUnit(frame);
  const std::string limit = "the threshold of " + grouped(static_cast<std::uint64_t>(threshold)) + " " + unit;
  if (!search.chosen) {
    std::string text = "No view was chosen: " + plural(search.counts.poses_scored, "pose") + " scored, " +
                       grouped(search.counts.poses_above_threshold) + " above " + limit;
    if (search.counts.poses_unreachable > 0)
      text += ", " + grouped(search.counts.poses_unreachable) + " of them cannot be reached";
    return text + ".";
  }
  const ContourChosenView& chosen = *search.chosen;
  const SegmentSearch* segment = shownSearch(record);
  std::string text;
  if (chosen.search > 0) text = plural(chosen.search, "more salient segment") + " had no view; ";
  if (plannerOf(frame) == "standard") {
    text = plural(search.counts.poses_scored, "view") + " scored over the whole workspace. ";
  } else if (chosen.search < search.segments.size()) {
    text += (text.empty() ? "Segment tried first: " : "then ") + searchName(record, chosen.search) + ". ";
  }
  text += "View " + std::to_string(chosen.id) + " gains " + grouped(static_cast<std::uint64_t>(chosen.gain)) +
          " " + unit + (unit == "rays" ? " (" + plural(chosen.gain_voxels, "voxel") + ")" : "") + ", above " +
          limit + ".";
  const std::string refused = segment ? refusals(*segment, threshold) : "";
  if (!refused.empty()) text += " Better views were skipped: " + refused + ".";
  return text + pathText(search);
}

}  // namespace vantage
