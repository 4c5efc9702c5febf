// The recorded tray: our fused surface against the mesh that the authors of the recording made of the same
// frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/perception/surface_cloud.h"
#include "core/volume/tsdf_volume.h"
#include "io/dataset.h"
#include "io/mesh_file.h"
#include "io/scene_rays.h"

namespace vantage {
namespace {

/// The tray stands on the table; what is lower than this belongs to the table.
constexpr float kAboveTable_m = 0.01f;

TEST(Tray, TheFusedSurfaceLiesOnTheAuthorsMesh) {
  const std::string folder = std::string(VANTAGE_TEST_DATA) + "/rgbd_ur5_tray";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "recorded data set not here: " << folder;
  const Dataset dataset = openDataset(folder);
  ASSERT_EQ(dataset.frames.size(), 24u);
  const TriangleMesh mesh = loadMesh(folder + "/object_mesh.obj");
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : mesh.vertices) box.extend(p);

  GridGeometry grid;
  grid.voxel_size_m = 0.004;
  grid.origin_m = box.min().cast<double>().array() - 0.05;
  grid.size = ((box.sizes().cast<double>().array() + 0.1) / grid.voxel_size_m).ceil().cast<int>();
  TsdfVolume volume(grid);
  FusionConfig fusion;
  fusion.truncation_m = 0.02;
  for (std::size_t n = 0; n < dataset.frames.size(); ++n)
    fuseDepth(volume, loadDepth(dataset, n), dataset.camera, dataset.frames[n].T_world_camera, fusion);

  const SceneRays truth(mesh);
  std::vector<double> distances;
  for (const Eigen::Vector3f& p : extractSurface(volume, 5).points)
    if (box.contains(p) && p.z() > box.min().z() + kAboveTable_m)
      distances.push_back(truth.distance(p.cast<double>()));
  ASSERT_GT(distances.size(), 1000u);
  std::sort(distances.begin(), distances.end());
  const double median_mm = distances[distances.size() / 2] * 1e3,
               p95_mm = distances[distances.size() * 95 / 100] * 1e3;
  std::printf("%zu vertices on the tray: median %.1f mm, 95 %% within %.1f mm of the authors' mesh\n",
              distances.size(), median_mm, p95_mm);
  // The poses of the recording err by 5 to 15 mm.
  EXPECT_LT(median_mm, 5.0);
  EXPECT_LT(p95_mm, 15.0);
}

}  // namespace
}  // namespace vantage
