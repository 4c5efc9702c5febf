#include "io/robot_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/motion/inverse_kinematics.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class RobotFile : public testing::Test {
 protected:
  RobotFile() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("robot_file_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "arm_description" / "meshes");
  }
  ~RobotFile() override { fs::remove_all(folder_); }

  /// An arm of one joint whose base has a mesh.
  fs::path arm(const std::string& mesh) const {
    const fs::path path = folder_ / "arm_description" / "arm.urdf";
    std::ofstream(path) << "<robot name='arm'><link name='base'><collision><geometry><mesh filename='" << mesh
                        << "'/></geometry></collision></link><link name='camera_optical_frame'/>"
                           "<joint name='turn' type='revolute'><parent link='base'/>"
                           "<child link='camera_optical_frame'/><axis xyz='0 0 1'/>"
                           "<limit lower='-1' upper='1' velocity='1' effort='0'/></joint></robot>";
    std::ofstream(path.parent_path() / "meshes" / "base.obj")
        << "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 2 3\nf 1 2 4\n";
    return path;
  }
  std::string refusal(const std::string& name, const std::string& camera = {}) const {
    try {
      loadRobot(name, camera);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
};

TEST_F(RobotFile, EveryEmbeddedRobotLoadsAndHasADescription) {
  const auto robots = embeddedRobots();
  ASSERT_GE(robots.size(), 2u);
  for (const EmbeddedRobot& robot : robots) {
    EXPECT_FALSE(robot.description.empty()) << robot.name;
    const RobotModel model = loadRobot(robot.name);
    EXPECT_EQ(model.name, robot.name);
    EXPECT_EQ(model.jointCount(), 6);
    EXPECT_GE(model.shapes.size(), 7u);
  }
}

TEST_F(RobotFile, MeshesAreFoundBesideAndInPackages) {
  for (const std::string& mesh :
       {std::string("meshes/base.obj"), std::string("package://arm_description/meshes/base.obj"),
        "file://" + (folder_ / "arm_description/meshes/base.obj").string()}) {
    const RobotModel model = loadRobot(arm(mesh).string());
    ASSERT_EQ(model.shapes.size(), 1u) << mesh;
    EXPECT_TRUE(model.shapes[0].size_m.isApprox(Eigen::Vector3d(1, 2, 3))) << mesh;
  }
}

TEST_F(RobotFile, SaysWhatIsMissing) {
  EXPECT_THAT(refusal("smart_sixx"), HasSubstr("did you mean 'smart_six'"));
  EXPECT_THAT(refusal("smart_six", "eye"), HasSubstr("smart_six: has no link 'eye'"));
  EXPECT_THAT(refusal((folder_ / "none.urdf").string()), HasSubstr("none.urdf"));
  EXPECT_THAT(refusal(arm("meshes/gone.stl").string()), HasSubstr("gone.stl"));
  EXPECT_THAT(refusal(arm("package://other/base.obj").string()), HasSubstr("names package 'other'"));
  std::ofstream(folder_ / "empty.urdf").close();
  EXPECT_THAT(refusal((folder_ / "empty.urdf").string()), HasSubstr("empty.urdf"));
  EXPECT_THAT(refusal(folder_.string()), HasSubstr("is a folder"));
}

}  // namespace
}  // namespace vantage
