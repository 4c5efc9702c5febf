#include "hardware/live_arm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/exploration/arm_start.h"
#include "io/robot_file.h"
#include "io/scene_file.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;

/// What the software behind an arm does, and what it was asked.
struct Behind {
  JointVector joints;
  std::function<void()> on_poll = [] {};  ///< each time that the motion is asked for
  int polls_to_arrive = 5;
  bool fails = false;
  std::string reading_lost;

  int polls = 0, sent = 0, cancelled = 0;
  JointTrajectory last;
};

class FakeLink : public ArmLink {
 public:
  explicit FakeLink(Behind& behind) : behind_(behind) {}
  Reading read() const override {
    if (!behind_.reading_lost.empty()) throw DeviceLost(behind_.reading_lost);
    return {behind_.joints, ++readings_};
  }
  void send(const JointTrajectory& trajectory) override {
    behind_.last = trajectory;
    behind_.polls = 0;
    ++behind_.sent;
  }
  Motion motion() override {
    ++behind_.polls;
    behind_.on_poll();
    if (behind_.fails) return Motion::Failed;
    if (behind_.polls < behind_.polls_to_arrive) return Motion::Moving;
    behind_.joints = behind_.last.positions.back();
    return Motion::Arrived;
  }
  void cancel() override { ++behind_.cancelled; }
  std::string trouble() const override { return {}; }

 private:
  Behind& behind_;
  mutable std::uint64_t readings_ = 0;
};

Settings boxSettings() {
  Settings settings;
  applyScene(settings, loadScene("box"));
  settings.exploration.scan.initial_frames = 3;
  settings.exploration.volume = {{-1.5, -1.0, -0.05}, 0.04, {75, 50, 30}};  // nothing is fused
  return settings;
}

class LiveArmTest : public testing::Test {
 protected:
  LiveArmTest() {
    const RobotModel model = loadRobot("smart_six");
    behind.joints = armStartOf(model);
  }
  static JointVector armStartOf(const RobotModel& model);
  std::unique_ptr<LiveArm> arm(std::function<std::string()> watch = {}) {
    return liveArm(loadRobot("smart_six"), settings, std::make_unique<FakeLink>(behind), std::move(watch));
  }
  static MotionPlan sweep(const LiveArm& arm) {
    MotionPlan plan;
    plan.trajectory =
        std::make_shared<JointTrajectory>(arm.planner().timed({arm.state().joints, arm.start().back()}));
    return plan;
  }
  template <class Act>
  static std::string errorOf(const Act& act) {
    try {
      act();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  Settings settings = boxSettings();
  Behind behind;
};

JointVector LiveArmTest::armStartOf(const RobotModel& model) {
  const auto planner = startingPlanner(model, boxSettings());
  return armStart(*planner, boxSettings().exploration.scan)[1];
}

TEST_F(LiveArmTest, ScansAroundWhereItStandsAndGoesWhereItIsSent) {
  const auto live = arm();
  EXPECT_EQ(live->start()[1], behind.joints);
  const MotionPlan plan = sweep(*live);
  live->execute(plan, {});
  EXPECT_EQ(behind.sent, 1);
  EXPECT_EQ(behind.cancelled, 0);
  EXPECT_EQ(live->state().joints, plan.trajectory->positions.back());
}

TEST_F(LiveArmTest, AStopIsPassedOnAtTheNextLook) {
  const auto live = arm();
  std::stop_source stop;
  RunControl control;
  control.stop = stop.get_token();
  behind.polls_to_arrive = 1000;
  behind.on_poll = [&] {
    if (behind.polls == 3) stop.request_stop();
  };
  EXPECT_THROW(live->execute(sweep(*live), control), Cancelled);
  EXPECT_EQ(behind.polls, 3);
  EXPECT_EQ(behind.cancelled, 1);
}

TEST_F(LiveArmTest, AStopBeforeTheMotionSendsNothing) {
  const auto live = arm();
  std::stop_source stop;
  stop.request_stop();
  RunControl control;
  control.stop = stop.get_token();
  EXPECT_THROW(live->execute(sweep(*live), control), Cancelled);
  EXPECT_THROW(live->adjust(live->startPoses().back(), control), Cancelled);
  EXPECT_EQ(behind.sent, 0);
}

TEST_F(LiveArmTest, SendsNothingToGoWhereItIs) {
  const auto live = arm();
  live->adjust(live->state().T_world_camera, {});
  EXPECT_EQ(behind.sent, 0);
}

TEST_F(LiveArmTest, LostJointsCancelTheMotion) {
  const auto live = arm();
  behind.on_poll = [&] { behind.reading_lost = behind.polls == 2 ? "axis_3 is read as nan" : ""; };
  EXPECT_EQ(errorOf([&] { live->execute(sweep(*live), {}); }), "axis_3 is read as nan");
  EXPECT_EQ(behind.cancelled, 1);
}

TEST_F(LiveArmTest, ALostCameraCancelsTheMotion) {
  const auto live = arm([&] { return behind.sent > 0 && behind.polls >= 2 ? "the camera is gone" : ""; });
  EXPECT_EQ(errorOf([&] { live->execute(sweep(*live), {}); }), "the camera is gone");
  EXPECT_EQ(behind.cancelled, 1);
}

TEST_F(LiveArmTest, AMotionThatTheControllerGivesUpIsALoss) {
  const auto live = arm();
  behind.fails = true;
  EXPECT_EQ(errorOf([&] { live->execute(sweep(*live), {}); }),
            live->name() + ": the controller gave up the motion");
}

TEST_F(LiveArmTest, AMotionThatBeginsElsewhereOrLeavesTheLimitsIsNotSent) {
  const auto live = arm();
  MotionPlan plan = sweep(*live);
  behind.joints[0] += 0.1;
  EXPECT_THAT(errorOf([&] { live->execute(plan, {}); }), HasSubstr("away from where it begins"));
  behind.joints[0] -= 0.1;
  JointTrajectory fast = *plan.trajectory;
  for (double& t : fast.time_s) t *= 0.01;
  plan.trajectory = std::make_shared<JointTrajectory>(fast);
  EXPECT_THAT(errorOf([&] { live->execute(plan, {}); }), HasSubstr("the motion is not sent"));
  EXPECT_EQ(behind.sent, 0);
}

TEST_F(LiveArmTest, RefusesToBeginWhereItMustNot) {
  settings.arm.start_rad.assign(behind.joints.data(), behind.joints.data() + behind.joints.size());
  behind.joints[1] += 0.1;
  EXPECT_THAT(errorOf([&] { arm(); }), HasSubstr("5.7 deg away from arm.start_deg"));
  settings.arm.start_rad.clear();
  behind.joints << 0.0, 0.9, -1.5, 0.0, 0.5, 0.0;  // stretched out over the table, which nobody has seen
  EXPECT_THAT(errorOf([&] { arm(); }), HasSubstr("would touch"));
}

}  // namespace
}  // namespace vantage
