// Forward kinematics against KDL, in a program of its own: KDL and OMPL carry different builds of the same
// Eigen templates, and whichever is loaded first serves both.
#include <gtest/gtest.h>

#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <random>

#include "core/motion/robot_model.h"
#include "io/robot_file.h"

namespace vantage {
namespace {

KDL::Vector toKdl(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

KDL::Frame toKdl(const Pose& pose) {
  const Eigen::Matrix3d r = pose.linear();
  return {KDL::Rotation(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)),
          toKdl(pose.translation())};
}

KDL::Chain chainOf(const RobotModel& model) {
  KDL::Chain chain;
  for (const ArmJoint& joint : model.joints) {
    const auto type = joint.prismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::Fixed), toKdl(joint.T_parent_joint)));
    chain.addSegment(KDL::Segment(KDL::Joint(joint.name, KDL::Vector::Zero(), toKdl(joint.axis), type)));
  }
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::Fixed), toKdl(model.T_tip_camera)));
  return chain;
}

TEST(ForwardKinematics, AgreesWithKdlOnRandomConfigurations) {
  for (const char* name : {"smart_six", "ur5"}) {
    const RobotModel arm = loadRobot(name);
    const KDL::Chain chain = chainOf(arm);
    KDL::ChainFkSolverPos_recursive kdl(chain);
    std::mt19937_64 random(13);
    for (int n = 0; n < 1000; ++n) {
      JointVector q(6);
      KDL::JntArray kdl_q(6);
      for (int i = 0; i < 6; ++i)
        kdl_q(i) = q[i] = -3.0 + 6.0 * static_cast<double>(random() >> 11) * 0x1p-53;
      KDL::Frame frame;
      ASSERT_GE(kdl.JntToCart(kdl_q, frame), 0);
      const Pose pose = cameraPose(arm, q);
      EXPECT_EQ(pose.matrix(), forwardKinematics(arm, q).T_base_camera.matrix());
      for (int row = 0; row < 3; ++row) {
        EXPECT_NEAR(pose.translation()[row], frame.p[row], 1e-12);
        for (int column = 0; column < 3; ++column)
          EXPECT_NEAR(pose.linear()(row, column), frame.M(row, column), 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace vantage
