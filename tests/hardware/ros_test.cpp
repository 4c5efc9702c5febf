#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

#include "hardware/ros_bridge.h"
#include "hardware/wait_for.h"
#include "io/robot_file.h"
#include "io/run_file.h"
#include "io/scene_file.h"
#include "io/volume_file.h"
#include "tests/app/program.h"

namespace vantage::test {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;

/// A port on which nobody listens.
int freePort() {
  const int s = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (bind(s, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      getsockname(s, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw std::runtime_error("no port");
  close(s);
  return ntohs(address.sin_port);
}

/// A ROS master of this test's own, on loopback; this process and its children find it.
class Master : public testing::Environment {
 public:
  void SetUp() override {
    folder_ = std::make_unique<TemporaryFolder>();
    const std::string port = std::to_string(freePort());
    setenv("ROS_MASTER_URI", ("http://127.0.0.1:" + port).c_str(), 1);
    setenv("ROS_IP", "127.0.0.1", 1);
    setenv("ROS_HOME", folder_->path().c_str(), 1);
    EXPECT_THAT(rosDevices().note, HasSubstr("no ROS master answers at http://127.0.0.1:" + port));
    master_ = std::make_unique<BackgroundProcess>(std::vector<std::string>{ROS_MASTER, "--core", "-p", port});
    ASSERT_TRUE(waitFor(20.0, [] { return rosDevices().note.find("no ROS master") == std::string::npos; }));
  }
  void TearDown() override {
    master_.reset();
    folder_.reset();
  }

 private:
  std::unique_ptr<TemporaryFolder> folder_;
  std::unique_ptr<BackgroundProcess> master_;
};

const auto* const kMaster = testing::AddGlobalTestEnvironment(new Master);

/// The robot node in a namespace of its own.
struct Robot {
  explicit Robot(const std::string& fault = "")
      : space("/robot_" + std::to_string(++count)), node({ROS_ROBOT_NODE, "box", "smart_six", space, fault}) {
    EXPECT_TRUE(waitFor(20.0, [&] {
      const std::vector<DeviceEntry> devices = rosDevices().devices;
      return std::ranges::count_if(devices, [&](const DeviceEntry& d) {
               return d.name.starts_with("ros:" + space + "/");
             }) == 3;
    }));
  }
  std::string camera() const { return space + "/camera/image_raw"; }
  RosArmTopics arm() const { return {space + "/follow_joint_trajectory", space + "/joint_states"}; }

  static inline int count = 0;
  std::string space;
  BackgroundProcess node;
};

Settings boxSettings() {
  Settings settings;
  applyScene(settings, loadScene("box"));
  settings.arm.timing.speed_share = 1.0;
  settings.exploration.scan.initial_frames = 5;
  return settings;
}

std::unique_ptr<LiveArm> liveArmOf(const Robot& robot, std::function<std::string()> watch = {}) {
  const RobotModel model = loadRobot("smart_six");
  return liveArm(model, boxSettings(), rosArmLink(model, robot.arm()), std::move(watch));
}

/// A way there and back along the initial scan's arc.
MotionPlan sweep(const LiveArm& arm) {
  MotionPlan plan;
  plan.verdict = Reachability::Reachable;
  plan.trajectory = std::make_shared<JointTrajectory>(
      arm.planner().timed({arm.state().joints, arm.start().front(), arm.start().back()}));
  return plan;
}

template <class Act>
std::string refusalOf(const Act& act) {
  try {
    act();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(Ros, ListsWhatTheMasterKnows) {
  const Robot robot;
  const DeviceKind kind = rosDevices();
  EXPECT_TRUE(kind.built);
  EXPECT_THAT(kind.devices, Contains(Field(&DeviceEntry::name, "ros:" + robot.camera())));
  EXPECT_THAT(kind.devices, Contains(Field(&DeviceEntry::name, "ros:" + robot.arm().controller)));
  EXPECT_THAT(kind.devices, Contains(Field(&DeviceEntry::name, "ros:" + robot.arm().joint_states)));
}

TEST(Ros, TheCameraDeliversWhatTheHandSees) {
  const Robot robot;
  const auto camera = openRosCamera(robot.camera(), {0.5, 8.0});
  EXPECT_EQ(camera->model().width, 256);
  EXPECT_EQ(camera->model().fx, 182.5);
  const Pose pose = makePose({1, 2, 3}, Eigen::Quaterniond::Identity());
  const auto frame = camera->capture(pose, 0);
  ASSERT_TRUE(frame);
  EXPECT_TRUE(frame->T_world_camera.isApprox(pose));
  EXPECT_NEAR(frame->depth.at(128, 106), 0.95, 0.25) << "the box is about a metre away";
  EXPECT_EQ(camera->trouble(), "");
}

TEST(Ros, TheArmGoesWhereItIsSent) {
  const Robot robot;
  const auto arm = liveArmOf(robot);
  const JointVector before = arm->state().joints;
  EXPECT_NEAR(before[0], arm->start()[2][0], 1e-6) << "the scan's arc is around where it stands";
  const MotionPlan plan = sweep(*arm);
  const double duration_s = arm->execute(plan, {});
  EXPECT_EQ(duration_s, plan.trajectory->duration_s());
  EXPECT_LT((arm->state().joints - arm->start().back()).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Ros, AStopEndsTheMotionAtOnce) {
  const Robot robot;
  const auto arm = liveArmOf(robot);
  std::stop_source stop;
  RunControl control;
  control.stop = stop.get_token();
  const MotionPlan plan = sweep(*arm);
  ASSERT_GT(plan.trajectory->duration_s(), 0.6);
  const std::jthread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    stop.request_stop();
  });
  EXPECT_THROW(arm->execute(plan, control), Cancelled);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const JointVector stood = arm->state().joints;
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(arm->state().joints, stood) << "it moves on";
  EXPECT_GT((stood - plan.trajectory->positions.back()).cwiseAbs().maxCoeff(), 1e-3) << "it went to the end";
}

TEST(Ros, ALostCameraStopsTheArm) {
  const Robot robot;
  bool lost = false;
  const auto arm = liveArmOf(robot, [&] { return lost ? "camera: unplugged" : ""; });
  const MotionPlan plan = sweep(*arm);
  const std::jthread unplug([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    lost = true;
  });
  EXPECT_EQ(refusalOf([&] { arm->execute(plan, {}); }), "camera: unplugged");
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const JointVector stood = arm->state().joints;
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(arm->state().joints, stood) << "it moves on";
}

TEST(Ros, SaysWhatIsMissingWhenItOpens) {
  const Robot robot;
  const RobotModel model = loadRobot("smart_six"), other = loadRobot("ur5");
  EXPECT_THAT(refusalOf([&] {
                openRosCamera("/nobody/image_raw", {0.5, 8.0});
              }),
              HasSubstr("no calibration came on /nobody/camera_info"));
  EXPECT_THAT(refusalOf([&] {
                openRosCamera("no topic at all", {0.5, 8.0});
              }),
              HasSubstr("ros:no topic at all"));
  EXPECT_THAT(refusalOf([&] {
                rosArmLink(model, {"/nobody", "/joint_states"});
              }),
              HasSubstr("no controller answers"));
  EXPECT_THAT(refusalOf([&] { rosArmLink(other, robot.arm()); }),
              HasSubstr("no position came of shoulder_pan_joint"));
}

TEST(Ros, ImagesThatAreNoDepthAreRefused) {
  const Robot robot("bgr");
  EXPECT_THAT(refusalOf([&] {
                openRosCamera(robot.camera(), {0.5, 8.0}, 0.5);
              }),
              HasSubstr("'bgr8', which is no depth"));
}

TEST(Ros, ACameraWithoutImagesIsRefused) {
  const Robot robot("no_images");
  EXPECT_THAT(refusalOf([&] {
                openRosCamera(robot.camera(), {0.5, 8.0}, 0.5);
              }),
              HasSubstr("ros:" + robot.space));
}

/// `vantage explore` with the robot, as a person calls it.
struct LiveSession {
  explicit LiveSession(const Robot& robot, std::vector<std::string> more = {}) {
    writeFile(folder / "box.toml", vantage({"config", "box"}).out);
    std::vector<std::string> words = {"explore",
                                      "ros:" + robot.camera(),
                                      "--robot",
                                      "smart_six",
                                      "--controller",
                                      "ros:" + robot.arm().controller,
                                      "--joint-states",
                                      robot.arm().joint_states,
                                      "--config",
                                      folder / "box.toml",
                                      "--set",
                                      "arm.speed_share=1",
                                      "--set",
                                      "scan.initial_frames=5",
                                      "--set",
                                      "scan.frames=3",
                                      "--steps",
                                      "2",
                                      "-o",
                                      folder / "live.vantage"};
    words.insert(words.end(), more.begin(), more.end());
    result = vantage(words);
  }
  TemporaryFolder folder;
  ProcessResult result;
};

TEST(RosSession, IsRecordedAndReplaysToTheSameMap) {
  const Robot robot;
  const LiveSession session(robot);
  ASSERT_EQ(session.result.code, 0) << session.result.err;
  const RunReader run(session.folder / "live.vantage");
  EXPECT_EQ(run.steps(), (std::vector<int>{1, 2}));
  const StepRecord first = run.step(1);
  ASSERT_TRUE(first.joints);
  EXPECT_EQ(first.joints->size(), 5u);
  EXPECT_GT(((*first.joints)[4] - (*first.joints)[0]).cwiseAbs().maxCoeff(), 0.4)
      << "the arc of the first joint";
  ASSERT_TRUE(first.trajectory);
  EXPECT_LT((first.trajectory->positions.back() - run.step(2).joints->front()).cwiseAbs().maxCoeff(), 0.2)
      << "step 2 looks from where step 1 went, tilted";

  const std::string frames = session.folder / "live-frames";
  const ProcessResult fused =
      vantage({"fuse", frames, "--config", frames + "/config.toml", "-o", session.folder / "again.vti"});
  ASSERT_EQ(fused.code, 0) << fused.err;
  TsdfVolume live(run.header().volume);
  run.moveVolume(live, 0, run.closingStep());
  std::vector<std::string> warnings;
  const TsdfVolume again = readVolume(session.folder / "again.vti", warnings);
  EXPECT_TRUE(std::ranges::equal(again.voxels(), live.voxels()));
}

#ifdef OPENNI_FOLDER
TEST(RosSession, ACameraOfOpenNiSitsInTheSameHand) {
  const Robot robot;
  const TemporaryFolder folder;
  ProcessOptions options;
  options.environment["LD_LIBRARY_PATH"] = OPENNI_FOLDER;
  writeFile(folder / "box.toml", vantage({"config", "box"}).out);
  const ProcessResult result = vantage(
      {"explore", "openni2:test://depth", "--robot", "smart_six", "--controller",
       "ros:" + robot.arm().controller, "--joint-states", robot.arm().joint_states, "--steps", "0",
       "--config", folder / "box.toml", "--set", "scan.initial_frames=3", "-o", folder / "live.vantage"},
      options);
  ASSERT_EQ(result.code, 0) << result.err;
  const RunReader run(folder / "live.vantage");
  EXPECT_EQ(run.header().camera.width, 320);
  EXPECT_EQ(run.closing().scan.size(), 3u);
  EXPECT_TRUE(std::filesystem::exists(folder / "live-frames/frame-000002.depth.png"));
}
#endif

/// What is lost, and what the program says about it.
struct Loss {
  const char* fault;
  const char* says;
};

class RosLoss : public testing::TestWithParam<Loss> {};

TEST_P(RosLoss, StopsTheArmKeepsTheRunAndSaysWhatWasLost) {
  const Robot robot(GetParam().fault);
  const LiveSession session(robot);
  expectRefused(session.result, {GetParam().says, "1 finished step kept in"}, 1);
  const RunReader run(session.folder / "live.vantage");
  EXPECT_EQ(run.stopReason(), "device lost");
  EXPECT_EQ(run.steps(), std::vector<int>{1});
}

INSTANTIATE_TEST_SUITE_P(
    Ros, RosLoss,
    testing::Values(Loss{"silent_camera", "no image for"},
                    Loss{"frozen_camera", "time stamps of its images stand still"},
                    Loss{"other_size", "its images are 128x106 now, and were 256x212"},
                    Loss{"silent_joints", "its joints were not read for"},
                    Loss{"frozen_joints", "time stamps of its joints stand still"},
                    Loss{"nan_joints", "axis_2 is read as nan"},
                    Loss{"abort", "gave up the motion: ABORTED, error code -4, axis_2 lags behind"},
                    Loss{"die", "the controller is gone"}),
    [](const auto& loss) { return std::string(loss.param.fault); });

}  // namespace
}  // namespace vantage::test
