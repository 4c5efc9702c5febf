#include "core/volume/tsdf_volume.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vantage {
namespace {

using ::testing::HasSubstr;

GridGeometry geometry(int x, int y, int z) {
  return {Eigen::Vector3d(-0.1, 0.2, 0.3), 0.01, Eigen::Vector3i(x, y, z)};
}

TEST(BrickLayout, EveryVoxelLiesInTheRangeOfItsBrickAndInNoOther) {
  const BrickLayout bricks(Eigen::Vector3i(37, 17, 9));
  EXPECT_EQ(bricks.count, Eigen::Vector3i(3, 3, 2));
  std::size_t voxels = 0;
  for (std::uint32_t b = 0; b < bricks.total(); ++b) {
    const BrickRange r = bricks.range(b);
    for (int k = r.begin.z(); k < r.end.z(); ++k)
      for (int j = r.begin.y(); j < r.end.y(); ++j)
        for (int i = r.begin.x(); i < r.end.x(); ++i, ++voxels) EXPECT_EQ(bricks.brickOf({i, j, k}), b);
  }
  EXPECT_EQ(voxels, 37u * 17 * 9);
}

TEST(TsdfVolume, BricksRebuildAVolume) {
  TsdfVolume volume(geometry(37, 17, 9)), copy(geometry(37, 17, 9));
  std::int16_t n = 0;
  for (TsdfVoxel& voxel : volume.voxels()) voxel = {++n, static_cast<std::uint16_t>(n % 7)};
  for (std::uint32_t b = 0; b < volume.bricks().total(); ++b) copy.setBrick(b, volume.brick(b));
  EXPECT_TRUE(std::equal(volume.voxels().begin(), volume.voxels().end(), copy.voxels().begin()));
  EXPECT_THROW(copy.setBrick(0, std::vector<TsdfVoxel>(3)), std::invalid_argument);
}

TEST(TsdfVolume, StartsUnknownAndStatesFollowEquation1) {
  const TsdfVolume volume(geometry(5, 6, 7));
  for (const TsdfVoxel& voxel : volume.voxels()) EXPECT_EQ(voxel.state(), VoxelState::Unknown);
  EXPECT_EQ((TsdfVoxel{100, 0}.state()), VoxelState::Unknown);
  EXPECT_EQ((TsdfVoxel{0, 1}.state()), VoxelState::Occupied);
  EXPECT_EQ((TsdfVoxel{-5, 9}.state()), VoxelState::Occupied);
  EXPECT_EQ((TsdfVoxel{1, 1}.state()), VoxelState::Free);
}

TEST(TsdfVolume, RefusesWhatDoesNotFitInMemoryAndNamesTheSize) {
  for (const GridGeometry& g : {geometry(100000, 100000, 100000),
                                geometry(2147483647, 2147483647, 2147483647), geometry(2, 2, 2147483647)}) {
    try {
      TsdfVolume volume(g);
      ADD_FAILURE() << "accepted " << g.size.transpose();
    } catch (const std::runtime_error& e) {
      EXPECT_THAT(e.what(), HasSubstr(std::to_string(g.size.z())));
      EXPECT_THAT(e.what(), HasSubstr("does not fit in memory"));
    }
  }
}

TEST(TsdfVolume, RefusesDegenerateGrids) {
  EXPECT_THROW(TsdfVolume(geometry(1, 5, 5)), std::invalid_argument);
  EXPECT_THROW(TsdfVolume(geometry(5, 5, -3)), std::invalid_argument);
  GridGeometry g = geometry(5, 5, 5);
  g.voxel_size_m = 0.0;
  EXPECT_THROW(TsdfVolume{g}, std::invalid_argument);
}

TEST(BrickSet, ListsItsMembersInAscendingOrderAndMerges) {
  BrickSet a(10), b(10);
  EXPECT_TRUE(a.empty());
  a.insert(7);
  a.insert(2);
  b.insert(5);
  b.merge(a);
  EXPECT_EQ(b.list(), (std::vector<std::uint32_t>{2, 5, 7}));
  EXPECT_EQ(a.list(), (std::vector<std::uint32_t>{2, 7}));
}

TEST(ClearSphere, MarksUnknownVoxelsInsideAsSeenEmptyAndKeepsTheOthers) {
  TsdfVolume volume(geometry(40, 30, 30));
  const Eigen::Vector3d center = volume.geometry().center({3, 15, 15}) + Eigen::Vector3d(0.001, 0.002, 0.003);
  volume.at(5, 15, 15) = {-3, 2};
  const BrickSet changed = clearSphere(volume, center, 0.08);
  BrickSet expected(volume.bricks().total());
  const GridGeometry& g = volume.geometry();
  std::size_t inside = 0;
  for (std::size_t n = 0; n < g.count(); ++n) {
    const Eigen::Vector3i v = g.voxel(n);
    if (v == Eigen::Vector3i(5, 15, 15)) {
      EXPECT_EQ(volume.at(v), (TsdfVoxel{-3, 2}));
    } else if ((g.center(v) - center).norm() <= 0.08) {
      EXPECT_EQ(volume.at(v), (TsdfVoxel{32767, 10}));
      expected.insert(volume.bricks().brickOf(v));
      ++inside;
    } else {
      EXPECT_EQ(volume.at(v), TsdfVoxel{});
    }
  }
  EXPECT_GT(inside, 1000u);
  EXPECT_EQ(changed.list(), expected.list());
  EXPECT_TRUE(clearSphere(volume, center, 0.08).empty());
  EXPECT_TRUE(clearSphere(volume, center + Eigen::Vector3d(9, 9, 9), 0.08).empty());
}

}  // namespace
}  // namespace vantage
