#include "tests/io/run_support.h"

namespace vantage::testing {
namespace {

template <class T>
std::shared_ptr<T> randomValue(Randomizer& random) {
  auto value = std::make_shared<T>();
  random(*value);
  return value;
}

template <class T>
Bytes bytesOf(const T& value) {
  ByteWriter writer;
  writer(value);
  return writer.take();
}

/// Empty bytes for a product that is not there, else what is in it.
template <class T>
Bytes bytesOf(const std::shared_ptr<const T>& product) {
  if (!product) return {};
  ByteWriter writer;
  writer.scalar(true);
  writer(*product);
  return writer.take();
}

void limit(std::uint32_t& index, std::size_t count) {
  index %= static_cast<std::uint32_t>(count);
}

std::shared_ptr<std::vector<TsdfBrick>> randomBricks(Randomizer& random) {
  const BrickLayout layout(testGrid().size);
  auto bricks = std::make_shared<std::vector<TsdfBrick>>();
  for (std::uint32_t b = 0; b < layout.total(); ++b) {
    if (random.random()() % 3 == 0) continue;
    const BrickRange range = layout.range(b);
    TsdfBrick brick{b, std::vector<TsdfVoxel>((range.end - range.begin).prod())};
    for (TsdfVoxel& voxel : brick.voxels) {
      random.scalar(voxel.value);
      random.scalar(voxel.weight);
    }
    bricks->push_back(std::move(brick));
  }
  return bricks;
}

std::shared_ptr<ViewSearch> randomSearch(Randomizer& random, std::size_t points, std::size_t segments) {
  auto search = randomValue<ViewSearch>(random);
  int number = -1;
  for (SegmentSearch& s : search->segments) {
    s.segment = std::min<int>(number++, static_cast<int>(segments) - 1);
    for (std::uint32_t& p : s.contour_points) limit(p, points);
    for (PoseScore& p : s.scores) p.histogram = p.id % (s.histograms.size() + 1) - 1;
  }
  limit(search->chosen->search, search->segments.size());
  limit(search->chosen->contour_point, points);
  limit(search->chosen->rank, search->segments[search->chosen->search].scores.size());
  return search;
}

}  // namespace

namespace {

JointVector randomJoints(Randomizer& random) {
  JointVector q(6);
  for (double& value : q) random(value);
  return q;
}

/// Six joints, and bodies on some of them.
ArmHeader randomArm(Randomizer& random) {
  ArmHeader arm;
  random(arm.model.name, arm.T_world_base, arm.clear_boxes, arm.model.T_tip_camera, arm.model.camera_link);
  arm.model.joints.resize(6);
  for (ArmJoint& joint : arm.model.joints) random(joint);
  arm.model.shapes.resize(3);
  for (LinkShape& shape : arm.model.shapes) {
    random(shape);
    shape.frame = static_cast<int>(random.random()() % 7) - 1;
  }
  return arm;
}

}  // namespace

RunHeader randomHeader(std::uint64_t seed) {
  Randomizer random(seed);
  RunHeader header;
  random(header, header.truth);
  header.volume = testGrid();
  header.arm = randomArm(random);
  header.octree.emplace();  // values in range: a reader checks them
  header.octree->planner.coarse_levels = 3;
  header.octree->map.voxel_size_m = 0.02;
  header.octree->map.known_scene = true;
  header.octree->object_box = Box(Eigen::Vector3d(-0.1, -0.1, 0.1), Eigen::Vector3d(0.1, 0.1, 0.2));
  header.truth.colors.resize(header.truth.triangles.size());
  for (auto& t : header.truth.triangles)
    for (std::uint32_t& corner : t) limit(corner, header.truth.vertices.size());
  return header;
}

StepRecord randomRecord(std::uint64_t seed, int step, bool closing) {
  Randomizer random(seed);
  StepRecord record;
  random(record);
  record.step = step;
  record.closing = closing;
  record.stage = Stage::Done;
  if (!closing) random.optional(record.realised_voxels);
  auto depth = randomValue<DepthFrame>(random);
  depth->depth = DepthImage(31, 17);
  for (std::size_t i = 0; i < depth->depth.depth_m.size(); i += 2) random(depth->depth.depth_m[i]);
  record.depth = depth;
  auto filtered = std::make_shared<FilteredDepth>(FilteredDepth{depth->depth, {}});
  filtered->mask.resize(depth->depth.depth_m.size());
  for (std::uint8_t& reason : filtered->mask) random(reason);
  record.filtered = filtered;
  auto joints = std::make_shared<std::vector<JointVector>>();
  for (std::size_t f = 0; f < record.scan.size(); ++f) joints->push_back(randomJoints(random));
  record.joints = joints;
  auto trajectory = std::make_shared<JointTrajectory>();
  for (int p = 0; p < 4; ++p) {
    trajectory->time_s.push_back(p);
    trajectory->positions.push_back(randomJoints(random));
    trajectory->velocities.push_back(randomJoints(random));
  }
  record.trajectory = trajectory;
  record.changed_bricks = randomBricks(random);

  auto contours = randomValue<Contours>(random);
  for (ContourVoxel& v : contours->voxels) limit(v.group, contours->points.size());
  auto surface = randomValue<SurfaceCloud>(random);
  surface->normals.resize(surface->points.size(), Eigen::Vector3f::UnitX());
  for (auto& t : surface->triangles)
    for (std::uint32_t& corner : t) limit(corner, surface->points.size());
  auto labels = randomValue<Labels>(random);
  labels->count = 7;
  for (std::uint32_t& l : labels->of_point) limit(l, 8);
  auto positions = randomValue<std::vector<ViewPosition>>(random);
  for (ViewPosition& p : *positions) limit(p.group, contours->points.size());
  record.saliency = randomValue<Saliency>(random);
  record.point_labels = randomValue<std::vector<std::uint32_t>>(random);
  record.search = randomSearch(random, contours->points.size(), record.saliency->segments.size());
  auto utilities = randomValue<UtilitySearch>(random);
  for (std::uint32_t& n : utilities->ranking) limit(n, utilities->views.size());
  record.utilities = utilities;
  record.box = randomValue<BoxMetrics>(random);
  auto octree = std::make_shared<std::vector<OctreeBrick>>();
  for (std::uint32_t brick = 0; brick < 3; ++brick) {
    octree->push_back({brick * 2, std::vector<float>(7 + 5 * brick, std::nanf(""))});
    random(octree->back().log_odds[brick]);
  }
  record.changed_octree_bricks = octree;
  record.contours = contours;
  record.surface = surface;
  record.labels = labels;
  record.positions = positions;
  return record;
}

/// NaN, i.e. a voxel that is not stored, equals NaN.
static bool octreeEqual(const StepRecord& a, const StepRecord& b) {
  if (!a.changed_octree_bricks || !b.changed_octree_bricks)
    return !a.changed_octree_bricks == !b.changed_octree_bricks;
  return std::ranges::equal(*a.changed_octree_bricks, *b.changed_octree_bricks,
                            [](const auto& x, const auto& y) {
                              return x.brick == y.brick && bytesOf(x.log_odds) == bytesOf(y.log_odds);
                            });
}

void expectEqual(const StepRecord& a, const StepRecord& b) {
  EXPECT_EQ(bytesOf(a), bytesOf(b)) << "scalars, scan, metrics, served or timings";
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.closing, b.closing);
  EXPECT_EQ(a.stage, b.stage);
  EXPECT_EQ(a.planner, b.planner);
  EXPECT_EQ(a.realised_voxels, b.realised_voxels);
  EXPECT_EQ(bytesOf(a.depth), bytesOf(b.depth)) << "depth";
  EXPECT_EQ(bytesOf(a.filtered), bytesOf(b.filtered)) << "filtered";
  EXPECT_EQ(bytesOf(a.joints), bytesOf(b.joints)) << "joints";
  EXPECT_EQ(bytesOf(a.trajectory), bytesOf(b.trajectory)) << "trajectory";
  EXPECT_EQ(bytesOf(a.contours), bytesOf(b.contours)) << "contours";
  EXPECT_EQ(bytesOf(a.surface), bytesOf(b.surface)) << "surface";
  EXPECT_EQ(bytesOf(a.labels), bytesOf(b.labels)) << "labels";
  EXPECT_EQ(bytesOf(a.saliency), bytesOf(b.saliency)) << "saliency";
  EXPECT_EQ(bytesOf(a.point_labels), bytesOf(b.point_labels)) << "point labels";
  EXPECT_EQ(bytesOf(a.positions), bytesOf(b.positions)) << "positions";
  EXPECT_EQ(bytesOf(a.search), bytesOf(b.search)) << "search";
  EXPECT_EQ(bytesOf(a.utilities), bytesOf(b.utilities)) << "utilities";
  EXPECT_EQ(bytesOf(a.box), bytesOf(b.box)) << "box";
  EXPECT_TRUE(octreeEqual(a, b)) << "octree bricks";
  ASSERT_EQ(a.changed_bricks == nullptr, b.changed_bricks == nullptr);
  if (!a.changed_bricks) return;
  ASSERT_EQ(a.changed_bricks->size(), b.changed_bricks->size());
  for (std::size_t i = 0; i < a.changed_bricks->size(); ++i) {
    EXPECT_EQ((*a.changed_bricks)[i].brick, (*b.changed_bricks)[i].brick);
    EXPECT_EQ((*a.changed_bricks)[i].voxels, (*b.changed_bricks)[i].voxels);
  }
}

bool equal(const StepRecord& a, const StepRecord& b) {
  const auto bricksEqual = [&] {
    return std::equal(a.changed_bricks->begin(), a.changed_bricks->end(), b.changed_bricks->begin(),
                      b.changed_bricks->end(), [](const TsdfBrick& x, const TsdfBrick& y) {
                        return x.brick == y.brick && x.voxels == y.voxels;
                      });
  };
  return bytesOf(a) == bytesOf(b) && a.realised_voxels == b.realised_voxels &&
         bytesOf(a.depth) == bytesOf(b.depth) && bytesOf(a.contours) == bytesOf(b.contours) &&
         bytesOf(a.surface) == bytesOf(b.surface) && bytesOf(a.labels) == bytesOf(b.labels) &&
         bytesOf(a.saliency) == bytesOf(b.saliency) && bytesOf(a.point_labels) == bytesOf(b.point_labels) &&
         bytesOf(a.positions) == bytesOf(b.positions) && bytesOf(a.search) == bytesOf(b.search) &&
         bytesOf(a.utilities) == bytesOf(b.utilities) && bytesOf(a.box) == bytesOf(b.box) &&
         octreeEqual(a, b) && !a.changed_bricks == !b.changed_bricks && (!a.changed_bricks || bricksEqual());
}

bool equal(const RunHeader& a, const RunHeader& b) {
  return bytesOf(a) == bytesOf(b) && bytesOf(a.truth) == bytesOf(b.truth) &&
         bytesOf(a.octree) == bytesOf(b.octree) && bytesOf(a.arm) == bytesOf(b.arm);
}

void writeRun(const std::filesystem::path& path, std::uint64_t seed, int steps) {
  RunWriter writer(path, randomHeader(seed));
  for (int step = 1; step <= steps; ++step) writer.write(randomRecord(seed + step, step));
  writer.write(randomRecord(seed + steps + 1, steps + 1, true));
  writer.finish("steps done");
}

}  // namespace vantage::testing
