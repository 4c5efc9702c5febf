#include "io/scene_truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "scene_support.h"

namespace vantage {
namespace {

using Eigen::Vector3d;
using test::sceneOf;

const char* kTwoObjects = R"(
[[solid]]
kind = "box"
object = "table"
role = "table"
position_m = [0, 0, -0.04]
size_m = [2, 1.32, 0.04]
[[solid]]
kind = "box"
object = "block"
size_m = [0.2, 0.2, 0.2]
[[solid]]
kind = "sphere"
object = "ball"
position_m = [0.5, 0, 0.1]
radius_m = 0.1
[[solid]]
kind = "sphere"
object = "ball"
position_m = [0.5, 0, 0.2]
radius_m = 0.1
)";

TEST(SceneTruth, MeasuresDistanceToObjectsOnly) {
  const SceneTruth truth(sceneOf(kTwoObjects));
  EXPECT_NEAR(truth.objectDistance({0, 0, 0.25}), 0.05, 1e-9);
  EXPECT_NEAR(truth.objectDistance({0, 0, 0.19}), 0.01, 1e-9);
  EXPECT_NEAR(truth.objectDistance({-0.6, 0, 0.1}), 0.5, 1e-9);
  EXPECT_NEAR(truth.objectDistance({0.5, 0, 0.5}), 0.2, 1e-9);
}

TEST(SceneTruth, KnowsWhatIsInside) {
  const SceneTruth truth(sceneOf(kTwoObjects));
  EXPECT_TRUE(truth.insideSolid({0, 0, 0.1}));
  EXPECT_TRUE(truth.insideSolid({0.9, 0.6, -0.02}));
  EXPECT_FALSE(truth.insideSolid({0, 0, 0.21}));
  EXPECT_TRUE(truth.insideSolid({0.5, 0, 0.28}));
}

TEST(SceneTruth, NamesTheNearestObject) {
  const SceneTruth truth(sceneOf(kTwoObjects));
  EXPECT_THAT(truth.objectNames(), ::testing::ElementsAre("block", "ball"));
  ASSERT_EQ(truth.objectBoxes().size(), 2u);
  EXPECT_NEAR(truth.objectBoxes()[1].max().z(), 0.3, 1e-3);
  EXPECT_EQ(truth.objectAt({0.12, 0, 0.1}, 0.05), 0);
  EXPECT_EQ(truth.objectAt({0.38, 0, 0.1}, 0.05), 1);
  EXPECT_EQ(truth.objectAt({0.25, 0, 0.1}, 0.05), -1);
}

TEST(SceneTruth, ObservableSurfaceHasOnePointPerFourSquareMillimetres) {
  const SceneTruth truth(
      sceneOf("[[solid]]\nkind='box'\nrole='table'\nposition_m=[0,0,-0.04]\nsize_m=[2,1.32,0.04]\n"
              "[[solid]]\nkind='box'\nobject='block'\nsize_m=[0.2,0.2,0.2]\n"));
  // Five faces of 0.04 m^2 can be seen but for the millimetre above the table; the sixth lies on it.
  const auto& points = truth.observableSurface();
  EXPECT_NEAR(static_cast<double>(points.size()), (5 * 0.04 - 4 * 0.2 * 0.001) / 4e-6, 20.0);
  std::array<int, 5> quarters = {};
  for (const Eigen::Vector3f& p : points) {
    ASSERT_LT(truth.objectDistance(p.cast<double>()), 1e-6);
    ASSERT_GT(p.z(), 0.0009f);
    if (p.z() > 0.1999f) ++quarters[(p.x() > 0 ? 1 : 0) + (p.y() > 0 ? 2 : 0)];
  }
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(quarters[i], 2500, 50);  // evenly spread
}

TEST(SceneTruth, LeavesOutWhatNoViewCanSee) {
  // A block under a canopy that hides its top from every sensor position 0.8 m away.
  const SceneTruth truth(
      sceneOf("[[solid]]\nkind='box'\nobject='block'\nsize_m=[0.2,0.2,0.2]\n"
              "[[solid]]\nkind='box'\nrole='other'\nposition_m=[0,0,0.21]\nsize_m=[1.9,1.9,0.01]\n"
              "[[solid]]\nkind='box'\nrole='table'\nposition_m=[0,0,-0.04]\nsize_m=[2,2,0.04]\n"));
  int top = 0, side = 0;
  for (const Eigen::Vector3f& p : truth.observableSurface()) (p.z() > 0.199999f ? top : side) += 1;
  EXPECT_EQ(top, 0);
  EXPECT_GT(side, 20000);
}

TEST(SceneTruth, ObservableSurfaceDoesNotDependOnThreads) {
  const SceneFile scene = loadScene("tabletop");
  std::vector<Eigen::Vector3f> first;
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    first = SceneTruth(scene).observableSurface();
  }
  ASSERT_GT(first.size(), 100000u);
  EXPECT_EQ(first, SceneTruth(scene).observableSurface());
}

TEST(SceneTruth, RefusesImpossibleViews) {
  FeasibleViews views;
  views.distance_m = 0.0;
  EXPECT_THROW(SceneTruth(sceneOf(kTwoObjects), views), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
