#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "core/motion/robot_model.h"

namespace vantage {
namespace {

const std::string kLimit = R"(<limit lower="-1" upper="2" velocity="3" effort="0"/>)";

std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& rest = kLimit, const std::string& type = "revolute") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" +
         child + "'/><origin xyz='0 0 1'/><axis xyz='0 1 0'/>" + rest + "</joint>";
}
std::string link(const std::string& name, const std::string& body = {}) {
  return "<link name='" + name + "'>" + body + "</link>";
}
std::string body(const std::string& geometry, const std::string& origin = {}) {
  return "<collision>" + origin + "<geometry>" + geometry + "</geometry></collision>";
}
std::string robot(const std::string& content) {
  return "<?xml version='1.0'?><robot name='test'>" + content + "</robot>";
}
/// One joint between the base and the camera.
std::string simple(const std::string& base_body, const std::string& joint_rest = kLimit,
                   const std::string& type = "revolute") {
  return robot(link("base", base_body) + link("camera_optical_frame") +
               joint("turn", "base", "camera_optical_frame", joint_rest, type));
}

/// The message with which a description is refused.
std::string refusal(const std::string& text, const std::string& camera = {}, const MeshBounds& meshes = {}) {
  try {
    parseUrdf(text, camera, meshes);
  } catch (const RobotModelError& error) {
    return error.what();
  }
  return "";
}

void expectRefusal(const std::string& text, const std::string& words) {
  EXPECT_NE(refusal(text).find(words), std::string::npos) << "said: " << refusal(text);
}

TEST(Urdf, ReadsJointsLimitsAndFixedParts) {
  const RobotModel arm =
      parseUrdf(robot(link("base") + link("a") + link("mount") + link("b") + link("camera_optical_frame") +
                      joint("turn", "base", "a") + joint("bolt", "a", "mount", "", "fixed") +
                      joint("slide", "mount", "b", kLimit, "prismatic") +
                      joint("glue", "b", "camera_optical_frame", "", "fixed")));
  EXPECT_EQ(arm.name, "test");
  ASSERT_EQ(arm.jointCount(), 2);
  EXPECT_EQ(arm.joints[0].name, "turn");
  EXPECT_FALSE(arm.joints[0].prismatic);
  EXPECT_TRUE(arm.joints[1].prismatic);
  EXPECT_EQ(arm.joints[0].lower, -1.0);
  EXPECT_EQ(arm.joints[0].upper, 2.0);
  EXPECT_EQ(arm.joints[0].max_velocity, 3.0);
  JointVector q(2);
  q << 0.0, 0.5;
  EXPECT_TRUE(cameraPose(arm, q).translation().isApprox(Eigen::Vector3d(0.0, 0.5, 4.0)));
  q[0] = 1.5707963267948966;  // about y: the fixed z offsets turn to x
  EXPECT_TRUE(cameraPose(arm, q).translation().isApprox(Eigen::Vector3d(3.0, 0.5, 1.0), 1e-12));
}

TEST(Urdf, ContinuousJointsHaveNoLimits) {
  const RobotModel arm = parseUrdf(simple("", "<limit velocity='1' effort='0'/>", "continuous"));
  EXPECT_TRUE(arm.joints[0].within(1e6));
}

TEST(Urdf, ShapesMoveWithTheirLink) {
  const RobotModel arm = parseUrdf(
      robot(link("base", body("<box size='1 2 3'/>")) +
            link("camera_optical_frame", body("<sphere radius='0.1'/>", "<origin xyz='0 0 0.5'/>")) +
            joint("turn", "base", "camera_optical_frame")));
  ASSERT_EQ(arm.shapes.size(), 2u);
  EXPECT_EQ(arm.shapes[0].frame, -1);
  EXPECT_EQ(arm.shapes[0].kind, ShapeKind::Cuboid);
  EXPECT_EQ(arm.shapes[0].size_m, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(arm.shapes[1].frame, 0);
  EXPECT_EQ(arm.shapes[1].kind, ShapeKind::Sphere);
  EXPECT_EQ(arm.shapes[1].T_frame_shape.translation(), Eigen::Vector3d(0, 0, 0.5));
}

TEST(Urdf, CylinderWithRoundEndsIsACapsule) {
  const std::string ends = body("<sphere radius='0.1'/>", "<origin xyz='0 0 0.3'/>") +
                           body("<sphere radius='0.1'/>", "<origin xyz='0 0 -0.3'/>");
  const std::string cylinder = body("<cylinder radius='0.1' length='0.6'/>");
  const RobotModel arm = parseUrdf(simple(ends + cylinder + body("<sphere radius='0.1'/>")));
  ASSERT_EQ(arm.shapes.size(), 2u);
  EXPECT_EQ(arm.shapes[0].kind, ShapeKind::Capsule);
  EXPECT_EQ(arm.shapes[0].length_m, 0.6);
  EXPECT_EQ(arm.shapes[1].kind, ShapeKind::Sphere);
  const RobotModel plain = parseUrdf(simple(cylinder + body("<sphere radius='0.1'/>")));
  ASSERT_EQ(plain.shapes.size(), 2u);
  EXPECT_EQ(plain.shapes[0].kind, ShapeKind::Cylinder);
}

TEST(Urdf, ADiscWithOneSphereIsNoCapsule) {
  const RobotModel arm =
      parseUrdf(simple(body("<cylinder radius='0.05' length='1e-7'/>") + body("<sphere radius='0.05'/>")));
  EXPECT_EQ(arm.shapes.size(), 2u);
}

TEST(Urdf, LengthsInMillimetresAreRefused) {
  expectRefusal(simple(body("<box size='300 20 20'/>")), "millimetres");
  expectRefusal(simple(body("<sphere radius='1'/>", "<origin xyz='1e12 0 0'/>")), "millimetres");
  expectRefusal(simple("", "<limit lower='-1e6' upper='1e6' velocity='1' effort='0'/>", "prismatic"),
                "travel");
  const std::string said = refusal(simple(body("<mesh filename='arm.stl'/>")), {}, [](const std::string&) {
    return Box(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(300, 100, 100));
  });
  EXPECT_NE(said.find("'arm.stl'"), std::string::npos) << said;
  EXPECT_NE(said.find("scale"), std::string::npos) << said;
}

TEST(Urdf, MeshBecomesItsBox) {
  const std::string mesh = body("<mesh filename='arm.stl' scale='2 2 2'/>");
  const RobotModel arm = parseUrdf(simple(mesh), {}, [](const std::string& file) {
    EXPECT_EQ(file, "arm.stl");
    return Box(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 2, 3));
  });
  ASSERT_EQ(arm.shapes.size(), 1u);
  EXPECT_EQ(arm.shapes[0].size_m, Eigen::Vector3d(2, 4, 6));
  EXPECT_EQ(arm.shapes[0].T_frame_shape.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(Urdf, JointsBesideTheChainRest) {
  const RobotModel arm = parseUrdf(
      robot(link("base") + link("camera_optical_frame") + link("finger", body("<sphere radius='1'/>")) +
            joint("turn", "base", "camera_optical_frame") +
            joint("grip", "camera_optical_frame", "finger",
                  "<limit lower='0.5' upper='1' velocity='1' effort='0'/>", "prismatic")));
  ASSERT_EQ(arm.jointCount(), 1);
  ASSERT_EQ(arm.shapes.size(), 1u);
  EXPECT_TRUE(arm.shapes[0].T_frame_shape.translation().isApprox(Eigen::Vector3d(0.0, 0.5, 1.0)));
}

TEST(Urdf, MissingMeshIsNamed) {
  const std::string text = simple(body("<mesh filename='package://arm/link.stl'/>"));
  EXPECT_NE(refusal(text).find("'package://arm/link.stl'"), std::string::npos);
  const std::string said =
      refusal(text, {}, [](const std::string&) -> Box { throw std::runtime_error("no such file"); });
  EXPECT_NE(said.find("no such file"), std::string::npos) << said;
  EXPECT_NE(said.find("link 'base'"), std::string::npos) << said;
}

TEST(Urdf, LoopsAreRefused) {
  expectRefusal(robot(link("base") + link("a") + link("camera_optical_frame") + joint("1", "base", "a") +
                      joint("2", "a", "camera_optical_frame") + joint("3", "base", "camera_optical_frame")),
                "loop");
  expectRefusal(robot(link("a") + link("camera_optical_frame") + joint("1", "a", "camera_optical_frame") +
                      joint("2", "camera_optical_frame", "a")),
                "no root link");
  expectRefusal(
      robot(link("base") + link("camera_optical_frame") + link("a") + link("b") +
            joint("0", "base", "camera_optical_frame") + joint("1", "a", "b") + joint("2", "b", "a")),
      "loop");
}

TEST(Urdf, SeveralRootsAreRefused) {
  expectRefusal(robot(link("base") + link("second") + link("camera_optical_frame") +
                      joint("turn", "base", "camera_optical_frame")),
                "root");
}

TEST(Urdf, LimitsMissingOrInsideOutAreRefused) {
  expectRefusal(simple("", ""), "limit");
  expectRefusal(simple("", "<limit lower='2' upper='-1' velocity='1' effort='0'/>"), "joint 'turn'");
  expectRefusal(simple("", "<limit lower='2' upper='2' velocity='1' effort='0'/>"), "below");
  expectRefusal(simple("", "<limit lower='-1' upper='2' velocity='0' effort='0'/>"), "velocity");
  expectRefusal(simple("", "", "continuous"), "joint 'turn' has no limits");
}

TEST(Urdf, OtherBadInputIsRefused) {
  EXPECT_NE(refusal(""), "");
  EXPECT_NE(refusal("<robot"), "");
  EXPECT_NE(refusal("no xml at all"), "");
  EXPECT_NE(refusal(robot("")), "");
  expectRefusal(robot(link("base")), "no link 'camera_optical_frame'");
  EXPECT_NE(refusal(simple(""), "eye").find("no link 'eye'"), std::string::npos);
  EXPECT_NE(refusal(simple(""), "base").find("no joint moves"), std::string::npos);
  expectRefusal(simple("", kLimit, "planar"), "joint 'turn'");
  EXPECT_NE(refusal(simple(body("<sphere radius='0'/>"))), "");
  EXPECT_NE(refusal(simple(body("<box size='1 -1 1'/>"))), "");
  EXPECT_NE(refusal(simple(body("<sphere radius='nan'/>"))), "");
}

TEST(Urdf, TooManyJointsAreRefused) {
  std::string text = link("l0");
  for (int i = 0; i <= kMaxArmJoints; ++i) {
    const std::string next = i == kMaxArmJoints ? "camera_optical_frame" : "l" + std::to_string(i + 1);
    text += link(next) + joint("j" + std::to_string(i), "l" + std::to_string(i), next);
  }
  expectRefusal(robot(text), "more than 12");
}

}  // namespace
}  // namespace vantage
