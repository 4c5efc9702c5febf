#include "core/perception/surface_cloud.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <functional>
#include <map>
#include <random>
#include <set>

#include "core/perception/marching_cubes_table.h"
#include "tests/core/perception/half_observed.h"

namespace vantage {
namespace {

using namespace test;

/// Volume of n^3 voxels around the origin with the truncated distance of `sdf`, metres, everywhere observed.
TsdfVolume volumeOf(int n, const std::function<double(const Eigen::Vector3d&)>& sdf, int weight = 20) {
  GridGeometry geometry;
  geometry.voxel_size_m = kVoxel;
  geometry.size = {n, n, n};
  geometry.origin_m = Eigen::Vector3d::Constant(-kVoxel * (n - 1) / 2.0);
  TsdfVolume volume(geometry);
  for (std::size_t i = 0; i < volume.voxels().size(); ++i) {
    volume.voxels()[i] = tsdf(sdf(geometry.center(geometry.voxel(i))) / 0.03, weight);
  }
  return volume;
}

TsdfVolume sphereVolume(double radius_m, int n = 48) {
  return volumeOf(n, [=](const Eigen::Vector3d& p) { return p.norm() - radius_m; });
}

Eigen::Vector3d areaVector(const SurfaceCloud& cloud, const std::array<std::uint32_t, 3>& t) {
  const Eigen::Vector3d a = cloud.points[t[0]].cast<double>();
  return 0.5 * (cloud.points[t[1]].cast<double>() - a).cross(cloud.points[t[2]].cast<double>() - a);
}

/// How often each directed edge occurs.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> directedEdges(const SurfaceCloud& cloud) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : cloud.triangles)
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  return edges;
}

/// Every edge belongs to two triangles that run through it in opposite directions.
void expectClosed(const SurfaceCloud& cloud) {
  const auto edges = directedEdges(cloud);
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_TRUE(edges.contains({edge.second, edge.first}));
  }
}

void expectEveryVertexUsed(const SurfaceCloud& cloud) {
  std::vector<bool> used(cloud.points.size(), false);
  for (const auto& t : cloud.triangles)
    for (const std::uint32_t v : t) used.at(v) = true;
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
}

TEST(MarchingCubesTable, CutsExactlyTheEdgesWithASignChange) {
  for (int inside = 0; inside < 256; ++inside) {
    std::set<int> used;
    const CubeTriangles& cube = marchingCubesTable()[inside];
    for (int k = 0; k < cube.count; ++k) used.insert(cube.triangles[k].begin(), cube.triangles[k].end());
    for (int edge = 0; edge < 12; ++edge) {
      const int a = cubeEdgeStart(edge), b = a | 1 << (edge / 4);
      EXPECT_EQ(used.contains(edge), (inside >> a & 1) != (inside >> b & 1)) << inside << ' ' << edge;
    }
  }
}

TEST(ExtractSurface, SphereVerticesLieOnTheSphere) {
  const SurfaceCloud cloud = extractSurface(sphereVolume(0.09), 5);
  ASSERT_GT(cloud.points.size(), 2000u);
  // Distances along edges are exact to the curvature of the field within one voxel: h^2 / (8 R).
  for (const auto& p : cloud.points) EXPECT_NEAR(p.norm(), 0.09, kVoxel * kVoxel / (8 * 0.09) + 2e-6);
}

TEST(ExtractSurface, SphereNormalsAreRadialUnitVectors) {
  const SurfaceCloud cloud = extractSurface(sphereVolume(0.09), 5);
  ASSERT_EQ(cloud.points.size(), cloud.normals.size());
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    EXPECT_NEAR(cloud.normals[i].norm(), 1.0f, 1e-5f);
    EXPECT_GT(cloud.normals[i].dot(cloud.points[i].normalized()), std::cos(0.2 * 3.14159 / 180));
  }
}

TEST(ExtractSurface, SphereIsClosedAndTurnsOutward) {
  const double radius = 0.09;
  const SurfaceCloud cloud = extractSurface(sphereVolume(radius), 5);
  expectClosed(cloud);
  expectEveryVertexUsed(cloud);
  // Euler characteristic of a sphere: V - E + F = 2, with E = 3 F / 2.
  EXPECT_EQ(2 * cloud.points.size(), cloud.triangles.size() + 4);
  double area = 0.0, volume = 0.0;
  for (const auto& t : cloud.triangles) {
    const Eigen::Vector3d n = areaVector(cloud, t);
    area += n.norm();
    volume += n.dot(cloud.points[t[0]].cast<double>()) / 3.0;
  }
  EXPECT_NEAR(area, 4 * M_PI * radius * radius, 0.005 * area);
  EXPECT_NEAR(volume, 4.0 / 3.0 * M_PI * std::pow(radius, 3), 0.005 * volume);
}

TEST(ExtractSurface, RandomFieldsGiveClosedSurfacesThatUseEveryVertex) {
  // Every configuration of a cell occurs; the outermost layer is empty, so that nothing leaves the volume.
  for (unsigned seed = 0; seed < 3; ++seed) {
    std::mt19937 random(seed);
    TsdfVolume volume = emptyVolume(70, 20, 20, tsdf(1.0, 9));
    for (int k = 1; k < 19; ++k)
      for (int j = 1; j < 19; ++j)
        for (int i = 1; i < 69; ++i) volume.at(i, j, k) = tsdf(random() % 2 ? 0.7 : -0.3, 9);
    const SurfaceCloud cloud = extractSurface(volume, 5);
    ASSERT_GT(cloud.triangles.size(), 10000u);
    expectEveryVertexUsed(cloud);
    // Edges in the plane of a shared face may coincide for two pairs of triangles; each direction still has
    // its reverse.
    const auto edges = directedEdges(cloud);
    for (const auto& [edge, count] : edges) {
      const auto reverse = edges.find({edge.second, edge.first});
      ASSERT_NE(reverse, edges.end());
      ASSERT_EQ(reverse->second, count);
    }
  }
}

TEST(ExtractSurface, TrianglesStayWithinTheirCellsAmongUnderobservedVoxels) {
  std::mt19937 random(11);
  TsdfVolume volume = emptyVolume(70, 20, 20);
  for (TsdfVoxel& v : volume.voxels()) v = tsdf(random() % 2 ? 0.7 : -0.3, random() % 8 ? 9 : 4);
  const SurfaceCloud cloud = extractSurface(volume, 5);
  ASSERT_GT(cloud.triangles.size(), 1000u);
  expectEveryVertexUsed(cloud);
  for (const auto& t : cloud.triangles)
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f side = cloud.points[t[k]] - cloud.points[t[(k + 1) % 3]];
      ASSERT_LE(side.cwiseAbs().maxCoeff(), 1.001 * kVoxel);
      ASSERT_GT(side.norm(), 0.0f);
    }
}

TEST(ExtractSurface, PlaneIsFlatAndFacesTheEmptySide) {
  const Eigen::Vector3d n = Eigen::Vector3d(0.3, -0.2, 0.9).normalized();
  const SurfaceCloud cloud = extractSurface(volumeOf(40, [&](const auto& p) { return n.dot(p) - 0.004; }), 5);
  ASSERT_GT(cloud.points.size(), 1000u);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    EXPECT_NEAR(n.dot(cloud.points[i].cast<double>()), 0.004, 2e-6);
    EXPECT_GT(n.dot(cloud.normals[i].cast<double>()), 0.99999);
  }
  for (const auto& t : cloud.triangles) {
    const Eigen::Vector3d area = areaVector(cloud, t);
    if (area.norm() > 1e-9) {
      EXPECT_GT(area.normalized().dot(n), 0.99);
    }
  }
}

TEST(ExtractSurface, CellsWithAnUnderobservedCornerGiveNothing) {
  TsdfVolume volume = volumeOf(20, [](const auto& p) { return p.z() - 0.001; });
  const SurfaceCloud whole = extractSurface(volume, 5);
  const Eigen::Vector3i hole(7, 9, 10);
  volume.at(hole).weight = 4;
  const SurfaceCloud holed = extractSurface(volume, 5);
  // Four cells of the crossing layer touch the voxel, two triangles each; its own vertical edge is gone.
  EXPECT_EQ(holed.triangles.size(), whole.triangles.size() - 8);
  EXPECT_EQ(holed.points.size(), whole.points.size() - 1);
  const Eigen::Vector3d centre = volume.geometry().center(hole);
  for (const auto& t : holed.triangles)
    for (const std::uint32_t v : t) {
      EXPECT_GT((holed.points[v].cast<double>() - centre).head<2>().norm(), 0.9 * kVoxel);
    }
  EXPECT_EQ(extractSurface(volume, 4).triangles.size(), whole.triangles.size());
}

TEST(ExtractSurface, EndsBeforeTheContourOfTheHalfObservedBox) {
  const SurfaceCloud cloud = extractSurface(referenceBox(), 5);
  ASSERT_FALSE(cloud.points.empty());
  float deepest = 0.0f;
  for (const auto& p : cloud.points) deepest = std::max(deepest, p.z());
  EXPECT_NEAR(deepest, 16 * kVoxel, 1e-6);  // the contour lies at z = 17
}

TEST(ExtractSurface, NormalsAreUnitEvenWhereGradientsCancel) {
  // A sheet one voxel thick, and noise.
  std::mt19937 random(4);
  TsdfVolume volume = emptyVolume(30, 30, 30, tsdf(1.0, 9));
  for (int j = 0; j < 30; ++j)
    for (int i = 0; i < 30; ++i) volume.at(i, j, 15) = tsdf(-1.0, 9);
  for (int n = 0; n < 2000; ++n) {
    volume.at(random() % 30, random() % 30, random() % 30) =
        tsdf(static_cast<int>(random() % 3) - 1.0, random() % 12);
  }
  const SurfaceCloud cloud = extractSurface(volume, 5);
  ASSERT_GT(cloud.points.size(), 1000u);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    EXPECT_TRUE(cloud.points[i].allFinite());
    EXPECT_NEAR(cloud.normals[i].norm(), 1.0f, 1e-5f);
  }
}

TEST(ExtractSurface, IsTheSameForOneAndTwoThreads) {
  const TsdfVolume volume = sphereVolume(0.1);
  std::vector<SurfaceCloud> results;
  for (const int threads : {1, 2, 2}) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(extractSurface(volume, 5));
  }
  for (const SurfaceCloud& other : results) {
    EXPECT_EQ(other.points, results[0].points);
    EXPECT_EQ(other.normals, results[0].normals);
    EXPECT_EQ(other.triangles, results[0].triangles);
  }
}

TEST(ExtractSurface, FindsNothingInAnUnknownEmptyOrFullMap) {
  EXPECT_TRUE(extractSurface(TsdfVolume(), 5).points.empty());
  EXPECT_TRUE(extractSurface(emptyVolume(10, 10, 10), 5).points.empty());
  EXPECT_TRUE(extractSurface(emptyVolume(10, 10, 10, tsdf(1.0, 9)), 5).points.empty());
  EXPECT_TRUE(extractSurface(emptyVolume(10, 10, 10, tsdf(-1.0, 9)), 5).triangles.empty());
}

TEST(ExtractSurface, RefusesAThresholdBelowOne) {
  EXPECT_THROW(extractSurface(emptyVolume(4, 4, 4), 0), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
