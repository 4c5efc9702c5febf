#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

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

/// Vertices of an object and the smallest distance of each to the solids of other names.
double smallestDistanceToOthers(const SceneFile& scene, const std::string& object) {
  double smallest = 1e9;
  for (const Solid& solid : scene.solids) {
    if (solid.object() != object) continue;
    for (const Eigen::Vector3f& v : solid.mesh().vertices)
      for (const Solid& other : scene.solids)
        if (other.object() != object) smallest = std::min(smallest, other.signedDistance(v.cast<double>()));
  }
  return smallest;
}

class Embedded : public ::testing::TestWithParam<std::string> {};

TEST_P(Embedded, ObjectsRestOnSomethingWithoutSinkingIn) {
  const SceneFile scene = loadScene(GetParam());
  const SceneTruth truth(scene);
  ASSERT_FALSE(truth.objectNames().empty());
  for (const std::string& name : truth.objectNames()) {
    const double distance = smallestDistanceToOthers(scene, name);
    EXPECT_LT(distance, 0.0005) << name << " floats";
    EXPECT_GT(distance, -0.001) << name << " sinks into something";
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
  applyToml(settings, scene.text, scene.source_path, sceneGeometryKeys());
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

TEST_P(Embedded, StandsInAClosedRoom) {
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

TEST(Tabletop, HasTheObjectsOfSceneS1) {
  const SceneFile scene = loadScene("tabletop");
  const SceneTruth truth(scene);
  ASSERT_THAT(truth.objectNames(), ::testing::ElementsAre("box L", "jug A", "box R", "jug B", "ball"));
  const std::vector<Box> boxes = truth.objectBoxes();
  const double expected_z[5][2] = {{0, 0.14}, {0.14, 0.34}, {0, 0.10}, {0.10, 0.28}, {0, 0.16}};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(boxes[i].min().z(), expected_z[i][0], 1e-6) << i;
    EXPECT_NEAR(boxes[i].max().z(), expected_z[i][1], 1e-6) << i;
  }
  EXPECT_TRUE(boxes[0].sizes().isApprox(Vector3d(0.22, 0.16, 0.14), 1e-6));
  EXPECT_TRUE(boxes[2].sizes().isApprox(Vector3d(0.24, 0.18, 0.10), 1e-6));
  // The bodies reach radius 7 and 6 cm; the neck of jug A is 4.5 cm wide at most.
  const auto radiusAt = [&](const std::string& name, double from, double to) {
    double widest = 0.0;
    for (const Solid& solid : scene.solids) {
      if (solid.object() != name || (solid.bounds().sizes().x() < 0.08))
        continue;  // the body, not the handle
      for (const Eigen::Vector3f& v : solid.mesh().vertices) {
        const Vector3d p = solid.pose().inverse() * v.cast<double>();
        if (p.z() >= from && p.z() <= to) widest = std::max(widest, p.head<2>().norm());
      }
    }
    return widest;
  };
  EXPECT_NEAR(radiusAt("jug A", 0, 0.2), 0.07, 0.001);
  EXPECT_NEAR(radiusAt("jug A", 0.165, 0.2001), 0.045, 0.001);
  EXPECT_NEAR(radiusAt("jug B", 0, 0.18), 0.06, 0.001);
}

}  // namespace
}  // namespace vantage
