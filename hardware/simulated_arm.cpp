#include "hardware/simulated_arm.h"

#include <algorithm>
#include <utility>

#include "core/exploration/arm_start.h"
#include "core/motion/body_image.h"

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
    : Arm(std::move(planner), std::move(start)), errors_(errors), random_(errors.seed) {
  errors.validate();
  const Eigen::Vector3d offset = randomDirection(random_) * errors.mount_error_m;
  const Eigen::Vector3d axis = randomDirection(random_);
  mount_error_ = makePose(offset, Eigen::Quaterniond(Eigen::AngleAxisd(errors.mount_error_rad, axis)));
  true_joints_ = Arm::start().front();
  readEncoders();
}

void SimulatedArm::readEncoders() {
  read_joints_ = true_joints_;
  std::normal_distribution<double> normal;
  for (Eigen::Index i = 0; i < read_joints_.size(); ++i) {
    const ArmJoint& joint = planner().model().joints[i];
    read_joints_[i] =
        std::clamp(read_joints_[i] + errors_.encoder_noise_rad * normal(random_), joint.lower, joint.upper);
  }
}

void SimulatedArm::follow(const JointTrajectory& trajectory, const RunControl& control) {
  for (const JointVector& q : trajectory.positions) {
    if (control.stop.stop_requested()) break;
    moveTo(q);
  }
  readEncoders();
  control.check();
}

std::unique_ptr<SimulatedArm> startedArm(const RobotModel& model, const Settings& settings) {
  auto planner = startingPlanner(model, settings);
  std::vector<JointVector> start = armStart(*planner, settings.exploration.scan);
  ArmErrors errors = settings.arm_errors;
  errors.seed = settings.exploration.seed;
  return std::make_unique<SimulatedArm>(std::move(planner), std::move(start), errors);
}

std::optional<DepthFrame> SimulatedHandCamera::look(const Pose&, std::uint64_t index) {
  std::optional<DepthFrame> frame = camera().capture(arm_.trueCameraPose(), index);
  if (!frame) return frame;
  drawOver(frame->depth,
           bodyImage(arm_.planner().model(), arm_.trueJoints(), model(), 0.0, arm_.mountError()),
           model().min_range_m);
  return frame;
}

}  // namespace vantage
