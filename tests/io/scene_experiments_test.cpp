// The scenes of the experiments of evaluation.md: B1 (S1 to S4), B3, B4, and those for tuning.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "io/scene_rays.h"
#include "io/scene_truth.h"
#include "scene_support.h"

namespace vantage {
namespace {

using Eigen::Vector3d;
using ::testing::UnorderedElementsAre;

/// Size of an object's first solid along its own axes.
Vector3d sizeOf(const SceneFile& scene, const std::string& object) {
  for (const Solid& solid : scene.solids) {
    if (solid.object() != object) continue;
    Box box;
    for (const Eigen::Vector3f& v : solid.mesh().vertices)
      box.extend(Vector3d(solid.pose().inverse() * v.cast<double>()));
    return box.sizes();
  }
  ADD_FAILURE() << scene.name << " has no " << object;
  return Vector3d::Zero();
}

Box boundsOf(const SceneFile& scene, const std::string& object = {}) {
  Box bounds;
  for (const Solid& solid : scene.solids)
    if (solid.role() == SolidRole::Object && (object.empty() || solid.object() == object))
      bounds.extend(solid.bounds());
  return bounds;
}

struct Sized {
  std::string object;
  Vector3d size_m;
};
struct Wanted {
  std::string scene;
  std::vector<Sized> objects;
};

const Sized kJugA = {"jug A", {0.14, 0.14, 0.20}}, kJugB = {"jug B", {0.12, 0.12, 0.18}},
            kBall = {"ball", {0.16, 0.16, 0.16}};
const std::vector<Wanted> kExploration = {
    {"tabletop", {{"box L", {0.22, 0.16, 0.14}}, kJugA, {"box R", {0.24, 0.18, 0.10}}, kJugB, kBall}},
    {"clutter",
     {kJugB,
      {"small box", {0.15, 0.10, 0.08}},
      {"flat box", {0.20, 0.12, 0.06}},
      {"tall box", {0.12, 0.12, 0.18}},
      {"slim cylinder", {0.08, 0.08, 0.14}},
      {"wide cylinder", {0.12, 0.12, 0.10}},
      {"small ball", {0.12, 0.12, 0.12}},
      {"bowl", {0.18, 0.18, 0.07}}}},
    {"apart",
     {kJugA,
      {"box", {0.25, 0.15, 0.20}},
      {"lower box", {0.14, 0.14, 0.10}},
      {"upper box", {0.14, 0.14, 0.10}}}},
    {"row", {kJugA, kBall, {"box on edge", {0.30, 0.08, 0.25}}, {"cube", {0.16, 0.16, 0.16}}}}};

class ExplorationScene : public ::testing::TestWithParam<Wanted> {};

TEST_P(ExplorationScene, HasItsObjectsInTheirSizes) {
  const SceneFile scene = loadScene(GetParam().scene);
  std::vector<std::string> wanted;
  for (const Sized& sized : GetParam().objects) {
    wanted.push_back(sized.object);
    EXPECT_LT((sizeOf(scene, sized.object) - sized.size_m).cwiseAbs().maxCoeff(), 0.0015) << sized.object;
  }
  EXPECT_THAT(SceneTruth(scene).objectNames(), ::testing::UnorderedElementsAreArray(wanted));
}

TEST_P(ExplorationScene, SharesEverythingButObjectsAndTheirBox) {
  const auto strip = [](const std::string& name) {
    SceneFile scene = loadScene(name);
    Settings settings;
    applyScene(settings, scene);
    settings.origins.clear();
    settings.exploration.octree.object_box = Box();
    std::string text = effectiveToml(settings);
    for (const Solid& solid : scene.solids)
      if (solid.role() != SolidRole::Object)
        text += solid.object() + std::string(toString(solid.role())) +
                std::to_string(solid.bounds().min().sum()) + " " +
                std::to_string(solid.bounds().max().norm()) + "\n";
    return text;
  };
  const std::string text = strip(GetParam().scene);
  EXPECT_THAT(text, ::testing::HasSubstr("panel"));
  EXPECT_EQ(text, strip("tabletop"));
}

TEST_P(ExplorationScene, OpenVariantLacksThePanelAlone) {
  const SceneFile scene = loadScene(GetParam().scene), open = loadScene(GetParam().scene + "_open");
  EXPECT_EQ(test::configurationOf(open), test::configurationOf(scene));
  EXPECT_EQ(open.name, GetParam().scene + "_open");
  SceneFile without = scene;
  EXPECT_EQ(
      std::erase_if(without.solids, [](const Solid& solid) { return solid.role() == SolidRole::Panel; }), 1u);
  test::expectEqualSolids(open, without);
}

INSTANTIATE_TEST_SUITE_P(B1, ExplorationScene, ::testing::ValuesIn(kExploration),
                         [](const auto& scene) { return scene.param.scene; });

TEST(ExplorationScenes, ObjectBoxLeavesFiveCentimetresAroundTheObjects) {
  for (const char* name :
       {"tabletop", "clutter", "apart", "row", "b3_planes", "b4_bar", "tuning_a", "tuning_b"}) {
    const SceneFile scene = loadScene(name);
    Settings settings;
    applyScene(settings, scene);
    const Box bounds = boundsOf(scene), box = settings.exploration.octree.object_box;
    EXPECT_EQ(box.min().z(), 0.0) << name;
    for (int axis = 0; axis < 3; ++axis) {
      if (axis < 2) {
        EXPECT_LE(box.min()[axis], bounds.min()[axis] - 0.0499) << name << axis;
        EXPECT_GE(box.min()[axis], bounds.min()[axis] - 0.0801) << name << axis;
      }
      EXPECT_GE(box.max()[axis], bounds.max()[axis] + 0.0499) << name << axis;
      EXPECT_LE(box.max()[axis], bounds.max()[axis] + 0.0801) << name << axis;
    }
  }
}

TEST(ExplorationScenes, TuningScenesShareNoObjectWithTheReportedOnes) {
  for (const char* name : {"tuning_a", "tuning_b"}) {
    const SceneFile scene = loadScene(name);
    const SceneTruth truth(scene);
    EXPECT_GE(truth.objectNames().size(), 5u);
    EXPECT_TRUE(
        std::ranges::any_of(scene.solids, [](const Solid& s) { return s.role() == SolidRole::Panel; }));
    for (const Wanted& reported : kExploration)
      for (const Sized& sized : reported.objects)
        for (const std::string& object : truth.objectNames())
          EXPECT_GT((sizeOf(scene, object) - sized.size_m).cwiseAbs().maxCoeff(), 0.009) << name << object;
  }
}

TEST(Tabletop, StacksTheJugsOnTheBoxes) {
  const SceneFile scene = loadScene("tabletop");
  EXPECT_NEAR(boundsOf(scene, "jug A").min().z(), boundsOf(scene, "box L").max().z(), 1e-6);
  EXPECT_NEAR(boundsOf(scene, "jug B").min().z(), boundsOf(scene, "box R").max().z(), 1e-6);
  EXPECT_LT(boundsOf(scene, "box L").max().x(), boundsOf(scene, "ball").min().x());
  EXPECT_LT(boundsOf(scene, "ball").max().x(), boundsOf(scene, "box R").min().x());
  double neck = 0.0;  // of jug A, 4.5 cm wide at most
  for (const Solid& solid : scene.solids) {
    if (solid.object() != "jug A" || solid.bounds().sizes().x() < 0.13) continue;  // the body, not the handle
    for (const Eigen::Vector3f& v : solid.mesh().vertices)
      if (const Vector3d p = solid.pose().inverse() * v.cast<double>(); p.z() > 0.165)
        neck = std::max(neck, p.head<2>().norm());
  }
  EXPECT_NEAR(neck, 0.045, 0.001);
}

TEST(Clutter, KeepsWithinSeventyByFiftyCentimetresAndTheBowlIsOpen) {
  const SceneFile scene = loadScene("clutter");
  EXPECT_LE(boundsOf(scene).sizes().x(), 0.70);
  EXPECT_LE(boundsOf(scene).sizes().y(), 0.50);
  const Vector3d middle = boundsOf(scene, "bowl").center();
  for (const Solid& solid : scene.solids) EXPECT_GT(solid.signedDistance(middle), 0.02) << solid.object();
}

TEST(Apart, LeavesFortyCentimetresOfAirBetweenNeighbours) {
  const SceneFile scene = loadScene("apart");
  EXPECT_NEAR(boundsOf(scene, "upper box").min().z(), boundsOf(scene, "lower box").max().z(), 1e-6);
  for (const std::string neighbour : {"jug A", "upper box"}) {
    double gap = 1e9;
    for (const Vector3d& p : test::surfaceSamples(scene, neighbour))
      for (const Solid& solid : scene.solids)
        if (solid.object() == "box") gap = std::min(gap, solid.signedDistance(p));
    EXPECT_NEAR(gap, 0.40, 0.005) << neighbour;
  }
}

/// What a camera sees of a scene: how many pixels show each object, and their depths, every second pixel.
struct Sight {
  std::map<std::string, int> pixels;
  std::map<std::string, Box> points;  ///< in the camera's frame
};
Sight look(const SceneFile& scene, const PinholeCamera& camera, const Pose& T_world_camera) {
  const SceneRays rays(sceneMesh(scene, true));
  std::vector<Eigen::Vector3f> directions;
  for (int v = 0; v < camera.height; v += 2)
    for (int u = 0; u < camera.width; u += 2)
      directions.push_back((T_world_camera.linear() * camera.ray(u, v)).cast<float>());
  std::vector<float> depth_m(directions.size());
  rays.firstHits(T_world_camera.translation().cast<float>(), directions, depth_m);
  Sight sight;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if (!std::isfinite(depth_m[i])) continue;
    const Vector3d p = T_world_camera.translation() + depth_m[i] * directions[i].cast<double>();
    const auto nearest = std::ranges::min_element(
        scene.solids, {}, [&](const Solid& solid) { return std::abs(solid.signedDistance(p)); });
    ++sight.pixels[nearest->object()];
    sight.points[nearest->object()].extend(T_world_camera.inverse() * p);
  }
  return sight;
}

Pose firstPose(const Settings& settings) {
  const std::vector<Pose> poses = initialScanPoses(settings.exploration.scan);
  return poses[poses.size() / 2];
}

TEST(Row, BoxHidesPartsOfJugAndBallFromTheRobotsSide) {
  SceneFile scene = loadScene("row");
  Settings settings;
  applyScene(settings, scene);
  const Sight hidden = look(scene, settings.camera, firstPose(settings));
  std::erase_if(scene.solids, [](const Solid& solid) { return solid.object() == "box on edge"; });
  const Sight free = look(scene, settings.camera, firstPose(settings));
  for (const std::string object : {"jug A", "ball"}) {
    const double share = static_cast<double>(hidden.pixels.at(object)) / free.pixels.at(object);
    EXPECT_GT(share, 0.15) << object;
    EXPECT_LT(share, 0.85) << object;
  }
}

TEST(PlanesScene, ShowsPlanesAtClearDepthStepsInsideTheWorkspace) {
  const SceneFile scene = loadScene("b3_planes");
  Settings settings;
  applyScene(settings, scene);
  const Box workspace = settings.exploration.workspace;
  for (const Solid& solid : scene.solids) {
    EXPECT_EQ(solid.mesh().triangles.size(), 12u) << solid.object();  // a box
    if (solid.role() == SolidRole::Room)
      EXPECT_FALSE(workspace.intersects(solid.bounds()));
    else
      EXPECT_TRUE(workspace.contains(solid.bounds())) << solid.object();
  }
  const Sight sight = look(scene, settings.camera, firstPose(settings));
  int on_planes = 0;
  for (const auto& [object, pixels] : sight.pixels) on_planes += object == "room" ? 0 : 4 * pixels;
  EXPECT_GT(on_planes, 60000);
  const auto nearest = [&](const std::string& object) { return sight.points.at(object).min().z(); };
  for (const std::string object : {"table", "left wall", "right wall", "tall box", "turned box"}) {
    EXPECT_GT(sight.pixels.at(object), 900) << object;  // of every fourth
    EXPECT_GT(nearest(object), 1.2) << object;
    EXPECT_LT(sight.points.at(object).max().z(), 2.7) << object;
  }
  EXPECT_GT(nearest("left wall") - nearest("right wall"), 0.25);
  EXPECT_GT(nearest("right wall") - sight.points.at("tall box").max().z(), 0.2);
  EXPECT_GT(nearest("left wall") - sight.points.at("turned box").max().z(), 0.3);
}

/// Depth along `d` from `eye` of the scene of B4 with its ground and wall unbounded; infinite if nothing is
/// hit.
struct BarDepth {
  double depth_m;
  bool on_bar;
};
BarDepth barDepth(const Vector3d& eye, const Vector3d& d) {
  const double inf = std::numeric_limits<double>::infinity();
  const Vector3d low(-0.04, -0.04, 0.0), high(0.04, 0.04, 1.0);
  const Eigen::Array3d a = (low - eye).array() / d.array(), b = (high - eye).array() / d.array();
  const double enter = a.min(b).maxCoeff(), leave = a.max(b).minCoeff();
  if (enter < leave) return {enter, true};
  const double ground = d.z() < 0 ? -eye.z() / d.z() : inf, wall = d.y() > 0 ? (1.5 - eye.y()) / d.y() : inf;
  return {std::min(ground, wall), false};
}

TEST(BarScene, IsABarBetweenEndlessGroundAndWallInAllFiveViews) {
  const SceneFile scene = loadScene("b4_bar");
  Settings settings;
  applyScene(settings, scene);
  EXPECT_EQ(settings.camera.fx, 365.0);
  EXPECT_EQ(settings.sensor.noise_at_1m_m, 0.0);
  EXPECT_TRUE(firstPose(settings).translation().isApprox(Vector3d(0.0, -1.0, 0.5), 1e-9));
  const SceneRays rays(sceneMesh(scene, true));
  for (const double angle_deg : {-60.0, -30.0, 0.0, 30.0, 60.0}) {
    settings.exploration.scan.initial_azimuth_rad = (angle_deg - 90.0) * std::numbers::pi / 180.0;
    const Pose T_world_camera = firstPose(settings);
    const Vector3d eye = T_world_camera.translation();
    int on_bar = 0, measured = 0;
    for (int v = 0; v < 424; v += 3)
      for (int u = 0; u < 512; u += 3) {
        const Eigen::Vector3f d = (T_world_camera.linear() * settings.camera.ray(u, v)).cast<float>();
        const BarDepth expected = barDepth(eye, d.cast<double>());
        float depth_m = 0.0f;
        rays.firstHits(eye.cast<float>(), {&d, 1}, {&depth_m, 1});
        on_bar += expected.on_bar;
        if (expected.depth_m > 8.0) {
          EXPECT_GT(depth_m, 8.0f);
          continue;
        }
        ++measured;
        ASSERT_NEAR(depth_m, expected.depth_m, 1e-4) << angle_deg << " deg, pixel " << u << " " << v;
      }
    EXPECT_GT(on_bar, 1000);
    EXPECT_GT(measured, 15000);
  }
}

}  // namespace
}  // namespace vantage
