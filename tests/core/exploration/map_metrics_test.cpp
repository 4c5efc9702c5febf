#include "core/exploration/map_metrics.h"

#include <gtest/gtest.h>

#include <numbers>

namespace vantage {
namespace {

/// A ball of 0.10 m at the origin, floating over nothing.
class BallTruth : public GroundTruth {
 public:
  double objectDistance(const Eigen::Vector3d& p) const override { return std::abs(p.norm() - kRadius); }
  bool insideSolid(const Eigen::Vector3d& p) const override { return p.norm() < kRadius; }
  std::vector<Box> objectBoxes() const override {
    return {Box(Eigen::Vector3d::Constant(-kRadius), Eigen::Vector3d::Constant(kRadius))};
  }
  std::vector<Box> knownBoxes() const override { return {}; }
  bool insideKnown(const Eigen::Vector3d&) const override { return false; }
  const std::vector<Eigen::Vector3f>& observableSurface() const override { return surface_; }
  int objectAt(const Eigen::Vector3d& p, double within_m) const override {
    return objectDistance(p) <= within_m ? 0 : -1;
  }
  static constexpr double kRadius = 0.10;

 private:
  std::vector<Eigen::Vector3f> surface_;
};

const GridGeometry kGrid{{-0.295, -0.295, -0.295}, 0.01, {60, 60, 60}};

TEST(MapMetrics, CountsTheShellAroundAnObjectAndItsBox) {
  const BallTruth truth;
  const Box workspace(Eigen::Vector3d(-0.2, -0.2, 0.0), Eigen::Vector3d(0.2, 0.2, 0.2));
  const MapMetricsCounter counter(kGrid, workspace, &truth);
  const MapMetrics metrics = counter.count(StateGrid(kGrid));
  // Nothing is known: a shell of 5 cm outside the ball, a box of 30 cm, a workspace of 40 x 40 x 20 cm.
  const double shell = 4.0 / 3.0 * std::numbers::pi * (std::pow(0.15, 3) - std::pow(0.10, 3)) / 1e-6;
  EXPECT_NEAR(static_cast<double>(metrics.unknown_near_objects.value()), shell, 0.02 * shell);
  EXPECT_EQ(metrics.unknown_in_boxes.value(), 30u * 30 * 30);
  EXPECT_EQ(metrics.unknown_voxels, 40u * 40 * 20);
}

TEST(MapMetrics, KnowsNothingOfObjectsWithoutGroundTruth) {
  const MapMetricsCounter counter(kGrid, kGrid.bounds(), nullptr);
  const MapMetrics metrics = counter.count(StateGrid(kGrid));
  EXPECT_FALSE(metrics.unknown_near_objects);
  EXPECT_FALSE(metrics.unknown_in_boxes);
  EXPECT_EQ(metrics.unknown_voxels, kGrid.count());
}

TEST(MapMetrics, SeenVoxelsNoLongerCount) {
  const BallTruth truth;
  const MapMetricsCounter counter(kGrid, kGrid.bounds(), &truth);
  StateGrid states(kGrid);
  const MapMetrics before = counter.count(states);
  const Eigen::Vector3i near_ball = kGrid.voxelAt({0.12, 0.0, 0.0});
  states.set(near_ball, VoxelState::Free);
  const MapMetrics after = counter.count(states);
  EXPECT_EQ(*before.unknown_near_objects - *after.unknown_near_objects, 1u);
  EXPECT_EQ(*before.unknown_in_boxes - *after.unknown_in_boxes, 1u);
  EXPECT_EQ(before.unknown_voxels - after.unknown_voxels, 1u);
}

TEST(SurfaceCoverage, IsTheShareOfTruePointsWithAVertexWithinOneCentimetre) {
  std::vector<Eigen::Vector3f> truth;
  for (int i = 0; i < 100; ++i) truth.emplace_back(0.01f * static_cast<float>(i), 0.0f, 0.0f);
  SurfaceCloud surface;
  EXPECT_EQ(surfaceCoverage(truth, surface.points, kCoverageDistance_m), 0.0);
  surface.points = {{0.5f, 0.009f, 0.0f}, {0.0f, 0.011f, 0.0f}, {5.0f, 0.0f, 0.0f}};
  EXPECT_DOUBLE_EQ(surfaceCoverage(truth, surface.points, kCoverageDistance_m),
                   0.01);  // only the point at 0.5 m
  surface.points = truth;
  EXPECT_DOUBLE_EQ(surfaceCoverage(truth, surface.points, kCoverageDistance_m), 1.0);
  EXPECT_EQ(surfaceCoverage({}, surface.points, kCoverageDistance_m), 0.0);
}

TEST(CountUnknown, MatchesTheVolumeOfTheBall) {
  const StateGrid states(kGrid);
  const double expected = 4.0 / 3.0 * std::numbers::pi * std::pow(0.2, 3) / 1e-6;
  EXPECT_NEAR(static_cast<double>(countUnknown(states, {Eigen::Vector3d::Zero(), 0.2})), expected,
              0.01 * expected);
  EXPECT_EQ(countUnknown(states, {{5, 5, 5}, 0.2}), 0u);
}

}  // namespace
}  // namespace vantage
