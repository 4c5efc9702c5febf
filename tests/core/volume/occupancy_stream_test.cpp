#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "core/volume/occupancy_octree.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;
using Vector = Eigen::Vector3d;
using Voxel = Eigen::Vector3i;
using Format = OccupancyOctree::Format;

/// Seeded values of all kinds, some not stored, some in pruned nodes.
OccupancyOctree randomMap(unsigned seed, int size = 14) {
  std::mt19937_64 random(seed);
  const GridGeometry g = OccupancyOctree::gridAround(
      Box(Vector(-0.3, -0.5, 0.1), Vector(-0.3, -0.5, 0.1) + Vector::Constant(0.05 * size)), 0.05);
  const Vector third = g.bounds().sizes() / 3;
  OccupancyOctree map(g, Box(g.bounds().min() + third, g.bounds().max() - third), VoxelState::Free, {});
  const std::array<double, 9> p = {0.1192, 0.4, 0.479, 0.481, 0.5, 0.519, 0.521, 0.7, 0.971};
  for (int n = 0; n < 300; ++n) {
    const Voxel v = g.voxel(random() % g.count());
    const std::size_t kind = random() % (p.size() + 1);
    map.set(v, kind < p.size() ? static_cast<float>(logOddsOf(p[kind]))
                               : std::numeric_limits<float>::quiet_NaN());
  }
  return map;
}

std::string written(const OccupancyOctree& map, Format format) {
  std::ostringstream out;
  map.write(out, format);
  return out.str();
}

OccupancyOctree readBack(const std::string& bytes, const std::optional<Box>& bounds = std::nullopt) {
  std::istringstream in(bytes);
  return OccupancyOctree::read(in, bounds, {});
}

void expectRefused(const std::string& bytes, const std::string& part,
                   const std::optional<Box>& bounds = std::nullopt) {
  try {
    readBack(bytes, bounds);
    ADD_FAILURE() << "accepted; expected " << part;
  } catch (const std::exception& e) {
    EXPECT_THAT(e.what(), HasSubstr(part));
  }
}

TEST(OccupancyStream, ProbabilitiesComeBackExactly) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const OccupancyOctree map = randomMap(seed);
    const GridGeometry& g = map.geometry();
    const OccupancyOctree back = readBack(written(map, Format::Ot), g.bounds());
    ASSERT_EQ(back.geometry().size, g.size);
    for (std::size_t n = 0; n < g.count(); ++n) ASSERT_EQ(back.logOdds(g.voxel(n)), map.logOdds(g.voxel(n)));
    EXPECT_EQ(written(back, Format::Ot), written(map, Format::Ot));
  }
}

TEST(OccupancyStream, LabelsComeBackAndUnknownVoxelsAreLeftOut) {  // D-A7
  for (unsigned seed = 0; seed < 5; ++seed) {
    const OccupancyOctree map = randomMap(seed);
    const GridGeometry& g = map.geometry();
    const OccupancyOctree back = readBack(written(map, Format::Bt), g.bounds());
    std::array<int, 3> states{};
    for (std::size_t n = 0; n < g.count(); ++n) {
      const Voxel v = g.voxel(n);
      const VoxelState state = map.label(v, 0);
      ASSERT_EQ(back.label(v, 0), state);
      ASSERT_EQ(back.logOdds(v).has_value(), state != VoxelState::Unknown);
      ++states[static_cast<int>(state)];
    }
    for (const int count : states) EXPECT_GT(count, 50);
    EXPECT_EQ(written(back, Format::Bt), written(map, Format::Bt));
  }
}

TEST(OccupancyStream, OctoMapReadsBothFormatsAndItsInnerNodesHoldTheMaximum) {
  const OccupancyOctree map = randomMap(3);
  const GridGeometry& g = map.geometry();
  octomap::OcTree labels(1.0);
  std::istringstream bt(written(map, Format::Bt));
  ASSERT_TRUE(labels.readBinary(bt));
  std::istringstream ot(written(map, Format::Ot));
  const std::unique_ptr<octomap::AbstractOcTree> any(octomap::AbstractOcTree::read(ot));
  auto* full = dynamic_cast<octomap::OcTree*>(any.get());
  ASSERT_TRUE(full);
  EXPECT_EQ(labels.getResolution(), 0.05);
  for (std::size_t n = 0; n < g.count(); ++n) {
    const Vector p = g.center(g.voxel(n));
    const auto value = map.logOdds(g.voxel(n));
    const octomap::OcTreeNode* node = full->search(p.x(), p.y(), p.z());
    ASSERT_EQ(node != nullptr, value.has_value());
    if (node) {
      ASSERT_EQ(node->getLogOdds(), *value);
    }
    node = labels.search(p.x(), p.y(), p.z());
    const VoxelState state = map.label(g.voxel(n), 0);
    ASSERT_EQ(node != nullptr, state != VoxelState::Unknown);
    if (node) {
      ASSERT_EQ(labels.isNodeOccupied(node), state == VoxelState::Occupied);
    }
  }
  octomap::OcTree updated(*full);
  updated.updateInnerOccupancy();
  EXPECT_TRUE(updated == *full);
  EXPECT_EQ(updated.size(), full->size());
}

TEST(OccupancyStream, ReadsTreesThatOctoMapWrote) {
  octomap::OcTree tree(0.1);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  for (int n = 0; n < 400; ++n)
    tree.updateNode(octomap::point3d(unit(random), unit(random), unit(random)), n % 3 == 0);
  std::stringstream full;
  ASSERT_TRUE(tree.write(full));
  const OccupancyOctree map = OccupancyOctree::read(full, std::nullopt, {});
  std::stringstream binary;
  ASSERT_TRUE(tree.writeBinary(binary));  // turns the tree into labels
  const OccupancyOctree labels = OccupancyOctree::read(binary, std::nullopt, {});
  ASSERT_EQ(map.geometry(), labels.geometry());
  const GridGeometry& g = map.geometry();
  std::size_t stored = 0;
  for (std::size_t n = 0; n < g.count(); ++n) {
    const Vector p = g.center(g.voxel(n));
    const octomap::OcTreeNode* node = tree.search(p.x(), p.y(), p.z());
    const VoxelState state = !node                       ? VoxelState::Unknown
                             : tree.isNodeOccupied(node) ? VoxelState::Occupied
                                                         : VoxelState::Free;
    ASSERT_EQ(labels.label(g.voxel(n), 0), state);
    ASSERT_EQ(map.label(g.voxel(n), 0), state);
    ASSERT_EQ(map.logOdds(g.voxel(n)).has_value(), node != nullptr);
    stored += node != nullptr;
  }
  EXPECT_GT(stored, 300u);
}

TEST(OccupancyStream, GridHasOneUnknownVoxelAroundWhatIsStored) {
  OccupancyOctree map(OccupancyOctree::gridAround(Box(Vector::Zero(), Vector::Constant(1)), 0.05), Box(),
                      VoxelState::Unknown, {});
  map.set({3, 4, 5}, 1.0f);
  map.set({6, 4, 9}, -1.0f);
  const OccupancyOctree back = readBack(written(map, Format::Bt));
  EXPECT_EQ(back.geometry().size, Voxel(6, 3, 7));
  EXPECT_TRUE(back.geometry().bounds().min().isApprox(Vector(0.1, 0.15, 0.2), 1e-9));
  EXPECT_TRUE(back.objectBox().isApprox(back.geometry().bounds()));
  EXPECT_EQ(back.label({1, 1, 1}, 0), VoxelState::Occupied);
  EXPECT_EQ(back.label({4, 1, 5}, 0), VoxelState::Free);
}

TEST(OccupancyStream, BoundsCutAndExtendTheGrid) {
  const OccupancyOctree map = randomMap(1);
  const GridGeometry& g = map.geometry();
  const Box bounds(g.bounds().center(), g.bounds().max() + Vector(0.5, 0.1, 0.2));
  const OccupancyOctree part = readBack(written(map, Format::Ot), bounds);
  EXPECT_TRUE(part.objectBox().isApprox(bounds));
  EXPECT_EQ(part.geometry(), OccupancyOctree::gridAround(bounds, 0.05));
  for (std::size_t n = 0; n < part.geometry().count(); ++n) {
    const Voxel v = part.geometry().voxel(n);
    ASSERT_EQ(part.logOdds(v), map.logOdds(g.voxelAt(part.geometry().center(v))));
  }
  expectRefused(written(map, Format::Ot), "outside the map", Box(Vector(5, 5, 5), Vector(6, 6, 6)));
}

TEST(OccupancyStream, EmptyMapsNeedBounds) {
  const OccupancyOctree map(OccupancyOctree::gridAround(Box(Vector::Zero(), Vector::Constant(1)), 0.05),
                            Box(), VoxelState::Unknown, {});
  for (const Format format : {Format::Ot, Format::Bt}) {
    expectRefused(written(map, format), "give the bounds");
    const OccupancyOctree back = readBack(written(map, format), map.geometry().bounds());
    EXPECT_EQ(back.geometry().size, map.geometry().size);
    EXPECT_EQ(back.nodeCount(), 0u);
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(OccupancyStream, SaysWhatIsWrong) {
  const std::string ot = written(randomMap(1), Format::Ot), bt = written(randomMap(1), Format::Bt);
  for (const std::string& good : {ot, bt}) {
    expectRefused(replaced(good, "id OcTree", "id ColorOcTree"), "'ColorOcTree'");
    expectRefused(replaced(good, "res 0.05", "res 0"), "resolution (res) is 0");
    expectRefused(replaced(good, "res 0.05", "res nan"), "resolution (res) is");
    expectRefused(replaced(good, "res 0.05", "res -1"), "resolution (res) is -1");
    expectRefused(replaced(good, "res 0.05", "res big"), "'big'");
    expectRefused(replaced(good, "size ", "size 9"), "announces 9");
    expectRefused(replaced(good, "id OcTree\n", ""), "'id', 'size' and 'res'");
    expectRefused(replaced(good, "id OcTree\n", "length 5\n"), "'length 5'");
    expectRefused(replaced(good, "# Octomap", "# Oktomap"), "is no OctoMap file");
    expectRefused(good.substr(0, good.size() - 1), "truncated");
    expectRefused(good.substr(0, 50), "header has no end");
    expectRefused(good + "x", "1 bytes follow");
    expectRefused("", "is no OctoMap file");
  }
}

std::string header(bool binary, int nodes) {
  return std::string(binary ? "# Octomap OcTree binary file" : "# Octomap OcTree file") +
         "\nid OcTree\nsize " + std::to_string(nodes) + "\nres 0.05\ndata\n";
}

TEST(OccupancyStream, RefusesTreesDeeperThanSixteenLevels) {
  const auto chain = [](int depth) {  // nodes below the root
    std::string data;
    for (int n = 0; n <= depth; ++n) data += std::string(4, '\0') + (n < depth ? '\1' : '\0');
    return header(false, depth + 1) + data;
  };
  const auto binary_chain = [](int depth) {
    std::string data;
    for (int n = 0; n < depth; ++n) data += std::string(n + 1 < depth ? "\3" : "\2") + '\0';
    return header(true, depth + 1) + data;
  };
  EXPECT_EQ(readBack(chain(16)).nodeCount(), 17u);
  EXPECT_EQ(readBack(binary_chain(16)).nodeCount(), 17u);
  for (const int depth : {17, 18, 100000}) {
    expectRefused(chain(depth), "deeper than 16");
    expectRefused(binary_chain(depth), "deeper than 16");
  }
  expectRefused(header(true, 1) + std::string(2, '\0'), "no children");
  expectRefused(header(false, 1) + std::string("\0\0\xc0\x7f\0", 5), "no finite number");
}

TEST(OccupancyStream, RefusesWhatDoesNotFitInMemory) {
  // One leaf a level below the root: 32768 voxels per axis.
  expectRefused(header(true, 2) + std::string("\2\0", 2), "does not fit in memory");
  // With bounds the rest is left out.
  EXPECT_EQ(readBack(header(true, 2) + std::string("\2\0", 2), Box(Vector(-1, -1, -1), Vector(1, 1, 1)))
                .geometry()
                .size,
            Voxel(40, 40, 40));
}

TEST(OccupancyStream, NoDamageIsMistakenForMoreThanTheFileHolds) {
  std::mt19937_64 random(1);
  for (const Format format : {Format::Ot, Format::Bt}) {
    const std::string good = written(randomMap(2, 8), format);
    const Box bounds(Vector(-1, -1, -1), Vector(1, 1, 1));
    for (std::size_t n = 0; n < good.size(); ++n)
      EXPECT_THROW(readBack(good.substr(0, n), bounds), std::runtime_error) << n;
    int accepted = 0, refused = 0;
    for (int n = 0; n < 6000; ++n) {
      std::string bad = good;
      for (int flips = 1 + static_cast<int>(random() % 3); flips > 0; --flips)
        bad[random() % bad.size()] ^= static_cast<char>(1 << random() % 8);
      try {
        const OccupancyOctree map = readBack(bad, bounds);
        EXPECT_LE(map.nodeCount(), 100000u);
        ++accepted;
      } catch (const std::exception& e) {
        EXPECT_STRNE(e.what(), "");
        ++refused;
      }
    }
    EXPECT_GT(accepted, 50);
    EXPECT_GT(refused, 1000);
  }
}

TEST(OccupancyStream, RealMapsHaveTheirKnownVolumes) {
  const std::filesystem::path folder = std::filesystem::path(VANTAGE_TEST_DATA) / "octomap";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "recorded maps not here: " << folder;
  const auto volumes = [&](const char* name) {
    std::ifstream in(folder / name, std::ios::binary);
    const OccupancyOctree map = OccupancyOctree::read(in, std::nullopt, {});
    std::array<double, 3> sum{};
    std::vector<float> values;
    const OccupancyBand band(map.config());
    const double voxel = std::pow(map.geometry().voxel_size_m, 3);
    for (std::uint32_t b = 0; b < map.bricks().total(); ++b) {
      const BrickRange r = map.bricks().range(b);
      values.resize((r.end - r.begin).prod());
      map.readBrick(b, values);
      for (const float value : values) sum[static_cast<int>(band.label(value))] += voxel;
    }
    return std::make_pair(sum, map.nodeCount());
  };
  const auto [corridor, nodes] = volumes("geb079.bt");
  EXPECT_NEAR(corridor[2], 95.0646, 1e-3);
  EXPECT_NEAR(corridor[1], 486.7886, 1e-3);
  EXPECT_EQ(nodes, 532566u);
  EXPECT_NEAR(volumes("box_2m.bt").first[2], 8.0, 1e-9);
}

}  // namespace
}  // namespace vantage
