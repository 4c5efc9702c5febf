// End-to-end regression of the contour planner's stages (12.10): a box on a table, seen from the front only.
// Tolerance 15 % on counts and gains, 5 deg on normals.

#include <gtest/gtest.h>

#include <algorithm>

#include "core/raycasting/uniform_caster.h"
#include "core/views/contour_views.h"
#include "tests/support/analytic_scene.h"

namespace vantage {
namespace {

const Box kBox(Eigen::Vector3d(-0.06, -0.05, 0.0), Eigen::Vector3d(0.06, 0.05, 0.16));

/// Everything computed once: map, contours, and the contour points near the box.
struct Regression {
  PinholeCamera camera;
  StateGrid states;
  Contours contours;
  struct Near {
    ContourPoint point;
    double opaque = 0.0, transparent = 0.0;  ///< gain of the central pose, pixels
  };
  std::vector<Near> side, top;  ///< points on the rear vertical rims and on the rear top rim
  std::size_t near_voxels = 0, near_points = 0;

  Regression() {
    GridGeometry geometry;
    geometry.voxel_size_m = 3.0 / 512;
    geometry.size = {256, 256, 256};
    geometry.origin_m =
        Eigen::Vector3d(-0.75, -0.9, -0.1) + Eigen::Vector3d::Constant(geometry.voxel_size_m / 2);
    TsdfVolume volume(geometry);
    const test::AnalyticScene scene{Box(Eigen::Vector3d(-1.0, -0.66, 0.0), Eigen::Vector3d(1.0, 0.66, 0.0)),
                                    {kBox}};
    for (const double a : {-0.3, -0.15, 0.0, 0.15, 0.3}) {
      const Pose pose = lookAt({std::sin(a), -std::cos(a), 0.6}, {0, 0, 0.08});
      const DepthImage depth = scene.render(camera, pose);
      for (int frame = 0; frame < 6; ++frame) fuseDepth(volume, depth, camera, pose, {});
    }
    states = makeStateGrid(volume);
    contours = extractContours(volume, {});
    for (const ContourVoxel& v : contours.voxels) near_voxels += nearBox(geometry.center(v.voxel));
    for (const ContourPoint& point : contours.points) {
      if (!nearBox(point.position_m)) continue;
      ++near_points;
      (point.normal.z() > 0.5 ? top : side)
          .push_back({point, gain(point, OutsideUnknown::Opaque), gain(point, OutsideUnknown::Transparent)});
    }
  }

  static bool nearBox(const Eigen::Vector3d& p) { return kBox.exteriorDistance(p) < 0.03 && p.z() > 0.012; }

  /// Pixels of unknown seen by the central pose of a point, inside the sphere of the box.
  double gain(const ContourPoint& point, OutsideUnknown outside) const {
    VisibilityQuery query;
    query.sphere = Sphere{kBox.center(), 0.112 + 0.20};
    query.outside = outside;
    const Pose pose = contourViewPositions({point}, {}).front().T_world_camera;
    return static_cast<double>(castUniform(states, camera, pose, query).unknown);
  }
};

const Regression& regression() {
  static const Regression r;
  return r;
}

void expectWithin15Percent(double value, double low, double high) {
  EXPECT_GE(value, 0.85 * low);
  EXPECT_LE(value, 1.15 * high);
}

double angleDeg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 180.0 / M_PI;
}

TEST(HalfSeenBox, ContourVoxelsPointsAndPosesOfTheWholeVolume) {
  const Regression& r = regression();
  expectWithin15Percent(static_cast<double>(r.contours.voxels.size()), 462, 462);
  expectWithin15Percent(static_cast<double>(r.contours.points.size()), 117, 117);
  EXPECT_EQ(contourViews(r.contours.points, {}).size(), 40 * r.contours.points.size());
}

TEST(HalfSeenBox, ContourOfTheBoxRunsAlongItsRearRims) {
  const Regression& r = regression();
  expectWithin15Percent(static_cast<double>(r.near_voxels), 76, 76);
  expectWithin15Percent(static_cast<double>(r.near_points), 16, 16);
  std::size_t left = 0;
  for (const auto& near : r.side) left += near.point.position_m.x() < 0;
  EXPECT_NEAR(static_cast<double>(left), 6, 1);
  EXPECT_NEAR(static_cast<double>(r.side.size() - left), 6, 1);
  EXPECT_NEAR(static_cast<double>(r.top.size()), 4, 1);
}

TEST(HalfSeenBox, RearVerticalRimsPointSidewaysAndSlightlyBackward) {
  ASSERT_FALSE(regression().side.empty());
  for (const auto& near : regression().side) {
    const double sign = near.point.position_m.x() < 0 ? -1.0 : 1.0;
    EXPECT_LT(angleDeg(near.point.normal, {sign * 0.98, 0.18, 0.0}), 5.0) << near.point.normal.transpose();
  }
}

TEST(HalfSeenBox, RearTopRimPointsUpAndBackward) {
  ASSERT_FALSE(regression().top.empty());
  for (const auto& near : regression().top) {
    const Eigen::Vector3d& n = near.point.normal;
    EXPECT_LE(std::abs(n.x()), 0.12 + 0.087);
    EXPECT_LT(angleDeg({0.0, n.y(), n.z()}, {0.0, 0.38, 0.925}), 5.0);
  }
}

TEST(HalfSeenBox, SidePosesSeeUnknownWhetherOrNotTheSurroundingsAreOpaque) {
  ASSERT_FALSE(regression().side.empty());
  for (const auto& near : regression().side) {
    expectWithin15Percent(near.opaque, 4800, 13600);
    expectWithin15Percent(near.transparent, 17600, 21100);
  }
}

TEST(HalfSeenBox, TopPosesStandInUnseenSpace) {
  ASSERT_FALSE(regression().top.empty());
  for (const auto& near : regression().top) {
    EXPECT_EQ(near.opaque, 0.0);
    expectWithin15Percent(near.transparent, 54000, 56000);
    const Eigen::Vector3d sensor =
        contourViewPositions({near.point}, {}).front().T_world_camera.translation();
    EXPECT_EQ(regression().states.at(regression().states.geometry().voxelAt(sensor)), VoxelState::Unknown);
  }
}

TEST(HalfSeenBox, ThreeQuartersOfTheCentralPosesPassTheThresholdAndTheBestIsASideView) {
  const Regression& r = regression();
  const auto passing = [](const std::vector<Regression::Near>& points) {
    return std::count_if(points.begin(), points.end(), [](const auto& near) { return near.opaque > 700; });
  };
  const auto best = [](const std::vector<Regression::Near>& points) {
    double gain = 0.0;
    for (const auto& near : points) gain = std::max(gain, near.opaque);
    return gain;
  };
  EXPECT_GT(best(r.side), best(r.top));
  EXPECT_NEAR(static_cast<double>(passing(r.side) + passing(r.top)) / static_cast<double>(r.near_points),
              0.75, 0.06);
}

}  // namespace
}  // namespace vantage
