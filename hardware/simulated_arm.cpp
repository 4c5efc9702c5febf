#include "hardware/simulated_arm.h"

#include <algorithm>
#include <stdexcept>

#include "core/exploration/arm_start.h"
#include "core/motion/body_image.h"
#include "core/volume/occupancy_octree.h"

namespace vantage {
namespace {

Eigen::Vector3d randomDirection(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return Eigen::Vector3d(x, y, z).normalized();
}

/// The nearer surface of two images of the same size.
void drawOver(DepthImage& depth, const DepthImage& body, double min_range_m) {
  for (std::size_t i = 0; i < depth.depth_m.size(); ++i) {
    const float hit = body.depth_m[i];
    if (!DepthImage::valid(hit) || depth.depth_m[i] <= hit) continue;
    depth.depth_m[i] = hit >= min_range_m ? hit : DepthImage::kInvalid;
  }
}

}  // namespace

SimulatedArm::SimulatedArm(std::unique_ptr<ArmPlanner> planner, std::vector<JointVector> start,
                           const ArmErrors& errors)
    : planner_(std::move(planner)), start_(std::move(start)), errors_(errors), random_(errors.seed) {
  errors.validate();
  if (start_.empty()) throw std::invalid_argument("SimulatedArm: no start");
  const Eigen::Vector3d offset = randomDirection(random_) * errors.mount_error_m;
  const Eigen::Vector3d axis = randomDirection(random_);
  mount_error_ = makePose(offset, Eigen::Quaterniond(Eigen::AngleAxisd(errors.mount_error_rad, axis)));
  true_joints_ = start_.front();
  readEncoders();
}

RobotState SimulatedArm::state() const {
  return {planner_->cameraPose(read_joints_), read_joints_};
}

std::vector<Pose> SimulatedArm::startPoses() const {
  std::vector<Pose> poses;
  for (const JointVector& q : start_) poses.push_back(planner_->cameraPose(q));
  return poses;
}

void SimulatedArm::readEncoders() {
  read_joints_ = true_joints_;
  std::normal_distribution<double> normal;
  for (Eigen::Index i = 0; i < read_joints_.size(); ++i) {
    const ArmJoint& joint = planner_->model().joints[i];
    read_joints_[i] =
        std::clamp(read_joints_[i] + errors_.encoder_noise_rad * normal(random_), joint.lower, joint.upper);
  }
}

void SimulatedArm::adjust(const Pose& T_world_camera) {
  const std::vector<JointVector> goals = planner_->solutions(T_world_camera, read_joints_);
  if (goals.empty()) return;
  const JointTrajectory motion = planner_->timed({read_joints_, goals.front()});
  if (planner_->refusal(motion, read_joints_).empty()) follow(motion, {});
}

MotionPlan SimulatedArm::plan(const Pose& T_world_camera, std::uint64_t seed) {
  return planner_->plan(state(), T_world_camera, seed);
}

double SimulatedArm::execute(const MotionPlan& plan, const RunControl& control) {
  if (!plan.trajectory) throw ArmRefusal("the motion is not sent: it has no trajectory");
  follow(*plan.trajectory, control);
  return plan.trajectory->duration_s();
}

void SimulatedArm::follow(const JointTrajectory& trajectory, const RunControl& control) {
  planner_->requireSafe(trajectory, read_joints_);
  for (const JointVector& q : trajectory.positions) {
    if (control.stop.stop_requested()) break;
    moveTo(q);
  }
  readEncoders();
  control.check();
}

std::unique_ptr<ArmPlanner> startingPlanner(const RobotModel& model, const Settings& settings) {
  const ExplorationConfig& config = settings.exploration;
  auto planner = std::make_unique<ArmPlanner>(model, settings.armConfig());
  planner->observe(
      StateGrid(usesOctree(config.plannerOf(1))
                    ? OccupancyOctree::gridAround(config.volume.bounds(), config.octree.voxel_size_m)
                    : config.volume));
  return planner;
}

std::unique_ptr<SimulatedArm> startedArm(const RobotModel& model, const Settings& settings) {
  auto planner = startingPlanner(model, settings);
  std::vector<JointVector> start = armStart(*planner, settings.exploration.scan);
  ArmErrors errors = settings.arm_errors;
  errors.seed = settings.exploration.seed;
  return std::make_unique<SimulatedArm>(std::move(planner), std::move(start), errors);
}

std::optional<DepthFrame> EyeInHandCamera::capture(const Pose& T_world_camera, std::uint64_t index) {
  std::optional<DepthFrame> frame = camera_.capture(arm_.trueCameraPose(), index);
  if (!frame) return frame;
  const RobotModel& arm = arm_.planner().model();
  drawOver(frame->depth, bodyImage(arm, arm_.trueJoints(), model(), 0.0, arm_.mountError()),
           model().min_range_m);
  removeBody(frame->depth,
             bodyImage(arm, arm_.state().joints, model(), arm_.planner().config().body_margin_m));
  frame->T_world_camera = T_world_camera;
  return frame;
}

}  // namespace vantage
