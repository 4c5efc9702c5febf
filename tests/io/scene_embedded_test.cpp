#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/config_file.h"
#include "io/scene_rays.h"
#include "io/scene_truth.h"
#include "scene_support.h"

namespace vantage {
namespace {

using Eigen::Vector3d;

std::vector<std::string> embeddedNames() {
  std::vector<std::string> names;
  for (const EmbeddedScene& scene : embeddedScenes()) names.push_back(scene.name);
  return names;
}

class Embedded : public ::testing::TestWithParam<std::string> {};

TEST_P(Embedded, ObjectsStandOnSomethingWithoutSinkingIn) {
  const SceneFile scene = loadScene(GetParam());
  const SceneTruth truth(scene);
  ASSERT_FALSE(truth.objectNames().empty());
  for (const std::string& name : truth.objectNames()) {
    const std::vector<Vector3d> points = test::surfaceSamples(scene, name);
    ASSERT_GT(points.size(), 100u) << name;
    double lowest = 1e9, smallest = 1e9, below = 1e9;
    for (const Vector3d& p : points) lowest = std::min(lowest, p.z());
    for (const Vector3d& p : points) {
      const double distance = test::distanceToOthers(scene, name, p);
      smallest = std::min(smallest, distance);
      if (p.z() < lowest + 0.001) below = std::min(below, distance);
    }
    EXPECT_GT(smallest, -0.001) << name << " sinks into something";
    EXPECT_LT(below, 0.001) << name << " floats";
  }
}

TEST_P(Embedded, ObjectsKeepFiveCentimetresFromTheTableBorder) {
  const SceneFile scene = loadScene(GetParam());
  Box table;
  for (const Solid& solid : scene.solids)
    if (solid.role() == SolidRole::Table) table.extend(solid.bounds());
  if (table.isEmpty()) GTEST_SKIP() << "the scene has no table";
  for (const Box& box : SceneTruth(scene).objectBoxes())
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_GE(box.min()[axis], table.min()[axis] + 0.05);
      EXPECT_LE(box.max()[axis], table.max()[axis] - 0.05);
    }
}

TEST_P(Embedded, ConfigurationIsAcceptedAndValid) {
  const SceneFile scene = loadScene(GetParam());
  Settings settings;
  applyScene(settings, scene);
  EXPECT_NO_THROW(settings.validate());
  const Vector3d rounding = Vector3d::Constant(1e-6);
  const Box workspace(settings.exploration.workspace.min() - rounding,
                      settings.exploration.workspace.max() + rounding);
  for (const Box& box : SceneTruth(scene).objectBoxes())
    EXPECT_TRUE(workspace.contains(box)) << "the workspace misses an object";
  // Every pose of the initial scan is in free space, within reach, inside the mapped volume.
  for (const Pose& pose : initialScanPoses(settings.exploration.scan)) {
    const Vector3d eye = pose.translation();
    EXPECT_TRUE(settings.exploration.volume.bounds().contains(eye));
    EXPECT_GE(eye.z(), settings.free_flyer.min_height_m);
    const double reach = settings.free_flyer.reach_m;
    EXPECT_TRUE(reach == 0 || (eye - settings.free_flyer.reach_center_m).norm() <= reach);
    for (const Solid& solid : scene.solids) EXPECT_GT(solid.signedDistance(eye), 0.15);
  }
}

TEST_P(Embedded, TextDescribesTheSceneByItself) {
  const SceneFile scene = loadScene(GetParam());
  const SceneFile again = parseScene(scene.text, GetParam());
  test::expectEqualSolids(again, scene);
  EXPECT_EQ(test::configurationOf(again), test::configurationOf(scene));
}

TEST_P(Embedded, StandsInAClosedRoom) {
  if (GetParam() == "b4_bar") GTEST_SKIP() << "its ground and wall have no end within the camera's range";
  const SceneFile scene = loadScene(GetParam());
  const SceneRays rays(sceneMesh(scene, true));
  std::vector<Eigen::Vector3f> directions;
  for (int i = 0; i < 2000; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 2000, angle = 2.4 * i, r = std::sqrt(1 - z * z);
    directions.emplace_back(static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)),
                            static_cast<float>(z));
  }
  std::vector<float> t(directions.size());
  rays.firstHits({-0.8f, -0.6f, 1.1f}, directions, t);
  for (const float hit : t) ASSERT_LT(hit, 10.0f);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Embedded, ::testing::ValuesIn(embeddedNames()),
                         [](const auto& scene) { return scene.param; });

TEST(EmbeddedScenes, AreDescribedInOneLine) {
  const std::vector<EmbeddedScene> scenes = embeddedScenes();
  ASSERT_GE(scenes.size(), 3u);
  for (const EmbeddedScene& scene : scenes) {
    EXPECT_FALSE(scene.description.empty()) << scene.name;
    EXPECT_EQ(scene.description.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace vantage
