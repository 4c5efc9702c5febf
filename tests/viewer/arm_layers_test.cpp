// Layers of a run with an arm.
#include <gmock/gmock.h>

#include "core/motion/arm_planner.h"
#include "io/robot_file.h"
#include "tests/support/synthetic_record.h"
#include "viewer/layers/layer.h"
#include "viewer/layers/layer_inputs.h"

namespace vantage {
namespace {

using test::SyntheticRun;
using ::testing::HasSubstr;

constexpr Layer kLayers[] = {Layer::Arm, Layer::ArmMotion, Layer::ClearBoxes};

JointVector six(double first) {
  JointVector q(6);
  q << first, -0.3, -1.9, 0.0, 0.9, 0.0;
  return q;
}

/// The synthetic run as if an arm had carried its camera.
SyntheticRun runWithArm() {
  SyntheticRun run = test::makeSyntheticRun();
  const ArmPlace place = ArmConfig().place();
  run.header.arm = ArmHeader{loadRobot("smart_six"), place.T_world_base, place.clear_boxes};
  run.record.joints = std::make_shared<std::vector<JointVector>>(run.record.scan.size(), six(0.2));
  run.record.trajectory = std::make_shared<JointTrajectory>(
      timedTrajectory(run.header.arm->model, {six(0.2), six(-0.5)}, MotionTiming()));
  return run;
}

TEST(ArmLayers, ShowTheArmItsMotionAndTheSpaceVouchedFor) {
  const SyntheticRun run = runWithArm();
  for (const Layer layer : kLayers) {
    const LayerContent content = buildLayer(layer, run.frame(), {});
    EXPECT_FALSE(content.props.empty()) << layerName(layer);
    ASSERT_FALSE(content.legend.empty()) << layerName(layer);
  }
  const LayerContent arm = buildLayer(Layer::Arm, run.frame(), {});
  EXPECT_THAT(arm.legend[0].text, HasSubstr("11\u00b0  -17\u00b0  -109\u00b0"));  // 0.2, -0.3, -1.9 rad
  // The box of what must be seen holds the base and the camera.
  Box seen;
  for (const Eigen::Vector3d& p : arm.must_see) seen.extend(p);
  EXPECT_TRUE(seen.contains(run.header.arm->T_world_base.translation() + Eigen::Vector3d(0, 0, 0.1)));
  EXPECT_TRUE(seen.exteriorDistance(run.header.arm->T_world_base *
                                    cameraPose(run.header.arm->model, six(0.2)).translation()) < 0.05);
  EXPECT_THAT(buildLayer(Layer::ArmMotion, run.frame(), {}).legend[1].text, HasSubstr("on its way there"));
}

TEST(ArmLayers, AreEmptyWithoutAnArm) {
  const SyntheticRun run = test::makeSyntheticRun();
  for (const Layer layer : kLayers) EXPECT_TRUE(buildLayer(layer, run.frame(), {}).props.empty());
}

TEST(ArmLayers, DoNotTrustJointsOfAnotherArm) {
  SyntheticRun run = runWithArm();
  run.record.joints =
      std::make_shared<std::vector<JointVector>>(run.record.scan.size(), JointVector::Zero(4));
  EXPECT_TRUE(buildLayer(Layer::Arm, run.frame(), {}).props.empty());
}

TEST(ArmLayers, AreBuiltAgainWhenTheArmMoved) {
  const SyntheticRun run = runWithArm();
  SyntheticRun later = run;
  later.record.joints = std::make_shared<std::vector<JointVector>>(run.record.scan.size(), six(0.3));
  const LayerInputs before(run.frame()), after(later.frame());
  EXPECT_TRUE(stillStands(Layer::Arm, before, LayerInputs(run.frame())));
  EXPECT_FALSE(stillStands(Layer::Arm, before, after));
  EXPECT_TRUE(stillStands(Layer::Surface, before, after));
}

}  // namespace
}  // namespace vantage
