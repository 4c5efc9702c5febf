#include "core/geometry/grid_geometry.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

const GridGeometry kGrid{Eigen::Vector3d(-1, 2, 0.5), 0.01, Eigen::Vector3i(5, 7, 11)};

TEST(GridGeometry, IndicesRunOverXFirstAndBack) {
  std::size_t expected = 0;
  for (int k = 0; k < 11; ++k)
    for (int j = 0; j < 7; ++j)
      for (int i = 0; i < 5; ++i, ++expected) {
        EXPECT_EQ(kGrid.index(i, j, k), expected);
        EXPECT_EQ(kGrid.voxel(expected), Eigen::Vector3i(i, j, k));
      }
  EXPECT_EQ(expected, kGrid.count());
}

TEST(GridGeometry, VoxelHoldsItsCentreAndHalfAVoxelAround) {
  const Eigen::Vector3i v(2, 3, 4);
  for (const double d : {-0.0049, 0.0, 0.0049})
    EXPECT_EQ(kGrid.voxelAt(kGrid.center(v) + Eigen::Vector3d(d, -d, d)), v);
  EXPECT_EQ(kGrid.voxelAt(kGrid.center(v) + Eigen::Vector3d(0.0051, 0, 0)), Eigen::Vector3i(3, 3, 4));
}

TEST(GridGeometry, BoundsReachHalfAVoxelBeyondTheOuterCentres) {
  EXPECT_TRUE(kGrid.bounds().min().isApprox(Eigen::Vector3d(-1.005, 1.995, 0.495), 1e-12));
  EXPECT_TRUE(kGrid.bounds().max().isApprox(Eigen::Vector3d(-0.955, 2.065, 0.605), 1e-12));
  EXPECT_FALSE(kGrid.contains({-1, 0, 0}));
  EXPECT_FALSE(kGrid.contains({0, 7, 0}));
  EXPECT_TRUE(kGrid.contains({4, 6, 10}));
}

}  // namespace
}  // namespace vantage
