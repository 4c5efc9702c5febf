// Acceptance check 12.4: first-hit gain before a wall of unknown space.
#include <gtest/gtest.h>

#include "core/raycasting/uniform_caster.h"

namespace vantage {
namespace {

constexpr double kVoxel = 3.0 / 512;
constexpr double kWall = 0.8;

/// Free space with everything at z >= 0.8 m unknown; the camera at the world's origin looks along +z.
class GainAcceptance : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { grid_ = new StateGrid(wallOfUnknown()); }
  static void TearDownTestSuite() {
    delete grid_;
    grid_ = nullptr;
  }

  static StateGrid wallOfUnknown() {
    GridGeometry g;
    g.voxel_size_m = kVoxel;
    g.size = {260, 220, 150};
    // The wall's face is a border between voxels; the optical axis runs through edges, like any other it is
    // free.
    g.origin_m = {-129.5 * kVoxel, -109.5 * kVoxel, kWall + (0.5 - 140) * kVoxel};
    StateGrid grid(g);
    for (std::size_t i = 0; i < g.count(); ++i)
      if (g.voxel(i).z() < 140) grid.set(g.voxel(i), VoxelState::Free);
    grid.rebuildFreeRadius();
    return grid;
  }

  static Pose eye() { return Pose::Identity(); }
  static VisibilityQuery sphereQuery() {
    VisibilityQuery query;
    query.sphere = Sphere{{0, 0, kWall}, 0.3118};
    query.distinct_voxels = true;
    return query;
  }
  /// The grid with voxels of layer `k` (all, or those below the sphere's shadow) in another state.
  static StateGrid withLayer(int k, VoxelState state) {
    StateGrid grid = *grid_;
    for (int j = 0; j < grid.geometry().size.y(); ++j)
      for (int i = 0; i < grid.geometry().size.x(); ++i) grid.set({i, j, k}, state);
    grid.rebuildFreeRadius();
    return grid;
  }

  static StateGrid* grid_;
  PinholeCamera camera_;
};
StateGrid* GainAcceptance::grid_ = nullptr;

TEST_F(GainAcceptance, EveryPixelSeesTheWall) {
  VisibilityQuery query;
  query.distinct_voxels = true;
  const VisibilityCounts counts = castUniform(*grid_, camera_, eye(), query);
  EXPECT_EQ(counts.unknown, 217088u);
  EXPECT_EQ(counts.rays, 217088u);
  EXPECT_EQ(counts.occupied, 0u);
  EXPECT_NEAR(counts.unknown_voxels, 30720, 307);
  EXPECT_NEAR(static_cast<double>(counts.unknown) / counts.unknown_voxels, 7.07, 0.08);
}

TEST_F(GainAcceptance, SphereLimitsTheGain) {
  const VisibilityCounts counts = castUniform(*grid_, camera_, eye(), sphereQuery());
  EXPECT_NEAR(counts.unknown, 63572, 318);
  EXPECT_NEAR(counts.unknown_voxels, 9024, 180);
}

TEST_F(GainAcceptance, OccupiedPlateHidesEverything) {
  const StateGrid plate = withLayer(100, VoxelState::Occupied);
  for (const auto outside : {OutsideUnknown::Opaque, OutsideUnknown::Transparent}) {
    VisibilityQuery query = sphereQuery();
    query.outside = outside;
    EXPECT_EQ(castUniform(plate, camera_, eye(), query).unknown, 0u);
    query.sphere.reset();
    EXPECT_EQ(castUniform(plate, camera_, eye(), query).unknown, 0u);
  }
}

TEST_F(GainAcceptance, UnknownSlabInFrontHidesTheSphereUnlessTransparent) {
  const StateGrid slab = withLayer(70, VoxelState::Unknown);
  VisibilityQuery query = sphereQuery();
  EXPECT_EQ(castUniform(slab, camera_, eye(), query).unknown, 0u);
  query.outside = OutsideUnknown::Transparent;
  const VisibilityCounts through = castUniform(slab, camera_, eye(), query);
  const VisibilityCounts without = castUniform(*grid_, camera_, eye(), query);
  EXPECT_EQ(through.unknown, without.unknown);
  EXPECT_EQ(through.unknown_voxels, without.unknown_voxels);
  EXPECT_NEAR(without.unknown, 63572, 318);
}

TEST_F(GainAcceptance, QuarterResolutionTimes16IsWithin7PerMille) {
  const PinholeCamera quarter = camera_.reduced(4);
  EXPECT_EQ(16 * castUniform(*grid_, quarter, eye(), {}).unknown, 217088u);
  // The disc of the sphere covers few pixels of the small image: how well one view does depends on where
  // their centres fall, so the bound is for the mean over views from shifted positions.
  double full = 0, coarse = 0;
  for (int n = 0; n < 8; ++n) {
    Pose pose = eye();
    pose.translation() = Eigen::Vector3d(0.0013 * (n % 4) - 0.002, 0.0037 * (n / 4) - 0.003, 0.0021 * n);
    const double one = castUniform(*grid_, camera_, pose, sphereQuery()).unknown;
    const double small = 16.0 * castUniform(*grid_, quarter, pose, sphereQuery()).unknown;
    EXPECT_NEAR(small / one, 1.0, 0.015);
    full += one;
    coarse += small;
  }
  EXPECT_NEAR(coarse / full, 1.0, 0.007);
}

TEST_F(GainAcceptance, NearHitsCountNothingAndFarOnesDoNotExist) {
  PinholeCamera near = camera_, far = camera_;
  near.min_range_m = 1.2;  // longer than the longest ray to the wall
  EXPECT_EQ(castUniform(*grid_, near, eye(), {}).unknown, 0u);
  far.max_range_m = 0.79;
  EXPECT_EQ(castUniform(*grid_, far, eye(), {}).unknown, 0u);
}

}  // namespace
}  // namespace vantage
