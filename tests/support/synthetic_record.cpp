#include "tests/support/synthetic_record.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/exploration/plan_view.h"

namespace vantage::test {
namespace {

constexpr double kWall_m = 3.0;
const Eigen::Vector3d kBall(-0.16, 0.0, 0.08);
constexpr double kBallRadius_m = 0.08;
const Box kBlock(Eigen::Vector3d(0.06, -0.04, 0.0), Eigen::Vector3d(0.20, 0.08, 0.16));
const Eigen::Vector2d kTable(0.45, 0.35);  ///< half lengths

/// Distance along a ray to the box's entry, infinity if it is missed.
double hitBox(const Box& box, const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
  double enter = 0.0, leave = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    const double t0 = (box.min()[a] - from[a]) / along[a], t1 = (box.max()[a] - from[a]) / along[a];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return enter < leave ? enter : std::numeric_limits<double>::infinity();
}

double hitScene(const Eigen::Vector3d& from, const Eigen::Vector3d& along) {
  double nearest = hitBox(kBlock, from, along);
  const double b = along.dot(from - kBall), a = along.squaredNorm();
  const double discriminant = b * b - a * ((from - kBall).squaredNorm() - kBallRadius_m * kBallRadius_m);
  if (discriminant > 0.0) nearest = std::min(nearest, (-b - std::sqrt(discriminant)) / a);
  const double t = -from.z() / along.z();
  const Eigen::Vector3d on_table = from + t * along;
  if (t > 0.0 && std::abs(on_table.x()) < kTable.x() && std::abs(on_table.y()) < kTable.y())
    nearest = std::min(nearest, t);
  return nearest;
}

TriangleMesh truthMesh() {
  TriangleMesh mesh;
  const auto quad = [&](const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                        const Eigen::Vector3f& d, std::array<std::uint8_t, 3> color) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c, d});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
    mesh.colors.insert(mesh.colors.end(), {color, color});
  };
  const auto x = static_cast<float>(kTable.x()), y = static_cast<float>(kTable.y());
  quad({-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}, {190, 170, 140});
  const Eigen::Vector3f l = kBlock.min().cast<float>(), h = kBlock.max().cast<float>();
  quad({l.x(), l.y(), h.z()}, {h.x(), l.y(), h.z()}, {h.x(), h.y(), h.z()}, {l.x(), h.y(), h.z()},
       {70, 110, 180});
  quad({l.x(), l.y(), 0}, {h.x(), l.y(), 0}, {h.x(), l.y(), h.z()}, {l.x(), l.y(), h.z()}, {70, 110, 180});
  quad({h.x(), l.y(), 0}, {h.x(), h.y(), 0}, {h.x(), h.y(), h.z()}, {h.x(), l.y(), h.z()}, {70, 110, 180});
  return mesh;
}

RunHeader makeHeader() {
  RunHeader header;
  header.input = "synthetic";
  header.planner = "contour";
  header.robot = "free";
  header.seed = 1;
  header.camera = cameraFromFov(160, 132, 1.2);
  header.camera.min_range_m = 0.3;
  header.volume = {{-0.6, -0.5, -0.05}, 0.01, {120, 100, 60}};
  header.workspace = Box(Eigen::Vector3d(-0.5, -0.4, 0.0), Eigen::Vector3d(0.5, 0.4, 0.45));
  header.contour_config.segmentation.voxel_m = 0.015;
  header.contour_config.segmentation.seed_m = 0.04;
  header.contour_config.gain.reduction = 1;
  header.contour_config.gain.gain_threshold = 100.0;
  header.truth = truthMesh();
  return header;
}

MotionPlan reach(const Pose& start, const Pose& goal) {
  MotionPlan plan;
  plan.verdict = goal.translation().z() > 0.45 ? Reachability::OutOfReach : Reachability::Reachable;
  if (plan.verdict != Reachability::Reachable) return plan;
  plan.straight = true;
  plan.waypoints = {start, goal};
  plan.length_m = (goal.translation() - start.translation()).norm();
  return plan;
}

/// Twelve poses on an arc at -y.
std::vector<Pose> scanPoses() {
  std::vector<Pose> poses;
  for (int i = 0; i < 12; ++i) {
    const double angle = -0.25 + 0.5 * i / 11;
    poses.push_back(lookAt({std::sin(angle), -std::cos(angle), 0.6}, {0.0, 0.0, 0.08}));
  }
  return poses;
}

}  // namespace

DepthImage syntheticDepth(const PinholeCamera& camera, const Pose& T_world_camera) {
  DepthImage depth(camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double z = hitScene(T_world_camera.translation(), T_world_camera.linear() * camera.ray(u, v));
      depth.at(u, v) = static_cast<float>(std::min(z, kWall_m));
    }
  }
  return depth;
}

SyntheticRun makeEmptyRun() {
  SyntheticRun run;
  run.header = makeHeader();
  run.volume = TsdfVolume(run.header.volume);
  run.states = makeStateGrid(run.volume);
  run.record.planner = "contour";
  return run;
}

SyntheticOctreeRun makeSyntheticOctreeRun(CandidateGenerator generator, bool with_views) {
  SyntheticOctreeRun run;
  run.header = makeHeader();
  run.header.planner = run.record.planner = "hierarchical";
  OctreeHeader& octree = run.header.octree.emplace();
  octree.object_box = Box(Eigen::Vector3d(-0.28, -0.14, 0.0), Eigen::Vector3d(0.26, 0.16, 0.22));
  octree.map.voxel_size_m = 0.01;
  octree.map.object_box = octree.object_box;
  octree.planner.generator = generator;
  octree.planner.sensor.min_range_m = 0.1;
  octree.planner.sensor.max_range_m = 1.5;
  octree.planner.sphere_radius_m = 0.45;
  octree.planner.workspace_views = 150;
  octree.planner.min_occupied = 50.0;
  octree.planner.stop_gain = with_views ? 100.0 : 1e8;
  run.octree = OccupancyOctree(OccupancyOctree::gridAround(run.header.volume.bounds(), 0.01),
                               octree.object_box, octree.map.outside, octree.map.occupancy);
  auto bricks = std::make_shared<std::vector<OctreeBrick>>();
  auto last = std::make_shared<DepthFrame>();
  for (const Pose& pose : scanPoses()) {
    last->T_world_camera = pose;
    last->depth = syntheticDepth(run.header.camera, pose);
    run.octree.insert(last->depth, run.header.camera, pose);
    run.record.scan.push_back({pose, -1});
  }
  run.record.depth = last;
  for (std::uint32_t brick = 0; brick < run.octree.bricks().total(); ++brick) {
    const BrickRange range = run.octree.bricks().range(brick);
    bricks->push_back({brick, std::vector<float>((range.end - range.begin).prod())});
    run.octree.readBrick(brick, bricks->back().log_odds);
  }
  run.record.changed_octree_bricks = bricks;
  run.pyramid = StatePyramid(run.octree, StatePyramid::kMaxCoarseLevels);
  run.tree = RayTree(octree.planner.sensor, 0.01, octree.planner.coarse_levels);
  run.record.metrics.unknown_voxels = run.pyramid.finest().count(VoxelState::Unknown, run.header.workspace);
  run.record.box = std::make_shared<BoxMetrics>(
      BoxMetrics{run.pyramid.finest().count(VoxelState::Unknown, octree.object_box),
                 run.pyramid.finest().count(VoxelState::Occupied, octree.object_box)});
  const PlanUtilityInput input{.pyramid = run.pyramid,
                               .tree = run.tree,
                               .object_box = octree.object_box,
                               .workspace = run.header.workspace,
                               .recorded = {},
                               .current = last->T_world_camera,
                               .config = octree.planner,
                               .seed = 1};
  std::size_t asked = 0;  // the two best cannot be reached
  const auto refuseTwo = [&](const Pose& goal) {
    MotionPlan plan;
    plan.verdict = asked++ < 2 ? Reachability::NoPath : Reachability::Reachable;
    if (plan.verdict != Reachability::Reachable) return plan;
    plan.straight = true;
    plan.waypoints = {last->T_world_camera, goal};
    plan.length_m = (goal.translation() - last->T_world_camera.translation()).norm();
    return plan;
  };
  planUtility(run.record, input, refuseTwo, [](Stage) {}, {});
  run.record.stage = Stage::Done;
  return run;
}

SyntheticRun makeSyntheticRun(bool with_views) {
  SyntheticRun run = makeEmptyRun();
  if (!with_views) run.header.contour_config.gain.gain_threshold = 1e9;
  StepRecord& record = run.record;
  BrickSet changed(run.volume.bricks().total());
  auto last = std::make_shared<DepthFrame>();
  for (const Pose& pose : scanPoses()) {
    last->T_world_camera = pose;
    last->depth = syntheticDepth(run.header.camera, last->T_world_camera);
    changed.merge(fuseDepth(run.volume, last->depth, run.header.camera, last->T_world_camera, {}).changed);
    record.scan.push_back({last->T_world_camera, -1});
  }
  record.depth = last;
  record.filtered =
      std::make_shared<const FilteredDepth>(filterDepth(last->depth, run.header.camera, paperDepthFilters()));
  auto bricks = std::make_shared<std::vector<TsdfBrick>>();
  for (const std::uint32_t brick : changed.list()) bricks->push_back({brick, run.volume.brick(brick)});
  record.changed_bricks = bricks;
  run.states = makeStateGrid(run.volume);
  record.metrics.unknown_voxels = run.states.count(VoxelState::Unknown, run.header.workspace);
  const PlanViewInput input{run.volume, run.states, run.header.camera, run.header.workspace,
                            run.header.contour_config};
  planView(
      record, input, [&](const Pose& goal) { return reach(last->T_world_camera, goal); }, [](Stage) {}, {});
  record.stage = Stage::Done;
  return run;
}

}  // namespace vantage::test
