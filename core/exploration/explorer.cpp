#include "core/exploration/explorer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/exploration/plan_view.h"
#include "core/exploration/run_meter.h"
#include "core/exploration/stopwatch.h"

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

struct Explorer::State {
  State(ExplorationConfig config_, DepthCamera& camera_, Robot& robot_, const GroundTruth* truth_)
      : config(std::move(config_)),
        camera(camera_),
        robot(robot_),
        truth(truth_),
        object_box(config.objectBox()),
        world(config.world()),
        meter(config, world, truth_) {
    if (config.needsOctree()) prepareOctree();
  }

  /// Rays for its resolution; where a recorded camera has been, there is nothing (D-A10).
  void prepareOctree() {
    tree = RayTree(config.hierarchical.sensor, config.octree.voxel_size_m, config.hierarchical.coarse_levels);
    const double body_m = config.hierarchical.body_m / 2 + 2 * config.octree.voxel_size_m;
    for (const Pose& pose : camera.recordedPoses())
      world.clearOctree(pose.translation(), std::sqrt(3.0) * body_m);
    if (truth && config.octree.known_scene)
      for (const Box& box : truth->knownBoxes())
        world.occupyOctree(box, [&](const Eigen::Vector3d& p) { return truth->insideKnown(p); });
  }

  ExplorationConfig config;
  DepthCamera& camera;
  Robot& robot;
  const GroundTruth* truth;
  Box object_box;
  WorldModel world;
  RunMeter meter;
  RayTree tree;
  std::vector<StepObserver> observers;
  Exclusions exclusions;
  std::uint64_t frames_taken = 0;
  bool moved = false;  ///< the robot carried out the last step's motion

  void publish(StepRecord& record, Stage stage) {
    record.stage = stage;
    const auto snapshot = std::make_shared<const StepRecord>(record);
    for (const StepObserver& observer : observers) observer(snapshot);
  }

  bool isReplay() const { return !camera.recordedPoses().empty(); }
  std::vector<Pose> startPoses() const;
  bool scanInto(StepRecord& record, const std::vector<Pose>& poses, const SensorBubble& bubble,
                const RunControl& control);
  std::vector<Pose> scanPoses(const std::optional<StepRecord>& previous) const;
  bool observe(StepRecord& record, std::optional<StepRecord>& previous, const RunControl& control);
  ReachPose reachIn(const StepRecord& record, MotionPlan& reported);
  void plan(StepRecord& record, const RunControl& control);
  void planContour(StepRecord& record, const ReachPose& reach,
                   const std::function<void(Stage)>& publish_stage, const RunControl& control);
  void planHierarchical(StepRecord& record, const ReachPose& reach,
                        const std::function<void(Stage)>& publish_stage, const RunControl& control);
  void move(StepRecord& record, const RunControl& control);
  void close(StepRecord& record);
  void realise(StepRecord& previous, const StepRecord& scanned, std::uint64_t unknown_before);
};

std::vector<Pose> Explorer::State::startPoses() const {
  std::vector<Pose> recorded = camera.recordedPoses();
  if (recorded.empty()) {
    const std::vector<Pose> own = robot.startPoses();
    return own.empty() ? initialScanPoses(config.scan) : own;
  }
  if (static_cast<int>(recorded.size()) > config.scan.initial_frames)
    recorded.resize(config.scan.initial_frames);
  return recorded;
}

/// Sense and fuse. False if the camera had no frame at all.
bool Explorer::State::scanInto(StepRecord& record, const std::vector<Pose>& poses, const SensorBubble& bubble,
                               const RunControl& control) {
  double sense_s = 0.0, fuse_s = 0.0;
  std::optional<double> filter_s;
  DepthFrame last;
  FilteredDepth filtered;
  std::vector<JointVector> joints;
  for (std::size_t p = 0; p < poses.size(); ++p) {
    control.check();
    control.report("sense", p, poses.size());
    const Stopwatch sensing;
    robot.adjust(poses[p], control);
    std::optional<DepthFrame> frame = camera.capture(robot.state().T_world_camera, frames_taken);
    sense_s += sensing.seconds();
    if (!frame) break;
    ++frames_taken;
    if (config.filter.any()) {
      const Stopwatch filtering;
      filtered = filterDepth(frame->depth, camera.model(), config.filter);
      filter_s = filter_s.value_or(0.0) + filtering.seconds();
    }
    const Stopwatch fusing;
    world.fuse(config.filter.any() ? filtered.depth : frame->depth, frame->T_world_camera, camera.model(),
               bubble);
    fuse_s += fusing.seconds();
    record.scan.push_back({frame->T_world_camera, frame->frame});
    if (const JointVector q = robot.state().joints; q.size() > 0) joints.push_back(q);
    last = std::move(*frame);
  }
  if (record.scan.empty()) return false;
  if (isReplay()) robot.adjust(last.T_world_camera, control);  // the frame that served was taken there
  if (!joints.empty()) record.joints = share(std::move(joints));
  record.depth = share(std::move(last));
  if (config.filter.any()) record.filtered = share(std::move(filtered));
  record.timings.sense = sense_s;
  record.timings.filter = filter_s;
  publish(record, Stage::Sense);

  const Stopwatch updating;
  const MapChanges changes = world.finishScan();
  record.timings.fuse = fuse_s + updating.seconds();
  record.changed_bricks = changes.volume;
  record.changed_octree_bricks = changes.octree;
  meter.measureMap(record);
  publish(record, Stage::Fuse);
  return true;
}

ReachPose Explorer::State::reachIn(const StepRecord& record, MotionPlan& reported) {
  return [&, step = record.step, tried = std::uint64_t{0}](const Pose& pose) mutable {
    if (isReplay() && !config.serves(camera.posesLeft(), pose)) {
      MotionPlan none;
      none.verdict = Reachability::NoFrame;
      return none;
    }
    return judged(robot.plan(pose, pathSeed(config.seed, step, tried++)), config.enforce_reachability,
                  reported);
  };
}

void Explorer::State::plan(StepRecord& record, const RunControl& control) {
  const PlannerKind kind = config.plannerOf(record.step);
  const Stopwatch mapping;
  robot.observe(world.statesOf(kind));
  record.timings.collision_map = mapping.seconds();

  MotionPlan reported;  // where the verdict is only reported: of the last pose asked for, i.e. the chosen one
  const auto publish_stage = [&](Stage stage) {
    if (stage == Stage::Surface) meter.measureCoverage(record);
    if (stage == Stage::Evaluation) {
      if (!config.enforce_reachability) reportMotion(record, reported);
      meter.markTowardObject(record);
    }
    publish(record, stage);
  };
  const ReachPose reach = reachIn(record, reported);
  if (usesOctree(kind)) {
    meter.measureCoverage(record);
    planHierarchical(record, reach, publish_stage, control);
  } else {
    planContour(record, reach, publish_stage, control);
  }
}

void Explorer::State::planContour(StepRecord& record, const ReachPose& reach,
                                  const std::function<void(Stage)>& publish_stage,
                                  const RunControl& control) {
  ContourPlannerConfig planner = config.contour;
  planner.segment_by_segment = config.plannerOf(record.step) == PlannerKind::Contour;
  const PlanViewInput input{.volume = *world.volume(),
                            .states = *world.surfaceStates(),
                            .camera = camera.model(),
                            .workspace = config.workspace,
                            .config = planner,
                            .executed = exclusions.executed,
                            .disappointing = exclusions.disappointing};
  planView(record, input, reach, publish_stage, control);
}

void Explorer::State::planHierarchical(StepRecord& record, const ReachPose& reach,
                                       const std::function<void(Stage)>& publish_stage,
                                       const RunControl& control) {
  HierarchicalPlannerConfig planner = config.hierarchical;
  if (config.plannerOf(record.step) == PlannerKind::Uniform) planner.coarse_levels = 0;
  const std::vector<ScanPose> recorded =
      config.recorded_candidates ? camera.posesLeft() : std::vector<ScanPose>();
  const Pose current = robot.state().T_world_camera;
  const Box bounds = config.volume.bounds();
  const PlanUtilityInput input{.pyramid = *world.pyramid(),
                               .tree = tree,
                               .object_box = object_box,
                               .workspace = bounds,
                               .recorded = recorded,
                               .current = current,
                               .config = planner,
                               .executed = exclusions.executed,
                               .seed = pathSeed(config.seed, record.step, 0)};
  planUtility(record, input, reach, publish_stage, control);
}

/// Realised gain: the drop of the unknown in the region (evaluation.md, section 2). A voxel of the TSDF once
/// seen stays seen; the octree may forget some again (a hit and two misses), then it is what is left of the
/// gain.
void Explorer::State::realise(StepRecord& previous, const StepRecord& scanned, std::uint64_t unknown_before) {
  previous.realised_voxels = unknown_before - std::min(unknown_before, meter.unknownInRegion(previous));
  if (isReplay()) previous.served = scanned.scan.back();
  exclusions.add(previous, config.contour.gain);
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
const WorldModel& Explorer::world() const {
  return state_->world;
}

/// Along the arc at the start, later where the robot arrived; recorded data serve one frame a view.
std::vector<Pose> Explorer::State::scanPoses(const std::optional<StepRecord>& previous) const {
  if (!previous) return startPoses();
  const Pose view = moved ? robot.state().T_world_camera : previous->chosen()->T_world_camera;
  return isReplay() ? std::vector<Pose>{view} : tiltedScanPoses(view, config.scan);
}

/// Scan and fuse, and look back at what the last view gained. False if the camera had no frame left.
bool Explorer::State::observe(StepRecord& record, std::optional<StepRecord>& previous,
                              const RunControl& control) {
  const std::uint64_t unknown_before = previous ? meter.unknownInRegion(*previous) : 0;
  // The sensor has been here: its own neighbourhood is empty, all along the way of the initial scan. The
  // hierarchical planner flies through what its octree takes for free; the TSDF has to learn that from the
  // sensor itself, or nobody could plan a way back in it.
  const double radius_m = config.scan.clear_radius_m;
  SensorBubble bubble;
  if (!previous) bubble = {radius_m, radius_m};
  if (previous && usesOctree(config.plannerOf(previous->step))) bubble.volume_m = radius_m;
  if (!scanInto(record, scanPoses(previous), bubble, control)) {
    if (!previous) throw std::runtime_error("the camera served no frame for the initial scan");
    return false;
  }
  if (previous) realise(*previous, record, unknown_before);
  return true;
}

void Explorer::State::move(StepRecord& record, const RunControl& control) {
  moved = false;
  if (!record.hasView()) return;
  const MotionPlan& path = record.chosen()->path;
  if (path.verdict == Reachability::Reachable) {
    record.timings.motion = robot.execute(path, control);
    record.trajectory = path.trajectory;
    moved = !path.waypoints.empty();
  }
  publish(record, Stage::Motion);
}

/// What is left to say after the last scan.
void Explorer::State::close(StepRecord& record) {
  if (world.volume())
    record.surface = share(extractSurface(*world.volume(), config.contour.contours.weight_threshold));
  meter.measureCoverage(record);
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
      record.planner = toString(s.config.plannerOf(step));

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
      s.move(record, control);
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
  } catch (const DeviceLost& lost) {
    result.stop_reason = "device lost";
    result.lost = lost.what();
    return result;
  }
}

}  // namespace vantage
