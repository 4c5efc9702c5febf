#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <map>
#include <random>

#include "core/volume/occupancy_octree.h"

namespace vantage {
namespace {

using Vector = Eigen::Vector3d;
using Voxel = Eigen::Vector3i;

constexpr double kVoxel_m = 0.04;

PinholeCamera camera() {
  PinholeCamera c = cameraFromFov(64, 48, 1.5);
  c.min_range_m = 0.1;
  c.max_range_m = 6.0;
  return c;
}

GridGeometry room() {
  return OccupancyOctree::gridAround(Box(Vector(-1.0, -0.9, -0.1), Vector(1.1, 0.8, 1.3)), kVoxel_m);
}

/// Depth of the inside of a box as the camera sees it, with noise, holes and far values.
DepthImage randomDepth(std::mt19937_64& random, const PinholeCamera& c, const Pose& pose) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const Box walls(Vector(-0.8, -0.7, 0.0) - Vector::Constant(unit(random)), Vector(0.9, 0.6, 1.1));
  const bool inside = walls.contains(pose.translation());
  DepthImage image(c.width, c.height);
  for (int v = 0; v < c.height; ++v)
    for (int u = 0; u < c.width; ++u) {
      const Vector d = pose.linear() * c.ray(u, v);
      double z = inside ? 9.0 : 1.2;
      for (int a = 0; inside && a < 3; ++a)
        z = std::min(z, ((d[a] > 0 ? walls.max()[a] : walls.min()[a]) - pose.translation()[a]) / d[a]);
      image.at(u, v) = static_cast<float>(z * (1 + 0.02 * unit(random)));
      if (unit(random) < 0.05) image.at(u, v) = unit(random) < 0.5 ? DepthImage::kInvalid : 5.0f;
    }
  return image;
}

Pose randomPose(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Vector eye = Vector(0.05, 0, 0.6) + 0.5 * Vector(unit(random), unit(random), unit(random));
  return lookAlong(eye, Vector(unit(random), unit(random), 0.5 * unit(random)), 3 * unit(random));
}

/// From outside the grid into it.
Pose outerPose(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Vector direction(unit(random), unit(random), unit(random));
  return lookAt(Vector(0, 0, 0.6) + 1.8 * direction.normalized(), Vector(0.1 * unit(random), 0, 0.6));
}

/// Voxels that a segment crosses, from the sorted crossings of all planes: the midpoint of each piece.
std::vector<Voxel> crossedVoxels(const GridGeometry& g, const Vector& from, const Vector& to) {
  const Vector a = g.toGrid(from).array() + 0.5, b = g.toGrid(to).array() + 0.5;
  std::vector<double> cuts = {0.0, 1.0};
  for (int axis = 0; axis < 3; ++axis)
    for (double plane = std::ceil(std::min(a[axis], b[axis])); plane <= std::max(a[axis], b[axis]); ++plane)
      cuts.push_back((plane - a[axis]) / (b[axis] - a[axis]));
  std::sort(cuts.begin(), cuts.end());
  std::vector<Voxel> voxels;
  for (std::size_t n = 0; n + 1 < cuts.size(); ++n)
    if (cuts[n + 1] - cuts[n] > 1e-12) {
      const Eigen::Array3d p = a + (cuts[n] + cuts[n + 1]) / 2 * (b - a);
      voxels.push_back(p.floor().matrix().cast<int>());
    }
  return voxels;
}

/// One scan by OctoMap's own update, voxel by voxel.
class Naive {
 public:
  explicit Naive(const OccupancyConfig& config) : config_(config), tree(kVoxel_m) {
    tree.setProbHit(config.hit_probability);
    tree.setProbMiss(config.miss_probability);
    tree.setClampingThresMin(config.clamp_min);
    tree.setClampingThresMax(config.clamp_max);
  }
  octomap::OcTreeKey key(const GridGeometry& g, const Voxel& v) const {
    const Vector p = g.center(v);
    return tree.coordToKey(p.x(), p.y(), p.z());
  }
  void insert(const GridGeometry& g, const DepthImage& depth, const PinholeCamera& c, const Pose& pose) {
    std::map<std::array<int, 3>, bool> marks;
    for (int v = 0; v < c.height; ++v)
      for (int u = 0; u < c.width; ++u) {
        const float z = depth.at(u, v);
        if (!DepthImage::valid(z) || z < c.min_range_m || z > c.max_range_m) continue;
        const Vector ray = c.ray(u, v), from = pose.translation();
        const double length = ray.norm() * z;
        const bool beyond = length > config_.insert_range_m;
        const Vector to = pose * Vector(ray * z * (beyond ? config_.insert_range_m / length : 1.0));
        std::vector<Voxel> voxels = crossedVoxels(g, from, to);
        const Voxel last = voxels.back();
        voxels.pop_back();
        for (const Voxel& x : voxels)
          if (g.contains(x)) marks.try_emplace({x.x(), x.y(), x.z()}, false);
        if (!beyond && g.contains(last)) marks[{last.x(), last.y(), last.z()}] = true;
      }
    for (const auto& [v, hit] : marks) {
      tree.updateNode(key(g, {v[0], v[1], v[2]}), hit);
      ++(hit ? hits : misses);
    }
  }

  OccupancyConfig config_;
  octomap::OcTree tree;
  std::uint64_t hits = 0, misses = 0;
};

TEST(OccupancyInsert, EqualsOctoMapsUpdateOfEveryVoxel) {
  for (const VoxelState outside : {VoxelState::Unknown, VoxelState::Free}) {
    std::mt19937_64 random(21);
    OccupancyConfig config;
    config.insert_range_m = 1.5;
    const GridGeometry g = room();
    const Box object(Vector(-0.3, -0.2, 0.1), Vector(0.2, 0.3, 0.7));
    OccupancyOctree map(g, object, outside, config);
    Naive naive(config);
    for (std::size_t n = 0; n < g.count(); ++n)
      if (const auto value = map.logOdds(g.voxel(n)))
        naive.tree.setNodeValue(naive.key(g, g.voxel(n)), *value);
    std::uint64_t settled = 0, hits = 0;
    for (int scan = 0; scan < 40; ++scan) {
      const Pose pose = scan % 5 == 4 ? outerPose(random) : randomPose(random);
      const DepthImage depth = randomDepth(random, camera(), pose);
      naive.hits = naive.misses = 0;
      naive.insert(g, depth, camera(), pose);
      std::vector<std::optional<float>> before(g.count());
      for (std::size_t n = 0; n < g.count(); ++n) before[n] = map.logOdds(g.voxel(n));
      const OccupancyUpdate update = map.insert(depth, camera(), pose);
      ASSERT_EQ(update.hits, naive.hits);
      ASSERT_EQ(update.misses, naive.misses);
      std::uint64_t updated = 0;
      BrickSet changed(map.bricks().total());
      for (std::size_t n = 0; n < g.count(); ++n) {
        const Voxel v = g.voxel(n);
        const auto value = map.logOdds(v);
        const octomap::OcTreeNode* node = naive.tree.search(naive.key(g, v));
        ASSERT_EQ(value.has_value(), node != nullptr) << "scan " << scan << " voxel " << v.transpose();
        if (node) {
          ASSERT_EQ(*value, node->getLogOdds()) << "scan " << scan << " voxel " << v.transpose();
        }
        if (value != before[n]) {
          ++updated;
          changed.insert(map.bricks().brickOf(v));
        }
      }
      ASSERT_EQ(update.updated, updated);
      ASSERT_EQ(update.changed.list(), changed.list());
      settled += update.hits + update.misses - update.updated;
      hits += update.hits;
    }
    EXPECT_GT(settled, 10000u);  // the shortcut had something to do
    EXPECT_GT(hits, 1000u);
  }
}

TEST(OccupancyInsert, SameForAnyNumberOfThreads) {
  std::vector<std::string> results;
  for (const int threads : {1, 2, 5}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    std::mt19937_64 random(4);
    OccupancyOctree map(room(), Box(Vector(-0.3, -0.2, 0.1), Vector(0.2, 0.3, 0.7)), VoxelState::Unknown, {});
    std::ostringstream result;
    for (int scan = 0; scan < 6; ++scan) {
      const Pose pose = randomPose(random);
      const OccupancyUpdate update = map.insert(randomDepth(random, camera(), pose), camera(), pose);
      result << update.hits << ' ' << update.misses << ' ' << update.updated << ' '
             << update.changed.list().size() << '\n';
    }
    map.write(result, OccupancyOctree::Format::Ot);
    results.push_back(result.str());
  }
  EXPECT_GT(results[0].size(), 10000u);
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

/// One pixel that looks along +x from the origin.
struct OnePixel {
  PinholeCamera camera;
  Pose pose = lookAlong(Vector(0.0, 0.02, 0.02), Vector::UnitX());
  OccupancyOctree map{
      OccupancyOctree::gridAround(Box(Vector(-0.4, -0.4, -0.4), Vector(4, 0.4, 0.4)), kVoxel_m), Box(),
      VoxelState::Unknown, OccupancyConfig{}};

  OnePixel() {
    camera.width = camera.height = 1;
    camera.cx = camera.cy = 0.0;
    camera.min_range_m = 0.1;
    camera.max_range_m = 8.0;
  }
  OccupancyUpdate see(float depth_m) {
    DepthImage image(1, 1);
    image.at(0, 0) = depth_m;
    return map.insert(image, camera, pose);
  }
  std::optional<float> at(double x) const { return map.logOdds(map.geometry().voxelAt({x, 0.02, 0.02})); }
};

TEST(OccupancyInsert, MeasurementsBeyondTheRangeClearTheWayAndMarkNothing) {
  const float miss = static_cast<float>(logOddsOf(0.4)), hit = static_cast<float>(logOddsOf(0.7));
  OnePixel near, far, nowhere;
  EXPECT_EQ(near.see(2.7f).hits, 1u);
  EXPECT_EQ(near.at(2.66), miss);
  EXPECT_EQ(near.at(2.7), hit);
  EXPECT_EQ(near.at(2.74), std::nullopt);
  EXPECT_EQ(far.see(3.5f).hits, 0u);
  EXPECT_EQ(far.at(2.74), miss);
  EXPECT_EQ(far.at(2.86), std::nullopt);
  EXPECT_EQ(far.at(3.5), std::nullopt);
  for (const float invalid :
       {DepthImage::kInvalid, 0.0f, -1.0f, 0.05f, 8.1f, std::numeric_limits<float>::infinity()}) {
    const OccupancyUpdate update = nowhere.see(invalid);
    EXPECT_EQ(update.hits + update.misses, 0u) << invalid;
    EXPECT_TRUE(update.changed.empty()) << invalid;
  }
  EXPECT_EQ(nowhere.map.nodeCount(), 0u);
}

TEST(OccupancyInsert, ReachesTheClampsAfterFiveScans) {
  OnePixel pixel;
  const OccupancyConfig config;
  for (int n = 0; n < 5; ++n) EXPECT_GT(pixel.see(1.0f).updated, 0u);
  EXPECT_EQ(pixel.at(1.0), static_cast<float>(logOddsOf(config.clamp_max)));
  EXPECT_EQ(pixel.at(0.5), static_cast<float>(logOddsOf(config.clamp_min)));
  const OccupancyUpdate settled = pixel.see(1.0f);
  EXPECT_EQ(settled.updated, 0u);
  EXPECT_EQ(settled.hits, 1u);
  EXPECT_EQ(settled.misses, 25u);  // 0 .. 1 m
  EXPECT_TRUE(settled.changed.empty());
}

TEST(OccupancyInsert, HitsWinOverMisses) {
  // A slanted wall: rays to its far part pass voxels in which others end.
  std::mt19937_64 random(2);
  const PinholeCamera c = camera();
  OccupancyOctree map(room(), Box(), VoxelState::Unknown, {});
  const Pose pose = lookAlong(Vector(-0.9, 0.0, 0.6), Vector(1, 0.15, 0));
  DepthImage depth(c.width, c.height);
  for (int v = 0; v < c.height; ++v)
    for (int u = 0; u < c.width; ++u) depth.at(u, v) = static_cast<float>(0.7 + 0.5 * u / c.width);
  const OccupancyUpdate update = map.insert(depth, c, pose);
  std::uint64_t occupied = 0;
  for (int v = 0; v < c.height; ++v)
    for (int u = 0; u < c.width; ++u) {
      const Voxel end = map.geometry().voxelAt(pose * Vector(c.ray(u, v) * depth.at(u, v)));
      if (!map.geometry().contains(end)) continue;
      ASSERT_EQ(map.label(end, 0), VoxelState::Occupied);
      ++occupied;
    }
  EXPECT_GT(occupied, 1000u);
  EXPECT_GT(update.hits, 300u);
}

TEST(OccupancyInsert, RefusesAnImageOfAnotherSizeAndAPoseThatIsNotFinite) {
  OccupancyOctree map(room(), Box(), VoxelState::Unknown, {});
  EXPECT_THROW(map.insert(DepthImage(3, 3), camera(), Pose::Identity()), std::invalid_argument);
  Pose pose = Pose::Identity();
  pose.translation().x() = DepthImage::kInvalid;
  EXPECT_THROW(map.insert(DepthImage(64, 48), camera(), pose), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
