#include "io/json_summary.h"

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "io/error.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json orNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json position(const Pose& pose) {
  const Eigen::Vector3d p = pose.translation();
  return {p.x(), p.y(), p.z()};
}

Json quaternion(const Pose& pose) {
  const Eigen::Quaterniond q = orientationOf(pose);
  return {q.x(), q.y(), q.z(), q.w()};
}

void putChosen(Json& step, const StepRecord& r) {
  const ChosenView* view = r.chosen();
  step["step"] = r.step;
  step["status"] = view ? "view" : "none";
  step["position_m"] = view ? position(view->T_world_camera) : Json(nullptr);
  step["quaternion_xyzw"] = view ? quaternion(view->T_world_camera) : Json(nullptr);
  step["gain"] = view ? Json(view->gain) : Json(nullptr);
  step["gain_voxels"] = view ? Json(view->gain_voxels) : Json(nullptr);
  step["realised_voxels"] = orNull(r.realised_voxels);
}

void putCounts(Json& step, const StepRecord& r) {
  const auto count = [&](std::uint64_t SearchCounts::*field) {
    return r.counts() ? Json(r.counts()->*field) : Json(nullptr);
  };
  step["poses_generated"] = count(&SearchCounts::poses_generated);
  step["poses_scored"] = count(&SearchCounts::poses_scored);
  step["poses_unreachable"] = count(&SearchCounts::poses_unreachable);
  step["rays"] = count(&SearchCounts::rays);
  step["voxels_visited"] = count(&SearchCounts::voxels_visited);
  step["unknown_voxels"] = r.metrics.unknown_voxels;
  step["coverage"] = orNull(r.metrics.coverage);
}

Json timings(const Timings& t) {
  Json all;
  all["sense"] = orNull(t.sense);
  all["filter"] = orNull(t.filter);
  all["fuse"] = orNull(t.fuse);
  all["contours"] = orNull(t.contours);
  all["surface"] = orNull(t.surface);
  all["segmentation"] = orNull(t.segmentation);
  all["saliency"] = orNull(t.saliency);
  all["generation"] = orNull(t.generation);
  all["evaluation"] = orNull(t.evaluation);
  all["collision_map"] = orNull(t.collision_map);
  all["motion_planning"] = orNull(t.motion_planning);
  all["motion"] = orNull(t.motion);
  return all;
}

/// Label and saliency of the segment that the chosen view is for; label 0 = points without a segment (D-B13).
/// Null without a view and for the baseline, which knows no segments.
void putSegment(Json& step, const StepRecord& r) {
  step["segment"] = nullptr;
  step["saliency"] = nullptr;
  if (!r.search || !r.search->chosen || !r.saliency || r.search->chosen->search >= r.search->segments.size())
    return;
  const SegmentSearch& from = r.search->segments[r.search->chosen->search];
  const auto& segments = r.saliency->segments;
  const bool labelled = from.segment >= 0 && from.segment < static_cast<std::int64_t>(segments.size());
  step["segment"] = labelled ? segments[from.segment].label : 0;
  step["saliency"] = from.saliency;
}

/// What the hierarchical planner adds; null for the others.
void putUtilities(Json& step, const StepRecord& r) {
  const UtilitySearch* u = r.utilities.get();
  const ViewUtility* view = u ? chosenUtility(*u) : nullptr;
  step["rejected_position"] = u ? Json(u->rejected_position) : Json(nullptr);
  step["rejected_registration"] = u ? Json(u->rejected_registration) : Json(nullptr);
  step["occupied"] = view ? Json(view->occupied) : Json(nullptr);
  step["distance"] = view ? Json(view->distance) : Json(nullptr);
  step["utility"] = view ? Json(view->utility) : Json(nullptr);
  step["literal_stop"] = u ? Json(u->literal_stop) : Json(nullptr);
}

void putBox(Json& object, const StepRecord& r) {
  object["box_unknown"] = r.box ? Json(r.box->unknown) : Json(nullptr);
  object["box_occupied"] = r.box ? Json(r.box->occupied) : Json(nullptr);
}

void putServed(Json& step, const std::optional<ScanPose>& served) {
  step["frame"] = served ? Json(served->frame) : Json(nullptr);
  step["served_position_m"] = served ? position(served->T_world_camera) : Json(nullptr);
  step["served_quaternion_xyzw"] = served ? quaternion(served->T_world_camera) : Json(nullptr);
}

Json stepObject(const StepRecord& r, bool replay) {
  Json step;
  putChosen(step, r);
  putCounts(step, r);
  step["timings_s"] = timings(r.timings);
  putSegment(step, r);
  step["toward_object"] = orNull(r.toward_object);
  step["unknown_near_objects"] = orNull(r.metrics.unknown_near_objects);
  step["unknown_in_boxes"] = orNull(r.metrics.unknown_in_boxes);
  step["planner"] = r.planner;
  putUtilities(step, r);
  putBox(step, r);
  if (replay) putServed(step, r.served);
  return step;
}

Json finalObject(const StepRecord& r) {
  const MapMetrics& m = r.metrics;
  Json last;
  last["unknown_voxels"] = m.unknown_voxels;
  last["coverage"] = orNull(m.coverage);
  last["unknown_near_objects"] = orNull(m.unknown_near_objects);
  last["unknown_in_boxes"] = orNull(m.unknown_in_boxes);
  putBox(last, r);
  return last;
}

}  // namespace

struct JsonSummary::State {
  Json object;
  bool replay = false;
};

JsonSummary::JsonSummary(const RunHeader& header) : state_(std::make_unique<State>()) {
  Json& o = state_->object;
  state_->replay = header.replay;
  o["version"] = header.version;
  o["input"] = header.input;
  o["planner"] = header.planner;
  o["robot"] = header.robot;
  o["seed"] = header.seed;
  o["threads"] = header.threads;
  o["compute"] = header.compute;
  o["stop_reason"] = nullptr;
  o["steps"] = Json::array();
  o["final"] = nullptr;
}

JsonSummary::~JsonSummary() = default;

void JsonSummary::add(const StepRecord& record) {
  if (record.closing) {
    state_->object["final"] = finalObject(record);
  } else {
    state_->object["steps"].push_back(stepObject(record, state_->replay));
  }
}

void JsonSummary::setRealised(const StepRecord& record) {
  for (Json& step : state_->object["steps"]) {
    if (step["step"] != record.step) continue;
    step["realised_voxels"] = orNull(record.realised_voxels);
    if (state_->replay) putServed(step, record.served);
    return;
  }
  throw std::invalid_argument("JSON summary: no step " + std::to_string(record.step) + " to fill in");
}

void JsonSummary::finish(const std::string& stop_reason) {
  state_->object["stop_reason"] = stop_reason;
}

std::string JsonSummary::text() const {
  return state_->object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void JsonSummary::write(const std::string& path) const {
  const std::string all = text();
  if (path == "-") {
    if (std::fwrite(all.data(), 1, all.size(), stdout) != all.size() || std::fflush(stdout) != 0)
      throw std::runtime_error("standard output: cannot write the JSON summary; check where it goes");
    return;
  }
  std::ofstream file(path, std::ios::binary);
  if (!file) throw InputError(path, "cannot be created; check the folder and its permissions");
  file << all;
  if (!file.flush()) throw std::runtime_error(path + ": cannot write the JSON summary; is the disk full?");
}

std::string stepJsonText(const StepRecord& record) {
  return stepObject(record, false).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::unique_ptr<JsonSummary> jsonSummary(const RunReader& run) {
  auto summary = std::make_unique<JsonSummary>(run.header());
  for (const int step : run.steps()) summary->add(run.step(step, RunDetail::NoVolume));
  if (run.hasClosing()) summary->add(run.closing(RunDetail::NoVolume));
  if (const auto reason = run.stopReason()) summary->finish(*reason);
  return summary;
}

}  // namespace vantage
