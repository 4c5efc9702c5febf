#include "hardware/arm.h"

#include <stdexcept>
#include <utility>

#include "core/motion/body_image.h"
#include "core/volume/occupancy_octree.h"

namespace vantage {

Arm::Arm(std::unique_ptr<ArmPlanner> planner, std::vector<JointVector> start)
    : planner_(std::move(planner)), start_(std::move(start)) {
  if (start_.empty()) throw std::invalid_argument("Arm: no start");
}

RobotState Arm::state() const {
  const JointVector q = joints();
  return {planner_->cameraPose(q), q};
}

std::vector<Pose> Arm::startPoses() const {
  std::vector<Pose> poses;
  for (const JointVector& q : start_) poses.push_back(planner_->cameraPose(q));
  return poses;
}

void Arm::adjust(const Pose& T_world_camera, const RunControl& control) {
  const JointVector here = joints();
  const std::vector<JointVector> goals = planner_->solutions(T_world_camera, here);
  if (goals.empty()) return;
  const JointTrajectory motion = planner_->timed({here, goals.front()});
  if (planner_->refusal(motion, here).empty()) follow(motion, control);
}

MotionPlan Arm::plan(const Pose& T_world_camera, std::uint64_t seed) {
  return planner_->plan(state(), T_world_camera, seed);
}

double Arm::execute(const MotionPlan& plan, const RunControl& control) {
  if (!plan.trajectory) throw ArmRefusal("the motion is not sent: it has no trajectory");
  planner_->requireSafe(*plan.trajectory, joints());
  follow(*plan.trajectory, control);
  return plan.trajectory->duration_s();
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

std::optional<DepthFrame> EyeInHandCamera::capture(const Pose& T_world_camera, std::uint64_t index) {
  std::optional<DepthFrame> frame = look(T_world_camera, index);
  if (!frame) return frame;
  const ArmPlanner& arm = arm_.planner();
  removeBody(frame->depth, bodyImage(arm.model(), arm_.state().joints, model(), arm.config().body_margin_m));
  frame->T_world_camera = T_world_camera;
  return frame;
}

}  // namespace vantage
