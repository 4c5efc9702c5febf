#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <numbers>
#include <random>

#include "io/scene_rays.h"
#include "io/solid.h"

namespace vantage {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

TriangleMesh cubeMesh() {
  return makeBox({0.1, 0.12, 0.2})->mesh();
}

struct Named {
  std::string name;
  ShapePtr shape;
};

std::vector<Named> everyKind() {
  const std::vector<ProfilePoint> jug = {{0, 0},       {0, 0},       {0.05, 0},    {0.05, 0}, {0.07, 0.06},
                                         {0.05, 0.14}, {0.045, 0.2}, {0.045, 0.2}, {0.0, 0.2}};
  const std::vector<ProfilePoint> bowl = {{0.03, 0}, {0.07, 0.03}, {0.09, 0.08}};
  return {
      {"box", makeBox({0.2, 0.1, 0.14})},
      {"sphere", makeSphere(0.08)},
      {"cylinder", makeCone(0.06, 0.06, 0.18)},
      {"frustum", makeCone(0.07, 0.03, 0.1)},
      {"cone", makeCone(0.07, 0.0, 0.1)},
      {"torus", makeTorus(0.08, 0.02, 2 * std::numbers::pi)},
      {"torus section", makeTorus(0.08, 0.02, 2.0)},
      {"lathe", makeLathe(jug, false)},
      {"smooth lathe", makeLathe(jug, true)},
      {"bowl", makeLatheShell(bowl, 0.006, true)},
      {"handle", makeSweep({{0.04, 0, 0.17}, {0.09, 0.01, 0.16}, {0.105, 0, 0.1}, {0.06, 0, 0.06}}, 0.009)},
      {"rod", makeSweep({{0, 0, 0}, {0.1, 0.05, 0.02}}, 0.01)},
      {"mesh", makeMeshShape(cubeMesh())}};
}

class SolidShape : public ::testing::TestWithParam<Named> {};

TEST_P(SolidShape, MeshLiesOnTheZeroOfTheSignedDistance) {
  const TriangleMesh mesh = GetParam().shape->mesh();
  ASSERT_GT(mesh.triangles.size(), 3u);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      double u = share(random), v = share(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vector3d a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>(),
                     c = mesh.vertices[t[2]].cast<double>();
      const Vector3d p = a + u * (b - a) + v * (c - a);
      ASSERT_LT(std::abs(GetParam().shape->signedDistance(p)), 0.0003) << p.transpose();
    }
}

TEST_P(SolidShape, MeshIsClosedAndFacesOutward) {
  const TriangleMesh mesh = GetParam().shape->mesh();
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double volume = 0.0;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    volume += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6.0;
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  EXPECT_GT(volume, 1e-6);
}

TEST_P(SolidShape, SignAgreesWithRayParityAndMagnitudeWithTheMesh) {
  const TriangleMesh mesh = GetParam().shape->mesh();
  const SceneRays rays(mesh);
  Box bounds;
  for (const Vector3f& v : mesh.vertices) bounds.extend(v.cast<double>());
  const Vector3d margin = Vector3d::Constant(0.03);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  int inside = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vector3d size = bounds.sizes() + 2 * margin;
    const Vector3d p =
        bounds.min() - margin + size.cwiseProduct(Vector3d(share(random), share(random), share(random)));
    const double distance = GetParam().shape->signedDistance(p);
    ASSERT_LT(std::abs(distance), rays.distance(p) + 0.0003) << p.transpose();
    if (std::abs(distance) < 0.0005) continue;
    ASSERT_EQ(distance < 0, rays.inside(p)) << p.transpose() << " distance " << distance;
    inside += distance < 0;
    // Outside, the distance is exact.
    if (distance > 0) {
      ASSERT_NEAR(distance, rays.distance(p), 0.0004) << p.transpose();
    }
  }
  EXPECT_GT(inside, 10);
}

INSTANTIATE_TEST_SUITE_P(EveryKind, SolidShape, ::testing::ValuesIn(everyKind()), [](const auto& kind) {
  std::string name = kind.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

TEST(SolidShapes, HaveTheirAnalyticDistances) {
  EXPECT_NEAR(makeBox({0.2, 0.1, 0.14})->signedDistance({0.13, 0.09, 0.07}), 0.05, 1e-12);
  EXPECT_NEAR(makeBox({0.2, 0.1, 0.14})->signedDistance({0, 0, 0.02}), -0.02, 1e-12);
  EXPECT_NEAR(makeSphere(0.08)->signedDistance({0, 0, 0.03}), -0.05, 1e-12);
  EXPECT_NEAR(makeCone(0.06, 0.06, 0.18)->signedDistance({0.09, 0, 0.22}), 0.05, 1e-12);
  EXPECT_NEAR(makeTorus(0.08, 0.02, 2 * std::numbers::pi)->signedDistance({0, 0.08, 0.05}), 0.03, 1e-12);
  // Beyond the ends of a quarter turn the nearer round end counts.
  EXPECT_NEAR(makeTorus(0.1, 0.02, std::numbers::pi / 2)->signedDistance({0.1, -0.05, 0}), 0.03, 1e-12);
  EXPECT_NEAR(makeSweep({{0, 0, 0}, {0.1, 0, 0}}, 0.01)->signedDistance({0.13, 0.04, 0}), 0.04, 1e-12);
}

TEST(SolidShapes, ShellIsHollow) {
  const ShapePtr bowl = makeLatheShell({{0.06, 0}, {0.06, 0.1}}, 0.01, false);
  EXPECT_GT(bowl->signedDistance({0, 0, 0.05}), 0.039);
  EXPECT_LT(bowl->signedDistance({0.055, 0, 0.05}), -0.0049);
  EXPECT_LT(bowl->signedDistance({0, 0, 0.005}), -0.0049);
}

TEST(SolidShapes, RefuseSizesThatMakeNoSolid) {
  EXPECT_THROW(makeBox({0.1, -0.1, 0.1}), std::invalid_argument);
  EXPECT_THROW(makeSphere(0), std::invalid_argument);
  EXPECT_THROW(makeSphere(std::nan("")), std::invalid_argument);
  EXPECT_THROW(makeCone(0, 0, 0.1), std::invalid_argument);
  EXPECT_THROW(makeTorus(0.02, 0.03, 6), std::invalid_argument);
  EXPECT_THROW(makeLathe({{0.1, 0}}, true), std::invalid_argument);
  EXPECT_THROW(makeLathe({{0.1, 0}, {0.1, 0.1}, {0.05, 0.1}, {0.15, 0.0}}, false), std::invalid_argument);
  EXPECT_THROW(makeSweep({{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.005, 0}, {0, 0.005, 0}}, 0.02),
               std::invalid_argument);
  EXPECT_THROW(makeMeshShape({}), std::invalid_argument);
}

TEST(SceneRays, FindFirstHitsAndObstacles) {
  const SceneRays rays(makeBox({2, 2, 1})->mesh());
  const std::vector<Vector3f> directions(11, Vector3f(0, 0, -0.5f));
  std::vector<float> t(directions.size());
  rays.firstHits({0.3f, 0.2f, 3}, directions, t);
  for (const float hit : t) EXPECT_FLOAT_EQ(hit, 4.0f);
  EXPECT_FALSE(rays.segmentFree({0, 0, 2}, {0, 0, 0.5f}));
  EXPECT_TRUE(rays.segmentFree({0, 0, 2}, {0, 0, 1.5f}));
  std::vector<std::uint8_t> seen(2);
  rays.visible({0, 0, 2}, std::vector<Vector3f>{{0, 0, 1}, {0, 0, 0}}, 0.001f, seen);
  EXPECT_THAT(seen, ::testing::ElementsAre(1, 0));
}

}  // namespace
}  // namespace vantage
