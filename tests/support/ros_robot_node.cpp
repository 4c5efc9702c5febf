// A robot for tests: an arm before a scene, with a depth camera in its hand, as a node of ROS that moves in
// real time.
//   ros_robot_node SCENE ROBOT SPACE [FAULT]
// What a fault does begins in the motion after the one to the first view, when a step is finished:
//   silent_camera  no image any more       frozen_camera  stamps stand still      other_size   smaller images
//   silent_joints  no joints any more      nan_joints     one joint is NaN        frozen_joints stamps stand
//   still abort          gives up the motion     die            the node is gone
// From the beginning on: no_images, no_joints, bgr (images that are no depth).

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "hardware/simulated_arm.h"
#include "hardware/simulated_depth_camera.h"
#include "io/robot_file.h"
#include "io/scene_file.h"
#include "tests/support/ros_server.h"

namespace vantage::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kTick_s = 0.01;
constexpr int kTicksPerImage = 4;
constexpr int kInitialFrames = 5;  // as the tests set it, each reached by a motion

class MovedArm : public SimulatedArm {
 public:
  using SimulatedArm::moveTo;
  using SimulatedArm::SimulatedArm;
};

class HandCamera : public SimulatedHandCamera {
 public:
  using SimulatedHandCamera::look;
  using SimulatedHandCamera::SimulatedHandCamera;
};

/// Where a motion is at a time; the last point behind its end.
JointVector at(const RosServer::Goal& goal, double time_s) {
  std::size_t next = 0;
  while (next < goal.time_s.size() && goal.time_s[next] <= time_s) ++next;
  const auto row = [&](std::size_t p) {
    return Eigen::Map<const Eigen::VectorXd>(goal.positions[p].data(),
                                             static_cast<Eigen::Index>(goal.positions[p].size()));
  };
  if (next == goal.time_s.size()) return row(next - 1);
  if (next == 0) return row(0);
  const double share = (time_s - goal.time_s[next - 1]) / (goal.time_s[next] - goal.time_s[next - 1]);
  return row(next - 1) + share * (row(next) - row(next - 1));
}

class RobotNode {
 public:
  RobotNode(const std::string& scene_name, const std::string& robot, const std::string& space,
            std::string fault)
      : fault_(std::move(fault)), scene_(loadScene(scene_name)), server_(space) {
    applyScene(settings_, scene_);
    const RobotModel model = loadRobot(robot);
    for (const ArmJoint& joint : model.joints) names_.push_back(joint.name);
    const std::vector<JointVector> start = startedArm(model, settings_)->start();
    arm_ =
        std::make_unique<MovedArm>(startingPlanner(model, settings_), std::vector{start[start.size() / 2]});
    camera_ = std::make_unique<SimulatedDepthCamera>(
        scene_, SimulatedCameraConfig{settings_.camera, settings_.sensor, settings_.exploration.seed});
    hand_ = std::make_unique<HandCamera>(*camera_, *arm_);
  }

  void run() {
    auto next = Clock::now();
    for (long tick = 0; server_.ok(); ++tick) {
      server_.spinOnce();
      move();
      if (faulty("die")) std::_Exit(3);
      publishJoints();
      if (tick % kTicksPerImage == 0) publishImage();
      next += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(kTick_s));
      std::this_thread::sleep_until(next);
    }
  }

 private:
  double now_s() const { return std::chrono::duration<double>(Clock::now() - began_).count() + 1000.0; }
  bool from(const char* fault) const { return fault_ == fault; }
  bool faulty(const char* fault) const { return fault_ == fault && faulty_; }

  void move() {
    if (auto goal = server_.newGoal()) {
      goal_ = std::move(goal);
      goal_began_s_ = now_s();
      ++motions_;
    }
    if (!goal_) return;
    const double time_s = now_s() - goal_began_s_;
    if (motions_ > kInitialFrames + 1 && time_s > 0.05) faulty_ = true;
    if (server_.stopWanted()) {
      goal_.reset();
      return server_.stopped();
    }
    if (faulty("abort")) {
      goal_.reset();
      return server_.abort("axis_2 lags behind");
    }
    arm_->moveTo(at(*goal_, time_s));
    if (time_s < goal_->time_s.back()) return;
    goal_.reset();
    server_.succeed();
  }

  void publishJoints() {
    if (from("no_joints") || faulty("silent_joints")) return;
    const JointVector& q = arm_->trueJoints();
    std::vector<double> positions(q.data(), q.data() + q.size());
    if (faulty("nan_joints")) positions[1] = std::nan("");
    if (!faulty("frozen_joints")) joints_stamp_s_ = now_s();
    server_.publishJoints(joints_stamp_s_, names_, positions);
  }

  void publishImage() {
    if (from("no_images") || faulty("silent_camera")) return;
    DepthImage depth = hand_->look(arm_->trueCameraPose(), images_++)->depth;
    if (!faulty("frozen_camera")) image_stamp_s_ = now_s();
    if (faulty("other_size")) depth = DepthImage(depth.width / 2, depth.height / 2);
    server_.publishDepth(image_stamp_s_, depth, settings_.camera, from("bgr") ? "bgr8" : "16UC1");
  }

  const std::string fault_;
  const Clock::time_point began_ = Clock::now();
  SceneFile scene_;
  Settings settings_;
  RosServer server_;
  std::vector<std::string> names_;
  std::unique_ptr<MovedArm> arm_;
  std::unique_ptr<SimulatedDepthCamera> camera_;
  std::unique_ptr<HandCamera> hand_;
  std::optional<RosServer::Goal> goal_;
  double goal_began_s_ = 0.0, joints_stamp_s_ = 0.0, image_stamp_s_ = 0.0;
  int motions_ = 0;
  bool faulty_ = false;
  std::uint64_t images_ = 0;
};

}  // namespace
}  // namespace vantage::test

int main(int count, char** words) {
  if (count < 4) {
    std::fprintf(stderr, "usage: ros_robot_node SCENE ROBOT SPACE [FAULT]\n");
    return 2;
  }
  vantage::test::RobotNode(words[1], words[2], words[3], count > 4 ? words[4] : "").run();
  return 0;
}
