#include "core/views/sphere_views.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

namespace vantage {
namespace {

const Eigen::Vector3d kCenter(0.1, -0.2, 0.69);
const Box kRoom(Eigen::Vector3d(-1.0, -2.0, 0.1), Eigen::Vector3d(1.0, 2.0, 1.9));

TEST(IcosphereViews, LookAtTheCenterFromTheSphereWithLevelImages) {
  const auto views = icosphereViews(kCenter, 1.25, 2);
  ASSERT_EQ(views.size(), 320u);
  for (std::size_t n = 0; n < views.size(); ++n) {
    const Pose& pose = views[n].T_world_camera;
    EXPECT_EQ(views[n].id, n);
    EXPECT_TRUE(isRigid(pose.matrix(), 1e-12));
    EXPECT_NEAR((pose * Eigen::Vector3d(0, 0, 1.25) - kCenter).norm(), 0.0, 1e-12);
    EXPECT_NEAR(pose.linear()(2, 0), 0.0, 1e-12) << "the image x axis is horizontal";
    EXPECT_LE(pose.linear()(2, 1), 0.0) << "the image y axis points down";
  }
}

TEST(IcosphereViews, RefuseBadSpheres) {
  EXPECT_THROW(icosphereViews(kCenter, 0.0, 2), std::invalid_argument);
  EXPECT_THROW(icosphereViews(kCenter, -1.0, 2), std::invalid_argument);
  EXPECT_THROW(icosphereViews(kCenter, std::nan(""), 2), std::invalid_argument);
  EXPECT_THROW(icosphereViews(kCenter, 1.0, 7), std::invalid_argument);
}

TEST(WorkspaceViews, TheNthViewDependsOnSeedAndNumberAlone) {
  const auto few = workspaceViews(kRoom, 10, 7), many = workspaceViews(kRoom, 100, 7);
  const auto other = workspaceViews(kRoom, 10, 8);
  ASSERT_EQ(few.size(), 10u);
  ASSERT_EQ(many.size(), 100u);
  for (std::size_t n = 0; n < few.size(); ++n) {
    EXPECT_EQ(few[n].id, n);
    EXPECT_EQ(few[n].T_world_camera.matrix(), many[n].T_world_camera.matrix());
    EXPECT_GT((few[n].T_world_camera.translation() - other[n].T_world_camera.translation()).norm(), 1e-6);
  }
}

TEST(WorkspaceViews, PositionsFillTheBoxEvenly) {
  constexpr int kViews = 16000;
  std::array<int, 8> octants{};
  for (const ViewCandidate& view : workspaceViews(kRoom, kViews, 1)) {
    const Eigen::Vector3d p = view.T_world_camera.translation();
    ASSERT_TRUE(kRoom.contains(p));
    const Eigen::Vector3d side = p - kRoom.center();
    ++octants[(side.x() > 0) + 2 * (side.y() > 0) + 4 * (side.z() > 0)];
  }
  for (const int inside : octants) EXPECT_NEAR(inside, kViews / 8, 5 * std::sqrt(kViews / 8.0));
}

// The angle t of a uniform rotation has the density (1 - cos t) / pi; axes of the camera are uniform on the
// sphere, so that each coordinate is uniform in [-1, 1] with variance 1/3.
TEST(WorkspaceViews, OrientationsAreUniformOverAllRotations) {
  constexpr int kViews = 16000;
  double angle_sum = 0.0;
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero(), square = Eigen::Matrix3d::Zero();
  for (const ViewCandidate& view : workspaceViews(kRoom, kViews, 3)) {
    EXPECT_TRUE(isRigid(view.T_world_camera.matrix(), 1e-9));
    const Eigen::Matrix3d R = view.T_world_camera.linear();
    mean += R / kViews;
    square += R.cwiseProduct(R) / kViews;
    angle_sum += angleBetween(view.T_world_camera, Pose::Identity());
  }
  const double expected_angle = M_PI / 2 + 2 / M_PI;
  EXPECT_NEAR(angle_sum / kViews, expected_angle, 0.03);
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.025);
  EXPECT_LT((square.array() - 1.0 / 3.0).abs().maxCoeff(), 0.015);
}

TEST(WorkspaceViews, RefuseNegativeCountsAndEmptyBoxes) {
  EXPECT_THROW(workspaceViews(kRoom, -1, 1), std::invalid_argument);
  EXPECT_THROW(workspaceViews(Box(), 5, 1), std::invalid_argument);
  EXPECT_TRUE(workspaceViews(kRoom, 0, 1).empty());
}

}  // namespace
}  // namespace vantage
