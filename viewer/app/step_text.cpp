#include "viewer/app/step_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "viewer/app/counted.h"

namespace vantage::app {
namespace {

struct StageSummary {
  std::string count;
  std::optional<double> seconds;
};

std::size_t changedBricks(const StepRecord& r) {
  return (r.changed_bricks ? r.changed_bricks->size() : 0) +
         (r.changed_octree_bricks ? r.changed_octree_bricks->size() : 0);
}

StageSummary summarise(const StepRecord& r) {
  const Timings& t = r.timings;
  switch (r.stage) {
    case Stage::Sense:
      return {counted(r.scan.size(), "frame"), t.sense};
    case Stage::Fuse:
      return {counted(changedBricks(r), "brick") + " changed", t.fuse};
    case Stage::Contours:
      return {
          fmt::format("{} contour voxels, {} points", r.contours->voxels.size(), r.contours->points.size()),
          t.contours};
    case Stage::Surface:
      return {fmt::format("{} vertices", r.surface->points.size()), t.surface};
    case Stage::Segmentation:
      return {fmt::format("{} supervoxels, {} segments", r.labels->supervoxels, r.labels->count),
              t.segmentation};
    case Stage::Saliency:
      return {fmt::format("{} segments", r.saliency->segments.size()), t.saliency};
    case Stage::Generation:
      return {r.positions ? fmt::format("{} positions", r.positions->size()) : "", t.generation};
    case Stage::Evaluation:
      return {fmt::format("{} poses scored, {} rays", r.counts()->poses_scored, r.counts()->rays),
              t.evaluation};
    case Stage::Motion:
      return {fmt::format("{:.2f} m", r.chosen()->path.length_m), t.motion_planning};
    case Stage::Realised:
      return {fmt::format("{} voxels realised", r.realised_voxels.value_or(0)), {}};
    case Stage::Done:
      break;
  }
  return {"", {}};
}

std::string mapText(const StepRecord& r) {
  const MapMetrics& m = r.metrics;
  std::string text = fmt::format("{} unknown voxels in the workspace", m.unknown_voxels);
  if (m.unknown_near_objects) text += fmt::format(", {} near objects", *m.unknown_near_objects);
  if (r.box) text += fmt::format(", {} in the object's box", r.box->unknown);
  if (m.coverage) text += fmt::format(", coverage {:.1f} %", *m.coverage * 100);
  return text;
}

/// "140 of 320 views rejected by position, 33 by registration, 2 taken before"
std::string rejectedText(const UtilitySearch& u) {
  std::string text = fmt::format("{} of {} views rejected by position, {} by registration",
                                 u.rejected_position, u.counts.poses_generated, u.rejected_registration);
  if (u.counts.poses_executed_before > 0)
    text += fmt::format(", {} taken before", u.counts.poses_executed_before);
  return text;
}

/// What keeps all of them from being taken: of a replay often that no frame is left near them.
std::string whyNone(const UtilitySearch& u) {
  std::uint64_t frameless = 0;
  for (const ViewUtility& view : u.views) frameless += view.reachability == Reachability::NoFrame;
  if (frameless == 0) return "none can be reached";
  return frameless == u.counts.poses_unreachable ? "no recorded frame is left near any of them"
                                                 : "none can be reached or has a recorded frame left near it";
}

/// Why the hierarchical planner chose none.
std::string noUtilityText(const UtilitySearch& u, double stop_gain) {
  const SearchEnd end = endOf(u, stop_gain);
  if (end == SearchEnd::NoSurvivor) return "no view: none is left; " + rejectedText(u);
  if (end == SearchEnd::LittleUnknown || u.counts.poses_unreachable == 0)
    return fmt::format(
        "no view: the best of {} left sees {:.0f} unknown, fewer than {:g} (utility.stop_gain); {}",
        counted(u.ranking.size(), "view"), u.best_unknown, std::max(stop_gain, 1.0), rejectedText(u));
  return fmt::format("no view: {} enough unknown ({:g} or more), {}; {}",
                     u.counts.poses_above_threshold == 1
                         ? "1 view sees"
                         : fmt::format("{} views see", u.counts.poses_above_threshold),
                     stop_gain, whyNone(u), rejectedText(u));
}

/// The choice of the hierarchical planner.
std::string utilityText(const StepRecord& r, double stop_gain) {
  const UtilitySearch& u = *r.utilities;
  const ViewUtility* view = chosenUtility(u);
  if (!view) return noUtilityText(u, stop_gain);
  const Eigen::Vector3d p = view->T_world_camera.translation();
  // D-A18: the best by utility may see less than h_stop, as long as another survivor sees as much.
  const std::string other =
      view->unknown < stop_gain ? fmt::format(" (another view {:.0f})", u.best_unknown) : "";
  std::string text = fmt::format(
      "view {} at ({:.2f}, {:.2f}, {:.2f}) m sees {:.0f} unknown{} and {:.0f} occupied, distance factor "
      "{:.2f}, utility {:.3g}; {}; {} unreachable",
      view->id, p.x(), p.y(), p.z(), view->unknown, other, view->occupied, view->distance, view->utility,
      rejectedText(u), counted(u.counts.poses_unreachable, "better one"));
  if (u.chosen->path.verdict != Reachability::Reachable)
    text += fmt::format("; motion: {}", toString(u.chosen->path.verdict));
  return text;
}

std::string choiceText(const StepRecord& r, double stop_gain) {
  if (r.utilities) return utilityText(r, stop_gain);
  const SearchCounts& n = r.search->counts;
  if (!r.hasView())
    return fmt::format("no view: {} poses scored, {} above the threshold, {} of them unreachable",
                       n.poses_scored, n.poses_above_threshold, n.poses_unreachable);
  const ContourChosenView& c = *r.search->chosen;
  const SegmentSearch& search = r.search->segments[c.search];
  std::string text;
  if (search.segment >= 0)
    text = fmt::format("segment {} (saliency {:.3f}) ", r.saliency->segments[search.segment].label,
                       search.saliency);
  const Eigen::Vector3d p = c.T_world_camera.translation();
  text += fmt::format(
      "view {} at ({:.2f}, {:.2f}, {:.2f}) m gains {:.0f} rays; {} of {} poses scored, {} unreachable "
      "skipped",
      c.id, p.x(), p.y(), p.z(), c.gain, n.poses_scored, n.poses_generated, n.poses_unreachable);
  if (c.path.verdict != Reachability::Reachable)
    text += fmt::format("; motion: {}", toString(c.path.verdict));
  if (r.toward_object) text += *r.toward_object ? "; toward an object" : "; not toward an object";
  return text;
}

}  // namespace

std::string stageText(const StepRecord& record) {
  const StageSummary s = summarise(record);
  std::string text = fmt::format("step {} {}", record.step, toString(record.stage));
  if (!s.count.empty()) text += ": " + s.count;
  if (s.seconds) text += fmt::format(", {:.3f} s", *s.seconds);
  return text;
}

std::string servedText(const StepRecord& record) {
  const Pose& planned = record.chosen()->T_world_camera;
  const Pose& served = record.served->T_world_camera;
  return fmt::format("        served by frame {}, {:.2f} m and {:.0f} deg from the view",
                     record.served->frame, (served.translation() - planned.translation()).norm(),
                     angleBetween(served, planned) * 180.0 / std::numbers::pi);
}

std::string stepText(const StepRecord& record, double stop_gain) {
  if (record.closing) return fmt::format("end     {}", mapText(record));
  return fmt::format("step {:<2} {}\n        {}", record.step, choiceText(record, stop_gain),
                     mapText(record));
}

}  // namespace vantage::app
