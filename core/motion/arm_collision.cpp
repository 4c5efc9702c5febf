#include "core/motion/arm_collision.h"

#include <fcl/geometry/octree/octree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vantage {
namespace {

constexpr std::uint8_t kUnset = 2;

std::shared_ptr<fcl::CollisionGeometryd> geometryOf(const LinkShape& shape) {
  switch (shape.kind) {
    case ShapeKind::Cuboid:
      return std::make_shared<fcl::Boxd>(shape.size_m);
    case ShapeKind::Cylinder:
      return std::make_shared<fcl::Cylinderd>(shape.radius_m, shape.length_m);
    case ShapeKind::Capsule:
      return std::make_shared<fcl::Capsuled>(shape.radius_m, shape.length_m);
    case ShapeKind::Sphere:
      break;
  }
  return std::make_shared<fcl::Sphered>(shape.radius_m);
}

/// Farthest that any part of a shape can be from its frame's origin.
double extentOf(const LinkShape& shape) {
  const double half =
      shape.kind == ShapeKind::Cuboid ? shape.size_m.norm() / 2 : shape.radius_m + shape.length_m / 2;
  return shape.T_frame_shape.translation().norm() + half;
}

/// Farthest that any part of the arm can be from its base; sliding joints by their travel.
double reachOf(const RobotModel& model) {
  std::vector<double> frame_reach;
  double reach = 0.0;
  for (const ArmJoint& joint : model.joints) {
    reach += joint.T_parent_joint.translation().norm();
    if (joint.prismatic) reach += std::max(std::abs(joint.lower), std::abs(joint.upper));
    frame_reach.push_back(reach);
  }
  double farthest = reach;
  for (const LinkShape& shape : model.shapes)
    farthest = std::max(farthest, extentOf(shape) + (shape.frame < 0 ? 0.0 : frame_reach[shape.frame]));
  return farthest;
}

bool contains(const std::vector<Box>& boxes, const Eigen::Vector3d& p) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) { return box.contains(p); });
}

}  // namespace

struct ArmCollision::Data {
  RobotModel model;
  ArmPlace place;
  double reach_m = 0.0;
  std::vector<fcl::CollisionObjectd> bodies;
  std::vector<std::pair<int, int>> pairs;  ///< bodies that may meet
  /// Cells around the arm, a multiple of the map's from its corner; 1 = obstacle, 0 = free.
  GridGeometry cells;
  std::vector<std::uint8_t> obstacle;
  std::shared_ptr<octomap::OcTree> tree;  ///< of all of them, in cell coordinates: cell (i,j,k) is [i,i+1]...
  std::unique_ptr<fcl::CollisionObjectd> world;

  void makeCells(const GridGeometry& map);
  octomap::OcTreeKey keyOf(const Eigen::Vector3i& cell) const;
  /// A quick look before the exact one: no obstacle among the cells that a body's box overlaps.
  bool clearBox(const fcl::AABBd& box) const;
};

ArmCollision::ArmCollision(const RobotModel& model, const ArmPlace& place) : data_(std::make_unique<Data>()) {
  data_->model = model;
  data_->place = place;
  data_->reach_m = reachOf(model);
  for (const LinkShape& shape : model.shapes) data_->bodies.emplace_back(geometryOf(shape));
  const auto& shapes = model.shapes;
  for (std::size_t a = 0; a < shapes.size(); ++a)
    for (std::size_t b = a + 1; b < shapes.size(); ++b)
      if (std::abs(shapes[a].frame - shapes[b].frame) > 1)
        data_->pairs.emplace_back(static_cast<int>(a), static_cast<int>(b));
}
ArmCollision::~ArmCollision() = default;
ArmCollision::ArmCollision(ArmCollision&&) noexcept = default;
ArmCollision& ArmCollision::operator=(ArmCollision&&) noexcept = default;

/// All cells that the arm can touch, on the grid of the map's.
void ArmCollision::Data::makeCells(const GridGeometry& map) {
  const Eigen::Vector3d base = place.T_world_base.translation();
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(reach_m + map.voxel_size_m);
  const Eigen::Vector3i low = map.voxelAt(base - reach), high = map.voxelAt(base + reach);
  cells.voxel_size_m = map.voxel_size_m;
  cells.origin_m = map.origin_m + map.voxel_size_m * low.cast<double>();
  cells.size = high - low + Eigen::Vector3i::Ones();
  obstacle.assign(cells.count(), kUnset);
  tree = std::make_shared<octomap::OcTree>(map.voxel_size_m);
  world = std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::OcTreed>(tree));
  // The octree's own cells begin at multiples of their size: it stands shifted.
  fcl::Transform3d shift = fcl::Transform3d::Identity();
  shift.translation() = cells.origin_m - Eigen::Vector3d::Constant(cells.voxel_size_m / 2);
  world->setTransform(shift);
  world->computeAABB();
}

octomap::OcTreeKey ArmCollision::Data::keyOf(const Eigen::Vector3i& cell) const {
  constexpr int kOrigin = 32768;  // of OctoMap's 16-bit keys
  const auto key = [](int i) { return static_cast<octomap::key_type>(kOrigin + i); };
  return {key(cell.x()), key(cell.y()), key(cell.z())};
}

bool ArmCollision::Data::clearBox(const fcl::AABBd& box) const {
  const Eigen::Vector3i low = cells.voxelAt(box.min_), high = cells.voxelAt(box.max_);
  if (!cells.contains(low) || !cells.contains(high)) return false;
  const auto count = static_cast<std::size_t>(high.x() - low.x() + 1);
  for (int k = low.z(); k <= high.z(); ++k)
    for (int j = low.y(); j <= high.y(); ++j)
      if (std::memchr(&obstacle[cells.index(low.x(), j, k)], 1, count)) return false;
  return true;
}

std::size_t ArmCollision::update(const CollisionGrid& grid) {
  Data& d = *data_;
  const GridGeometry& map = grid.geometry();
  const bool fresh = d.cells.count() == 0;
  if (fresh) d.makeCells(map);
  std::size_t written = 0;
  const Eigen::Vector3i first = map.voxelAt(d.cells.origin_m);
  for (std::size_t n = 0; n < d.cells.count(); ++n) {
    const Eigen::Vector3i cell = d.cells.voxel(n);
    const bool free = grid.freeCell(first + cell) || contains(d.place.clear_boxes, d.cells.center(cell));
    const auto obstacle = static_cast<std::uint8_t>(!free);
    if (obstacle == d.obstacle[n]) continue;
    d.obstacle[n] = obstacle;
    ++written;
    d.tree->setNodeValue(
        d.keyOf(cell), obstacle ? d.tree->getClampingThresMaxLog() : d.tree->getClampingThresMinLog(), true);
  }
  if (written == 0) return 0;
  d.tree->updateInnerOccupancy();
  d.tree->prune();
  d.world->computeAABB();
  return written;
}

ArmContact ArmCollision::check(const JointVector& q) const {
  Data& d = *data_;
  const ArmFrames frames = forwardKinematics(d.model, q);
  for (std::size_t b = 0; b < d.bodies.size(); ++b) {
    const LinkShape& shape = d.model.shapes[b];
    d.bodies[b].setTransform(d.place.T_world_base * frames.of(shape.frame) * shape.T_frame_shape);
    d.bodies[b].computeAABB();
  }
  const fcl::CollisionRequestd request;
  for (std::size_t b = 0; b < d.bodies.size(); ++b) {
    if (d.model.shapes[b].frame < 0) continue;
    if (d.world && d.clearBox(d.bodies[b].getAABB())) continue;
    fcl::CollisionResultd result;
    if (!d.world || fcl::collide(d.world.get(), &d.bodies[b], request, result) > 0)
      return {ArmContact::With::Obstacle, d.model.shapes[b].link, {}};
  }
  for (const auto& [a, b] : d.pairs) {
    fcl::CollisionResultd result;
    if (d.bodies[a].getAABB().overlap(d.bodies[b].getAABB()) &&
        fcl::collide(&d.bodies[a], &d.bodies[b], request, result) > 0)
      return {ArmContact::With::Itself, d.model.shapes[a].link, d.model.shapes[b].link};
  }
  return {};
}

}  // namespace vantage
