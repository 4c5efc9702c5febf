#include "core/exploration/explorer.h"

#include <utility>

#include "core/exploration/map_metrics.h"
#include "core/exploration/plan_view.h"
#include "core/exploration/stopwatch.h"
#include "core/geometry/check.h"

namespace vantage {
namespace {

template <class T>
std::shared_ptr<const std::decay_t<T>> share(T&& value) {
  return std::make_shared<const std::decay_t<T>>(std::forward<T>(value));
}

}  // namespace

std::string_view toString(Stage stage) {
  constexpr std::string_view kNames[] = {"sense",        "fuse",     "contours",   "surface",
                                         "segmentation", "saliency", "generation", "evaluation",
                                         "motion",       "done",     "realised"};
  return kNames[static_cast<int>(stage)];
}

void ExplorationConfig::validate() const {
  planner.validate();
  requireInRange("volume.voxel_size_m", volume.voxel_size_m, 1e-4, 1.0);
  for (int a = 0; a < 3; ++a) {
    requireInRange("volume.size", volume.size[a], 2, 1 << 20);
    requireInRange("workspace.max_m", workspace.max()[a], workspace.min()[a], 1e6);
  }
  fusion.validate(volume.voxel_size_m);
  scan.validate();
  requireInRange("exploration.steps", steps, 0, 100000);
}

struct Explorer::State {
  State(ExplorationConfig config_, DepthCamera& camera_, Robot& robot_, const GroundTruth* truth_)
      : config(std::move(config_)),
        camera(camera_),
        robot(robot_),
        truth(truth_),
        volume(config.volume),
        states(config.volume),
        metrics(config.volume, config.workspace, truth_) {}

  ExplorationConfig config;
  DepthCamera& camera;
  Robot& robot;
  const GroundTruth* truth;
  TsdfVolume volume;
  StateGrid states;
  MapMetricsCounter metrics;
  std::vector<StepObserver> observers;
  Exclusions exclusions;
  std::uint64_t frames_taken = 0;

  void publish(StepRecord& record, Stage stage) {
    record.stage = stage;
    const auto snapshot = std::make_shared<const StepRecord>(record);
    for (const StepObserver& observer : observers) observer(snapshot);
  }

  bool isReplay() const { return !camera.recordedPoses().empty(); }
  std::vector<Pose> startPoses() const;
  bool scanInto(StepRecord& record, const std::vector<Pose>& poses, bool clear_start,
                const RunControl& control);
  std::vector<Pose> scanPoses(const std::optional<StepRecord>& previous) const;
  bool observe(StepRecord& record, std::optional<StepRecord>& previous, const RunControl& control);
  void plan(StepRecord& record, const RunControl& control);
  void move(StepRecord& record);
  void close(StepRecord& record);
  void measureCoverage(StepRecord& record) const;
  void markTowardObject(StepRecord& record) const;
  void realise(StepRecord& previous, const StepRecord& scanned, std::uint64_t unknown_before);
  std::uint64_t unknownInRegion(const StepRecord& record) const;
};

std::vector<Pose> Explorer::State::startPoses() const {
  std::vector<Pose> recorded = camera.recordedPoses();
  if (recorded.empty()) return initialScanPoses(config.scan);
  if (static_cast<int>(recorded.size()) > config.scan.initial_frames)
    recorded.resize(config.scan.initial_frames);
  return recorded;
}

/// Sense and fuse. False if the camera had no frame at all.
bool Explorer::State::scanInto(StepRecord& record, const std::vector<Pose>& poses, bool clear_start,
                               const RunControl& control) {
  double sense_s = 0.0, fuse_s = 0.0;
  BrickSet changed(volume.bricks().total());
  DepthFrame last;
  for (std::size_t p = 0; p < poses.size(); ++p) {
    control.check();
    control.report("sense", p, poses.size());
    const Stopwatch sensing;
    std::optional<DepthFrame> frame = camera.capture(poses[p], frames_taken);
    sense_s += sensing.seconds();
    if (!frame) break;
    ++frames_taken;
    const Stopwatch fusing;
    // The sensor has been here: its own neighbourhood is empty (D-B28), all along the way of the initial
    // scan.
    if (clear_start)
      changed.merge(clearSphere(volume, frame->T_world_camera.translation(), config.scan.clear_radius_m));
    changed.merge(
        fuseDepth(volume, frame->depth, camera.model(), frame->T_world_camera, config.fusion).changed);
    fuse_s += fusing.seconds();
    record.scan.push_back({frame->T_world_camera, frame->frame});
    last = std::move(*frame);
  }
  if (record.scan.empty()) return false;
  robot.localise(last.T_world_camera);
  record.depth = share(std::move(last));
  record.timings.sense = sense_s;
  publish(record, Stage::Sense);

  const Stopwatch updating;
  states.update(volume, changed);
  record.timings.fuse = fuse_s + updating.seconds();
  std::vector<TsdfBrick> bricks;
  for (const std::uint32_t brick : changed.list()) bricks.push_back({brick, volume.brick(brick)});
  record.changed_bricks = share(std::move(bricks));
  record.metrics = metrics.count(states);
  publish(record, Stage::Fuse);
  return true;
}

void Explorer::State::plan(StepRecord& record, const RunControl& control) {
  const Stopwatch mapping;
  robot.observe(states);
  record.timings.collision_map = mapping.seconds();

  std::uint64_t tried = 0;
  MotionPlan reported;  // where the verdict is only reported: of the last pose asked for, i.e. the chosen one
  const ReachPose reach = [&](const Pose& pose) {
    return judged(robot.plan(pose, pathSeed(config.seed, record.step, tried++)), config.enforce_reachability,
                  reported);
  };
  const auto publish_stage = [&](Stage stage) {
    if (stage == Stage::Surface) measureCoverage(record);
    if (stage == Stage::Evaluation) {
      if (!config.enforce_reachability) reportMotion(record, reported);
      markTowardObject(record);
    }
    publish(record, stage);
  };
  const PlanViewInput input{.volume = volume,
                            .states = states,
                            .camera = camera.model(),
                            .workspace = config.workspace,
                            .config = config.planner,
                            .executed = exclusions.executed,
                            .disappointing = exclusions.disappointing};
  planView(record, input, reach, publish_stage, control);
}

void Explorer::State::measureCoverage(StepRecord& record) const {
  if (truth) record.metrics.coverage = surfaceCoverage(truth->observableSurface(), *record.surface);
}

/// evaluation.md, section 2.
void Explorer::State::markTowardObject(StepRecord& record) const {
  if (!truth || !record.hasView()) return;
  const ContourPoint& point = record.contours->points[record.search->chosen->contour_point];
  record.toward_object = truth->objectDistance(point.position_m) <= kObjectMargin_m;
}

std::uint64_t Explorer::State::unknownInRegion(const StepRecord& record) const {
  const SegmentSearch& segment = record.search->segments[record.search->chosen->search];
  if (!config.planner.segment_by_segment) return states.count(VoxelState::Unknown, config.workspace);
  return countUnknown(states, segment.sphere);
}

/// Realised gain: a voxel once seen stays seen, so it is the drop of the unknown in the region
/// (evaluation.md, section 2).
void Explorer::State::realise(StepRecord& previous, const StepRecord& scanned, std::uint64_t unknown_before) {
  previous.realised_voxels = unknown_before - unknownInRegion(previous);
  if (isReplay()) previous.served = scanned.scan.back();
  exclusions.add(previous, config.planner.gain);
  publish(previous, Stage::Realised);
}

Explorer::Explorer(ExplorationConfig config, DepthCamera& camera, Robot& robot, const GroundTruth* truth) {
  config.validate();
  state_ = std::make_unique<State>(std::move(config), camera, robot, truth);
}

Explorer::~Explorer() = default;

void Explorer::addObserver(StepObserver observer) {
  state_->observers.push_back(std::move(observer));
}
const TsdfVolume& Explorer::volume() const {
  return state_->volume;
}
const StateGrid& Explorer::states() const {
  return state_->states;
}

/// Along the arc at the start, at the last view later; recorded data serve one frame a view.
std::vector<Pose> Explorer::State::scanPoses(const std::optional<StepRecord>& previous) const {
  if (!previous) return startPoses();
  const Pose& view = previous->search->chosen->T_world_camera;
  return isReplay() ? std::vector<Pose>{view} : tiltedScanPoses(view, config.scan);
}

/// Scan and fuse, and look back at what the last view gained. False if the camera had no frame left.
bool Explorer::State::observe(StepRecord& record, std::optional<StepRecord>& previous,
                              const RunControl& control) {
  const std::uint64_t unknown_before = previous ? unknownInRegion(*previous) : 0;
  if (!scanInto(record, scanPoses(previous), !previous, control)) {
    if (!previous) throw std::runtime_error("the camera served no frame for the initial scan");
    return false;
  }
  if (previous) realise(*previous, record, unknown_before);
  return true;
}

void Explorer::State::move(StepRecord& record) {
  if (!record.hasView()) return;
  const MotionPlan& path = record.search->chosen->path;
  if (path.verdict == Reachability::Reachable) record.timings.motion = robot.execute(path);
  publish(record, Stage::Motion);
}

/// What is left to say after the last scan.
void Explorer::State::close(StepRecord& record) {
  record.surface = share(extractSurface(volume, config.planner.contours.weight_threshold));
  measureCoverage(record);
  publish(record, Stage::Done);
}

ExplorationResult Explorer::run(const RunControl& control) {
  State& s = *state_;
  ExplorationResult result;
  std::optional<StepRecord> previous;
  try {
    for (int step = 1;; ++step) {
      StepRecord record;
      record.step = step;
      record.closing = step > s.config.steps;
      record.planner = s.config.planner.segment_by_segment ? kPlannerContour : kPlannerStandard;

      if (!s.observe(record, previous, control)) {
        result.stop_reason = "no frames left";
        return result;
      }
      if (record.closing) {
        s.close(record);
        result.stop_reason = "steps done";
        return result;
      }
      s.plan(record, control);
      s.move(record);
      s.publish(record, Stage::Done);
      result.steps = step;
      if (!record.hasView()) {  // D-B14
        result.stop_reason = "finished";
        return result;
      }
      previous = std::move(record);
    }
  } catch (const Cancelled&) {
    result.stop_reason = "cancelled";
    return result;
  }
}

}  // namespace vantage
