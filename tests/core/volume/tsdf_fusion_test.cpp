#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <random>

#include "core/volume/fusion_paths.h"
#include "core/volume/tsdf_volume.h"

namespace vantage {
namespace {

GridGeometry smallGeometry() {
  return {Eigen::Vector3d(-0.3, -0.25, -0.2), 0.01, Eigen::Vector3i(61, 45, 43)};
}

PinholeCamera smallCamera() {
  PinholeCamera camera;
  camera.width = 101;
  camera.height = 83;
  camera.fx = 90;
  camera.fy = 85;
  camera.cx = 49.3;
  camera.cy = 41.8;
  camera.min_range_m = 0.2;
  camera.max_range_m = 1.4;
  return camera;
}

/// Smooth depth with steps, holes and values outside the range limits.
DepthImage randomDepth(std::mt19937_64& random, const PinholeCamera& camera) {
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  DepthImage image(camera.width, camera.height);
  const float base = 0.3f + 0.8f * unit(random), slope_u = 0.004f * (unit(random) - 0.5f),
              slope_v = 0.004f * (unit(random) - 0.5f);
  const int step_at = static_cast<int>(unit(random) * camera.width);
  const bool smooth = random() % 2 == 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      image.at(u, v) = base + slope_u * u + slope_v * v + (u > step_at ? 0.2f : 0.0f);
      if (!smooth && unit(random) < 0.05f) image.at(u, v) = unit(random) < 0.7f ? DepthImage::kInvalid : 2.0f;
    }
  const int hole = static_cast<int>(random() % 40);
  for (int v = hole; v < hole + 20; ++v)
    for (int u = hole; u < hole + 15; ++u) image.at(u, v) = DepthImage::kInvalid;
  return image;
}

Pose randomPose(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Eigen::Vector3d eye(0.8 * unit(random), 0.8 * unit(random), 0.8 * unit(random));
  return lookAt(eye, 0.2 * Eigen::Vector3d(unit(random), unit(random), unit(random)), 3 * unit(random));
}

bool sameVoxels(const TsdfVolume& a, const TsdfVolume& b) {
  return std::equal(a.voxels().begin(), a.voxels().end(), b.voxels().begin(), b.voxels().end());
}

TEST(FuseDepth, EveryPathAndThreadCountAgreesBitForBitWithTheReference) {
  const PinholeCamera camera = smallCamera();
  for (const CpuPath path : availableCpuPaths())
    for (const int threads : {1, 2, 5}) {
      SCOPED_TRACE(::testing::Message() << "path " << static_cast<int>(path) << ", threads " << threads);
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      std::mt19937_64 random(3);
      TsdfVolume fast(smallGeometry()), plain(smallGeometry());
      FusionConfig config;
      config.max_weight = 12;
      std::uint64_t updated = 0, changed = 0;
      for (int n = 0; n < 30; ++n) {
        config.observations_per_frame = 1 + n % 3;
        const DepthImage depth = randomDepth(random, camera);
        const Pose pose = randomPose(random);
        FusionResult a = fusion::fuseDepthOn(path, fast, depth, camera, pose, config);
        FusionResult b = fuseDepthReference(plain, depth, camera, pose, config);
        ASSERT_EQ(a.voxels_updated, b.voxels_updated) << "frame " << n;
        ASSERT_EQ(a.changed.list(), b.changed.list()) << "frame " << n;
        ASSERT_TRUE(sameVoxels(fast, plain)) << "frame " << n;
        updated += b.voxels_updated;
        changed += b.changed.list().size();
      }
      EXPECT_GT(updated, 300000u);
      EXPECT_GT(changed, 500u);
    }
}

/// A wall at z = `depth_m` seen along +z from the origin.
DepthImage wall(const PinholeCamera& camera, float depth_m) {
  DepthImage image(camera.width, camera.height);
  std::fill(image.depth_m.begin(), image.depth_m.end(), depth_m);
  return image;
}

TEST(FuseDepth, PlaneHasTheDistanceAlongTheRay) {
  const PinholeCamera camera;
  TsdfVolume volume({Eigen::Vector3d(-0.2, -0.2, 0.6), 0.01, Eigen::Vector3i(41, 41, 41)});
  FusionConfig config;
  config.truncation_m = 0.05;
  const FusionResult result = fuseDepth(volume, wall(camera, 0.8f), camera, Pose::Identity(), config);
  std::uint64_t seen = 0;
  const GridGeometry& g = volume.geometry();
  for (std::size_t n = 0; n < g.count(); ++n) {
    const Eigen::Vector3d p = g.center(g.voxel(n));
    const TsdfVoxel voxel = volume.voxels()[n];
    const double sdf = p.norm() * (0.8 / p.z() - 1.0);  // up to the slant of half a pixel
    if (sdf < -0.051) {
      EXPECT_EQ(voxel.weight, 0);
    }
    if (sdf < -0.049) continue;
    ++seen;
    ASSERT_EQ(voxel.weight, 1);
    EXPECT_NEAR(voxel.distance(), std::min(1.0, sdf / 0.05), 0.0125);
    if (std::abs(sdf) > 7e-4) {
      EXPECT_EQ(voxel.state(), sdf > 0 ? VoxelState::Free : VoxelState::Occupied);
    }
  }
  EXPECT_GT(seen, 40000u);
  EXPECT_NEAR(static_cast<double>(result.voxels_updated), static_cast<double>(seen), 2000.0);
}

TEST(FuseDepth, InvalidDepthUpdatesNothing) {
  const PinholeCamera camera = smallCamera();
  for (const float depth :
       {DepthImage::kInvalid, 0.0f, -1.0f, 0.19f, 1.41f, std::numeric_limits<float>::infinity()}) {
    TsdfVolume volume(smallGeometry());
    const FusionResult result =
        fuseDepth(volume, wall(camera, depth), camera, lookAt({0, -0.7, 0}, {0, 0, 0}), FusionConfig{});
    EXPECT_EQ(result.voxels_updated, 0u) << depth;
    EXPECT_TRUE(result.changed.empty()) << depth;
    EXPECT_TRUE(sameVoxels(volume, TsdfVolume(smallGeometry()))) << depth;
  }
}

TEST(FuseDepth, WeightGrowsByObservationsUpToItsLimit) {
  const PinholeCamera camera = smallCamera();
  TsdfVolume volume(smallGeometry());
  FusionConfig config;
  config.observations_per_frame = 10;
  config.max_weight = 25;
  const Pose pose = lookAt({0, -0.7, 0}, {0, 0, 0});
  const Eigen::Vector3i in_front = volume.geometry().voxelAt({0, -0.2, 0});
  for (const int weight : {10, 20, 25, 25}) {
    const FusionResult result = fuseDepth(volume, wall(camera, 0.8f), camera, pose, config);
    EXPECT_EQ(volume.at(in_front).weight, weight);
    EXPECT_EQ(volume.at(in_front).value, 32767);
    EXPECT_TRUE(result.changed.empty() || weight < 25 || volume.at(in_front).weight == 25);
  }
  EXPECT_TRUE(fuseDepth(volume, wall(camera, 0.8f), camera, pose, config).changed.empty());
}

TEST(FuseDepth, MeanOfTwoObservationsWeighsThem) {
  const PinholeCamera camera = smallCamera();
  TsdfVolume volume(smallGeometry());
  FusionConfig config;
  config.truncation_m = 0.1;
  const Pose pose = lookAt({0, -0.7, 0}, {0, 0, 0});
  const Eigen::Vector3i voxel = volume.geometry().voxelAt({0, 0, 0});  // range 0.7
  config.observations_per_frame = 3;
  fuseDepth(volume, wall(camera, 0.72f), camera, pose, config);
  const double first = volume.at(voxel).distance();
  config.observations_per_frame = 1;
  fuseDepth(volume, wall(camera, 0.68f), camera, pose, config);
  EXPECT_NEAR(first, 0.2, 0.01);
  EXPECT_NEAR(volume.at(voxel).distance(), (3 * first + first - 0.4) / 4, 1e-3);
}

TEST(FuseDepth, RefusesAnImageOfAnotherSizeAndBadParameters) {
  TsdfVolume volume(smallGeometry());
  const PinholeCamera camera = smallCamera();
  EXPECT_THROW(fuseDepth(volume, DepthImage(3, 3), camera, Pose::Identity(), {}), std::invalid_argument);
  FusionConfig config;
  config.truncation_m = 0.02;  // below 2.1 voxels
  EXPECT_THROW(fuseDepth(volume, wall(camera, 1), camera, Pose::Identity(), config), std::invalid_argument);
  config = {};
  config.max_weight = 60001;
  EXPECT_THROW(fuseDepth(volume, wall(camera, 1), camera, Pose::Identity(), config), std::invalid_argument);
  Pose nowhere = Pose::Identity();
  nowhere.translation().x() = DepthImage::kInvalid;
  EXPECT_THROW(fuseDepth(volume, wall(camera, 1), camera, nowhere, {}), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
