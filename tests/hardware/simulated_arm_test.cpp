#include "hardware/simulated_arm.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/exploration/arm_start.h"
#include "hardware/simulated_depth_camera.h"
#include "io/robot_file.h"
#include "io/scene_file.h"
#include "tests/support/simulated_run.h"

namespace vantage {
namespace {

using testing::exploreWith;
using testing::sceneSettings;
using testing::SimulatedRun;

/// Arm whose first joint ends up beside where it is sent, from the n-th motion between views on.
class ShiftedArm : public SimulatedArm {
 public:
  ShiftedArm(std::unique_ptr<ArmPlanner> planner, std::vector<JointVector> start, double shift_rad)
      : SimulatedArm(std::move(planner), std::move(start)), shift_rad_(shift_rad) {}
  double execute(const MotionPlan& plan, const RunControl& control) override {
    executing_ = true;
    const double duration_s = SimulatedArm::execute(plan, control);
    executing_ = false;
    return duration_s;
  }

 protected:
  void moveTo(const JointVector& q) override {
    JointVector shifted = q;
    if (executing_) shifted[0] += shift_rad_;
    SimulatedArm::moveTo(shifted);
  }

 private:
  double shift_rad_;
  bool executing_ = false;
};

Settings quickSettings(const std::vector<std::string>& more = {}) {
  std::vector<std::string> assignments = {"volume.voxel_size_m=0.02",
                                          "volume.size=[150,100,58]",
                                          "exploration.steps=2",
                                          "fusion.truncation_m=0.05",
                                          "scan.frames=6",
                                          "scan.initial_frames=8"};
  assignments.insert(assignments.end(), more.begin(), more.end());
  return sceneSettings("tabletop", assignments);
}

SimulatedRun exploreByArm(const Settings& settings, SimulatedArm& arm, int threads = 2) {
  SimulatedDepthCamera camera(loadScene("tabletop"),
                              {settings.camera, settings.sensor, settings.exploration.seed});
  SimulatedHandCamera eye(camera, arm);
  return exploreWith("tabletop", settings, eye, arm, threads);
}

template <class Arm = SimulatedArm, class... Rest>
Arm makeArm(const Settings& settings, Rest... rest) {
  auto planner = startingPlanner(loadRobot("smart_six"), settings);
  auto start = armStart(*planner, settings.exploration.scan);
  return Arm(std::move(planner), std::move(start), rest...);
}

TEST(SimulatedArm, ExploresAndLooksFromWhereItsJointsAre) {
  const Settings settings = quickSettings();
  auto arm = makeArm(settings);
  const SimulatedRun run = exploreByArm(settings, arm);
  ASSERT_EQ(run.steps.size(), 2u);
  for (const StepRecord& step : run.steps) {
    ASSERT_TRUE(step.joints && step.trajectory && step.hasView());
    ASSERT_EQ(step.joints->size(), step.scan.size());
    for (std::size_t f = 0; f < step.scan.size(); ++f)
      EXPECT_TRUE(
          isNear(arm.planner().cameraPose((*step.joints)[f]), step.scan[f].T_world_camera, 1e-9, 1e-9));
    EXPECT_LT((step.trajectory->positions.front() - step.joints->back()).norm(), 1e-12);
    EXPECT_TRUE(isNear(arm.planner().cameraPose(step.trajectory->positions.back()),
                       step.chosen()->T_world_camera, 1e-6, 1e-6));
    EXPECT_NEAR(*step.timings.motion, step.trajectory->duration_s(), 1e-12);
  }
  // The second scan begins at the first view; some of its frames are tilted about the image's x axis.
  EXPECT_TRUE(
      isNear(run.steps[1].scan.front().T_world_camera, run.steps[0].chosen()->T_world_camera, 1e-6, 1e-6));
  EXPECT_TRUE(std::ranges::any_of(run.steps[1].scan, [&](const ScanPose& pose) {
    return angleBetween(pose.T_world_camera, run.steps[0].chosen()->T_world_camera) > 0.03;
  }));
  EXPECT_GT(run.steps[0].metrics.unknown_voxels, run.closing.metrics.unknown_voxels);
}

TEST(SimulatedArm, TheExecutedMotionDecidesTheNextImage) {
  const Settings settings = quickSettings();
  auto straight = makeArm(settings);
  auto shifted = makeArm<ShiftedArm>(settings, 0.05);
  const SimulatedRun a = exploreByArm(settings, straight), b = exploreByArm(settings, shifted);
  ASSERT_TRUE(a.steps.size() == 2 && b.steps.size() >= 1);
  // The same decision, another place, and so another image and another map.
  EXPECT_TRUE(a.steps[0].chosen()->T_world_camera.isApprox(b.steps[0].chosen()->T_world_camera));
  const ScanPose& there = a.steps[1].scan.front();
  const StepRecord& after = b.steps.size() > 1 ? b.steps[1] : b.closing;
  EXPECT_GT((there.T_world_camera.translation() - after.scan.front().T_world_camera.translation()).norm(),
            0.01);
  EXPECT_NE(a.steps[1].metrics.unknown_voxels, after.metrics.unknown_voxels);
}

TEST(SimulatedArm, RunsAreTheSameForAnyNumberOfThreads) {
  const Settings settings = quickSettings({"arm.encoder_noise_deg=0.05"});
  auto first = makeArm(settings, settings.arm_errors), second = makeArm(settings, settings.arm_errors);
  const SimulatedRun a = exploreByArm(settings, first, 1), b = exploreByArm(settings, second, 2);
  ASSERT_EQ(a.steps.size(), b.steps.size());
  for (std::size_t s = 0; s < a.steps.size(); ++s) {
    EXPECT_EQ(*a.steps[s].joints, *b.steps[s].joints);
    EXPECT_EQ(a.steps[s].metrics.unknown_voxels, b.steps[s].metrics.unknown_voxels);
  }
}

TEST(SimulatedArm, ErrorsPartTheBelievedPoseFromTheTrueOne) {
  const Settings settings = quickSettings();
  const auto perfect = makeArm(settings);
  EXPECT_TRUE(perfect.trueCameraPose().isApprox(perfect.state().T_world_camera, 1e-12));
  const auto crooked = makeArm(settings, ArmErrors{.mount_error_m = 0.01, .mount_error_rad = 0.02});
  const Pose believed = crooked.state().T_world_camera, real = crooked.trueCameraPose();
  EXPECT_NEAR((believed.translation() - real.translation()).norm(), 0.01, 1e-9);
  EXPECT_NEAR(angleBetween(believed, real), 0.02, 1e-9);
  const auto noisy = makeArm(settings, ArmErrors{.encoder_noise_rad = 0.01});
  EXPECT_GT((noisy.state().joints - noisy.trueJoints()).norm(), 1e-4);
  EXPECT_LT((noisy.state().joints - noisy.trueJoints()).norm(), 0.1);
}

TEST(SimulatedArm, StopsWithinOneControlPeriod) {
  const Settings settings = quickSettings();
  std::stop_source stop;
  struct Stopped : SimulatedArm {
    Stopped(std::unique_ptr<ArmPlanner> planner, std::vector<JointVector> start, std::stop_source* source)
        : SimulatedArm(std::move(planner), std::move(start)), stop_source(source) {}
    void moveTo(const JointVector& q) override {
      SimulatedArm::moveTo(q);
      if (++points == 10) stop_source->request_stop();
    }
    std::stop_source* stop_source;
    int points = 0;
  };
  auto arm = makeArm<Stopped>(settings, &stop);
  const JointVector from = arm.state().joints;
  JointVector to = from;
  to[0] += 0.2;
  MotionPlan plan;
  plan.trajectory = std::make_shared<JointTrajectory>(arm.planner().timed({from, to}));
  RunControl control;
  control.stop = stop.get_token();
  EXPECT_THROW(arm.execute(plan, control), Cancelled);
  EXPECT_EQ(arm.points, 10);
  EXPECT_EQ(arm.trueJoints(), plan.trajectory->positions[9]);
}

TEST(SimulatedArm, RefusesAPlanWithoutATrajectory) {
  const Settings settings = quickSettings();
  auto arm = makeArm(settings);
  EXPECT_THROW(arm.execute(MotionPlan(), {}), ArmRefusal);
}

TEST(ArmStart, IsGoneRoundWithoutAContactAndSeesTheScene) {
  const Settings settings = quickSettings();
  for (const char* name : {"smart_six", "ur5"}) {
    const auto planner = startingPlanner(loadRobot(name), settings);
    const std::vector<JointVector> arc = armStart(*planner, settings.exploration.scan);
    ASSERT_EQ(arc.size(), 8u);
    EXPECT_NEAR(arc.back()[0] - arc.front()[0], settings.arm.start_arc_rad, 1e-9);
    for (const JointVector& q : arc) {
      EXPECT_TRUE(planner->contact(q).free());
      const Eigen::Vector3d center =
          planner->cameraPose(q).inverse() * settings.exploration.scan.scene_center_m;
      EXPECT_GT(center.z(), 0.5);
      const Eigen::Vector2d pixel = settings.camera.project(center);
      EXPECT_TRUE(pixel.x() > 0 && pixel.x() < settings.camera.width) << name << pixel.transpose();
    }
  }
}

TEST(ArmStart, SaysWhatIsInTheWay) {
  const auto reason = [](const std::vector<std::string>& assignments) -> std::string {
    const Settings settings = quickSettings(assignments);
    try {
      armStart(*startingPlanner(loadRobot("smart_six"), settings), settings.exploration.scan);
    } catch (const ArmRefusal& refusal) {
      return refusal.what();
    }
    return "";
  };
  EXPECT_NE(reason({"arm.start_deg=[0,60,-90,0,90,0]"}).find("would touch occupied or unknown space"),
            std::string::npos);
  EXPECT_NE(reason({"arm.start_deg=[0,60]"}).find("has 2 values, the arm has 6 joints"), std::string::npos);
  EXPECT_NE(reason({"arm.start_deg=[0,300,-90,0,90,0]"}).find("limits"), std::string::npos);
  EXPECT_NE(reason({"arm.clear_boxes_m=[]"}).find("arm.clear_boxes_m"), std::string::npos);
}

}  // namespace
}  // namespace vantage
