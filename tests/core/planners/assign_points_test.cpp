#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "core/planners/contour_planner.h"

namespace vantage {
namespace {

ContourPoint pointAt(const Eigen::Vector3d& p) {
  return {p, Eigen::Vector3d::UnitZ(), 1};
}

std::uint32_t nearestLabel(const Eigen::Vector3d& p, const SurfaceCloud& cloud, const Labels& labels) {
  std::size_t best = 0;
  for (std::size_t n = 1; n < cloud.points.size(); ++n)
    if ((cloud.points[n].cast<double>() - p).squaredNorm() <
        (cloud.points[best].cast<double>() - p).squaredNorm())
      best = n;
  return labels.of_point[best];
}

TEST(AssignContourPoints, TakesTheLabelOfTheNearestOfAllPoints) {
  std::mt19937_64 random(17);
  std::normal_distribution<double> normal;
  // Clusters, far outliers, a flat cloud: near and distant neighbours, crowded and empty cells.
  for (const Eigen::Vector3d& scale : {Eigen::Vector3d(0.3, 0.3, 0.3), Eigen::Vector3d(2.0, 2.0, 0.0),
                                       Eigen::Vector3d(0.01, 0.01, 0.01), Eigen::Vector3d(50.0, 0.1, 0.1)}) {
    SurfaceCloud cloud;
    Labels labels;
    for (std::uint32_t n = 0; n < 3000; ++n) {
      const Eigen::Vector3d p(normal(random), normal(random), normal(random));
      cloud.points.push_back(p.cwiseProduct(scale).cast<float>());
      labels.of_point.push_back(n);  // the label tells the point
    }
    std::vector<ContourPoint> points;
    for (int n = 0; n < 300; ++n) {
      const Eigen::Vector3d p(normal(random), normal(random), normal(random));
      points.push_back(
          pointAt(p.cwiseProduct(2.0 * scale + Eigen::Vector3d::Constant(n % 3 == 0 ? 0.2 : 0.0))));
    }
    const std::vector<std::uint32_t> assigned = assignContourPoints(points, cloud, labels);
    ASSERT_EQ(assigned.size(), points.size());
    for (std::size_t n = 0; n < points.size(); ++n)
      ASSERT_EQ(assigned[n], nearestLabel(points[n].position_m, cloud, labels))
          << n << ", scale " << scale.transpose();
  }
}

TEST(AssignContourPoints, LowestIndexDecidesBetweenEquallyNearPoints) {
  SurfaceCloud cloud;
  cloud.points = {{1.0f, 0.0f, 0.0f}, {-1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {-1.0f, 0.0f, 0.0f}};
  Labels labels;
  labels.of_point = {7, 5, 3, 1};
  EXPECT_EQ(assignContourPoints({pointAt({0.0, 0.0, 0.0}), pointAt({-2.0, 0.0, 0.0})}, cloud, labels),
            (std::vector<std::uint32_t>{7, 5}));
}

TEST(AssignContourPoints, NoLabelWithoutCloudOrFromUnlabelledPoints) {
  EXPECT_EQ(assignContourPoints({pointAt({0.0, 0.0, 0.0})}, {}, {}), std::vector<std::uint32_t>{0});
  SurfaceCloud cloud;
  cloud.points = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}};
  Labels labels;
  labels.of_point = {0, 4};
  EXPECT_EQ(assignContourPoints({pointAt({0.1, 0.0, 0.0})}, cloud, labels), std::vector<std::uint32_t>{0});
  EXPECT_TRUE(assignContourPoints({}, cloud, labels).empty());
}

TEST(AssignContourPoints, RefusesLabelsOfAnotherCloud) {
  SurfaceCloud cloud;
  cloud.points = {{0.0f, 0.0f, 0.0f}};
  EXPECT_THROW(assignContourPoints({}, cloud, {}), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
