#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/core/planners/half_known_block.h"

namespace vantage {
namespace {

using Eigen::Vector3d;
using test::HalfKnownBlock;

const Vector3d kFront(-1.0, 0.03, 0.02), kSide(0.03, -1.0, 0.02), kBack(1.0, 0.03, 0.02);

/// One candidate judged against a map.
ViewUtility judge(const HalfKnownBlock& block, const HierarchicalPlannerConfig& config, const Pose& pose,
                  const Pose& current = Pose::Identity()) {
  const StatePyramid pyramid = block.pyramid();
  const RayTree tree(config.sensor, HalfKnownBlock::kVoxel_m, 3);
  const auto candidates = test::candidatesOf({pose});
  const UtilityInput input{pyramid, tree, block.object_box, candidates, current};
  return evaluateView(input, config, candidates[0],
                      pyramid.finest().count(VoxelState::Unknown, block.object_box));
}

// Section 10.6.
TEST(ViewUtility, DistanceFactorIsOneHalfAndQuarterAtRho0And1And3) {
  const HalfKnownBlock block;
  const Pose view = lookAt(kSide, Vector3d::Zero());
  for (const auto& [rho, expected] : {std::pair{0.0, 1.0}, {1.0, 0.5}, {3.0, 0.25}}) {
    Pose moved = view;
    moved.translation() += Vector3d(0, 0, rho);
    EXPECT_NEAR(judge(block, block.config(), view, moved).distance, expected, 1e-12);
    Pose turned = view;
    turned.rotate(Eigen::AngleAxisd(1.0, Vector3d(1, 2, 3).normalized()));
    HierarchicalPlannerConfig config = block.config();
    config.rotation_weight_m_per_rad = rho;
    EXPECT_NEAR(judge(block, config, view, turned).distance, expected, 1e-12);
  }
}

// D-A17.
TEST(ViewUtility, ConfigurationDistanceCombinesMetresAndRadians) {
  const Pose a = lookAt(kSide, Vector3d::Zero());
  Pose b = a;
  b.rotate(Eigen::AngleAxisd(0.5, Vector3d::UnitZ()));
  b.translation() += Vector3d(0, 3, 0);
  EXPECT_NEAR(configurationDistance(a, b, 8.0), 5.0, 1e-12);
  EXPECT_NEAR(configurationDistance(b, a, 8.0), 5.0, 1e-12);
  EXPECT_NEAR(configurationDistance(a, b, 0.0), 3.0, 1e-12);
}

// Section 10.6 and eq. 2.
TEST(ViewUtility, ScoresZeroWithOneOccupiedRayTooFewAndMoreWithEnough) {
  const HalfKnownBlock block;
  const Pose view = lookAt(kSide, Vector3d::Zero());
  HierarchicalPlannerConfig config = block.config();
  config.min_occupied = 0;
  const double occupied = judge(block, config, view).occupied;
  ASSERT_GT(occupied, 1.0);
  config.min_occupied = occupied + 1;
  const ViewUtility poor = judge(block, config, view);
  EXPECT_EQ(poor.rejection, ViewRejection::Registration);
  EXPECT_EQ(poor.utility, 0.0);
  EXPECT_GT(poor.unknown, 0.0) << "what was traced is kept";
  config.min_occupied = occupied;
  const ViewUtility enough = judge(block, config, view);
  EXPECT_EQ(enough.rejection, ViewRejection::None);
  EXPECT_GT(enough.utility, 0.0);
}

// D-A15.
TEST(ViewUtility, RegistrationByShareTakesThePlaceOfTheNumberOfRays) {
  const HalfKnownBlock block;
  const Pose view = lookAt(kSide, Vector3d::Zero());
  HierarchicalPlannerConfig config = block.config();
  config.min_occupied = 1e9;
  config.min_overlap = 0.01;
  const ViewUtility some = judge(block, config, view);
  ASSERT_EQ(some.rejection, ViewRejection::None);
  const double share = some.occupied / (some.occupied + some.unknown);
  config.min_overlap = share * 1.001;
  EXPECT_EQ(judge(block, config, view).rejection, ViewRejection::Registration);
  config.min_overlap = share * 0.999;
  EXPECT_EQ(judge(block, config, view).rejection, ViewRejection::None);
  EXPECT_EQ(judge(block, config, lookAt(kBack, 2 * kBack)).rejection, ViewRejection::Registration)
      << "nothing is seen at all";
}

TEST(ViewUtility, EveryRejectionHasItsReason) {
  const HalfKnownBlock block;
  const auto why = [&](const Pose& pose) { return judge(block, block.config(), pose).rejection; };
  EXPECT_EQ(why(lookAt(kSide, Vector3d::Zero())), ViewRejection::None);
  EXPECT_EQ(why(lookAt(Vector3d(-0.12, 0.03, 0.02), Vector3d::Zero())), ViewRejection::Position) << "inside";
  EXPECT_EQ(why(lookAt(Vector3d(0.12, 0.03, 0.02), Vector3d::Zero())), ViewRejection::Position) << "unknown";
  EXPECT_EQ(why(lookAt(Vector3d(-0.31, 0.03, 0.02), Vector3d::Zero())), ViewRejection::Position)
      << "the body touches the block";
  EXPECT_EQ(why(lookAt(Vector3d(9, 0, 0), Vector3d::Zero())), ViewRejection::Position) << "outside the map";
  EXPECT_EQ(why(lookAt(kFront, 2 * kFront)), ViewRejection::Registration) << "looks away";
  EXPECT_EQ(why(lookAt(kBack, Vector3d::Zero())), ViewRejection::Registration) << "only unknown in view";
}

TEST(ViewUtility, ARejectedPositionPaysForNoRay) {
  const HalfKnownBlock block;
  for (const Vector3d& eye : {Vector3d(0.12, 0.03, 0.02), Vector3d(-0.31, 0.03, 0.02), Vector3d(9, 0, 0)})
    EXPECT_EQ(judge(block, block.config(), lookAt(eye, Vector3d(0.01, 0.02, 0.0))).rays, RayCounts{});
}

// D-A12: a point robot on the border of the block; only the sensor's own voxel counts.
TEST(ViewUtility, ASensorInsideSomethingIsNoView) {
  const HalfKnownBlock block;
  HierarchicalPlannerConfig config = block.config();
  config.body_m = 0.0;
  EXPECT_EQ(judge(block, config, lookAt(Vector3d(-0.29, 0.03, 0.02), Vector3d::Zero())).rejection,
            ViewRejection::Position);
  EXPECT_NE(judge(block, config, lookAt(Vector3d(-0.31, 0.03, 0.02), Vector3d::Zero())).rejection,
            ViewRejection::Position);
}

// Eq. 1, 3 and 5.
TEST(ViewUtility, IsTheProductOfSurfaceAndDistance) {
  const HalfKnownBlock block;
  const Pose view = lookAt(kSide, Vector3d::Zero()), current = lookAt(kFront, Vector3d::Zero());
  const ViewUtility u = judge(block, block.config(), view, current);
  ASSERT_EQ(u.rejection, ViewRejection::None);
  EXPECT_DOUBLE_EQ(u.surface, u.unknown / (12.0 * 12 * 6));
  EXPECT_DOUBLE_EQ(u.distance, 1.0 / (1.0 + configurationDistance(view, current, 1.0)));
  EXPECT_DOUBLE_EQ(u.utility, u.surface * u.distance);
  EXPECT_EQ(u.unknown, static_cast<double>(u.rays.unknown));
  EXPECT_EQ(u.occupied, static_cast<double>(u.rays.occupied));
}

// D-A4.
TEST(ViewUtility, CountsDistinctVoxelsWhenAsked) {
  const HalfKnownBlock block;
  HierarchicalPlannerConfig config = block.config();
  config.count = GainCount::Voxels;
  config.coarse_levels = 0;
  const Pose view = lookAt(kSide, Vector3d::Zero());
  const ViewUtility u = judge(block, config, view);
  EXPECT_EQ(u.unknown, static_cast<double>(u.rays.unknown_voxels));
  EXPECT_EQ(u.occupied, static_cast<double>(u.rays.occupied_voxels));
  EXPECT_LE(u.unknown, 12.0 * 12 * 6);
  EXPECT_GT(u.unknown, 50.0);
}

// Requirement (i) of section 10.4.
TEST(ViewUtility, WithoutCoarseLevelsEveryViewEqualsUniformRayTracing) {
  const HalfKnownBlock block;
  const StatePyramid pyramid = block.pyramid();
  const RayTree tree = block.tree();
  HierarchicalPlannerConfig config = block.config();
  config.coarse_levels = 0;
  config.min_occupied = 0;
  const auto candidates = icosphereViews(block.object_box.center(), 1.0, 1);
  const UtilityInput input{pyramid, tree, block.object_box, candidates, Pose::Identity()};
  HierarchicalQuery query;
  query.bounds = block.object_box;
  for (const ViewCandidate& candidate : candidates) {
    const ViewUtility u = evaluateView(input, config, candidate, 1);
    ASSERT_EQ(u.rejection, ViewRejection::None);
    EXPECT_GT(u.rays.unknown + u.rays.occupied, 0u);
    EXPECT_EQ(u.rays, castUniformRays(pyramid.finest(), tree, candidate.T_world_camera, query));
    EXPECT_EQ(u.rays, castHierarchicalReference(pyramid, tree, 0, candidate.T_world_camera, query));
  }
}

TEST(BodyFits, OnlyIfEveryVoxelThatTheCubeOverlapsIsFree) {
  const HalfKnownBlock block;
  StateGrid grid = block.states;
  const GridGeometry& g = grid.geometry();
  const Eigen::Vector3i v(10, 10, 10);
  grid.set(v, VoxelState::Unknown);
  const Vector3d middle = g.center(v);
  const double voxel = g.voxel_size_m;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      const Vector3d step = sign * voxel * Vector3d::Unit(axis);
      EXPECT_FALSE(bodyFits(grid, middle + 1.49 * step, 2 * voxel));
      EXPECT_TRUE(bodyFits(grid, middle + 1.51 * step, 2 * voxel));
      EXPECT_TRUE(bodyFits(grid, middle + 1.5 * step, 2 * voxel)) << "a shared border is no overlap";
    }
  EXPECT_FALSE(bodyFits(grid, middle, 0.0)) << "a point stands in its voxel";
  EXPECT_TRUE(bodyFits(grid, middle + Vector3d(0.51 * voxel, 0, 0), 0.0));
}

TEST(BodyFits, NothingIsFreeOutsideTheMap) {
  const HalfKnownBlock block;
  const StateGrid& grid = block.states;  // to x = 1.5
  EXPECT_TRUE(bodyFits(grid, {1.39, 0, 0}, 0.2));
  EXPECT_TRUE(bodyFits(grid, {1.40, 0, 0}, 0.2)) << "the cube ends at the border";
  EXPECT_FALSE(bodyFits(grid, {1.41, 0, 0}, 0.2));
  EXPECT_FALSE(bodyFits(grid, {-1.41, 0, 0}, 0.2));
  EXPECT_FALSE(bodyFits(grid, {0, 1.6, 0}, 0.0));
  EXPECT_FALSE(bodyFits(grid, {0, 0, 1e300}, 0.0));
  EXPECT_FALSE(bodyFits(grid, {0, std::nan(""), 0}, 0.0));
  EXPECT_FALSE(bodyFits(grid, {0, 0, 0}, 1e300));
  EXPECT_FALSE(bodyFits(StateGrid(), {0, 0, 0}, 0.0)) << "an empty map";
}

TEST(HierarchicalPlannerConfig, RefusesValuesOutOfRange) {
  EXPECT_NO_THROW(HierarchicalPlannerConfig().validate());
  const auto refuses = [](auto change) {
    HierarchicalPlannerConfig config;
    change(config);
    try {
      config.validate();
    } catch (const std::invalid_argument& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  using C = HierarchicalPlannerConfig;
  EXPECT_NE(refuses([](C& c) { c.coarse_levels = -1; }).find("coarse_levels = -1"), std::string::npos);
  EXPECT_NE(refuses([](C& c) { c.coarse_levels = 9; }), "");
  EXPECT_NE(refuses([](C& c) { c.icosphere_subdivisions = 7; }), "");
  EXPECT_NE(refuses([](C& c) { c.sphere_radius_m = 0; }), "");
  EXPECT_NE(refuses([](C& c) { c.workspace_views = -1; }), "");
  EXPECT_NE(refuses([](C& c) { c.body_m = -0.01; }), "");
  EXPECT_NE(refuses([](C& c) { c.min_occupied = std::nan(""); }), "");
  EXPECT_NE(refuses([](C& c) { c.min_overlap = 1.5; }), "");
  EXPECT_NE(refuses([](C& c) { c.stop_gain = -1; }), "");
  EXPECT_NE(refuses([](C& c) { c.rotation_weight_m_per_rad = std::numeric_limits<double>::infinity(); }), "");
  EXPECT_NE(refuses([](C& c) { c.sensor.max_range_m = 0.1; }), "");
  EXPECT_NE(refuses([](C& c) { c.count = GainCount::Voxels; }).find("refine_unknown"), std::string::npos);
  EXPECT_EQ(refuses([](C& c) {
              c.count = GainCount::Voxels;
              c.refine_unknown = true;
            }),
            "");
}

TEST(Candidates, ComeFromTheConfiguredGenerator) {
  HierarchicalPlannerConfig config;
  const Box object(Vector3d(0, 0, 0), Vector3d(0.4, 0.2, 0.6));
  const Box workspace(Vector3d(-1, -1, 0), Vector3d(1, 1, 2));
  const auto sphere = makeCandidates(config, object, workspace, 1);
  ASSERT_EQ(sphere.size(), 320u);
  for (const ViewCandidate& view : sphere)
    EXPECT_NEAR((view.T_world_camera.translation() - Vector3d(0.2, 0.1, 0.3)).norm(), 1.0, 1e-12);
  config.generator = CandidateGenerator::Workspace;
  const auto drawn = makeCandidates(config, object, workspace, 1);
  ASSERT_EQ(drawn.size(), 1500u);
  for (const ViewCandidate& view : drawn) EXPECT_TRUE(workspace.contains(view.T_world_camera.translation()));
}

}  // namespace
}  // namespace vantage
