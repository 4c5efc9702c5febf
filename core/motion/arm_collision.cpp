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
#include <stdexcept>
#include <string>
#include <utility>

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

/// Farthest that any part of the arm can be from its base.
double reachOf(const RobotModel& model) {
  const ArmJoint& first = model.joints.front();
  double reach = first.T_parent_joint.translation().norm() + reachBeyond(model, 0);
  if (first.prismatic) reach += std::max(std::abs(first.lower), std::abs(first.upper));
  for (const LinkShape& shape : model.shapes)
    if (shape.frame < 0) reach = std::max(reach, extentOf(shape));
  return reach;
}

bool contains(const std::vector<Box>& boxes, const Eigen::Vector3d& p) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) { return box.contains(p); });
}

}  // namespace

struct ArmCollision::Data {
  /// A shape where it is now.
  struct Body {
    LinkShape shape;
    fcl::CollisionObjectd object;
  };

  RobotModel model;
  ArmPlace place;
  std::vector<Body> bodies;
  std::vector<std::pair<int, int>> pairs;  ///< bodies that may meet
  GridGeometry map;                        ///< of the collision grid
  /// Cells around the arm, a multiple of the map's from its corner; 1 = obstacle, 0 = free.
  GridGeometry cells;
  std::vector<std::uint8_t> obstacle;
  std::shared_ptr<octomap::OcTree> tree;  ///< of all of them, in cell coordinates: cell (i,j,k) is [i,i+1]...
  std::unique_ptr<fcl::CollisionObjectd> world;

  void makeCells();
  void moveBodies(const JointVector& q);
  ArmContact withObstacles() const;
  ArmContact withItself() const;
  octomap::OcTreeKey keyOf(const Eigen::Vector3i& cell) const;
  /// A quick look before the exact one: no obstacle among the cells that a body's box overlaps.
  bool clearBox(const fcl::AABBd& box) const;
};

ArmCollision::ArmCollision(const RobotModel& model, const ArmPlace& place) : data_(std::make_unique<Data>()) {
  data_->model = model;
  data_->place = place;
  const auto& shapes = model.shapes;
  for (const LinkShape& shape : shapes)
    data_->bodies.push_back({shape, fcl::CollisionObjectd(geometryOf(shape))});
  for (std::size_t a = 0; a < shapes.size(); ++a)
    for (std::size_t b = a + 1; b < shapes.size(); ++b)
      if (std::abs(shapes[a].frame - shapes[b].frame) > 1)
        data_->pairs.emplace_back(static_cast<int>(a), static_cast<int>(b));
}
ArmCollision::~ArmCollision() = default;
ArmCollision::ArmCollision(ArmCollision&&) noexcept = default;
ArmCollision& ArmCollision::operator=(ArmCollision&&) noexcept = default;

/// All cells that the arm can touch, on the grid of the map's.
void ArmCollision::Data::makeCells() {
  constexpr double kMostCells = 1024.0;  // along an axis
  const double reach_m = reachOf(model) + map.voxel_size_m;
  if (!(2.0 * reach_m <= kMostCells * map.voxel_size_m))
    throw std::invalid_argument("an arm that reaches " + std::to_string(reach_m) +
                                " m is too long for collision cells of " + std::to_string(map.voxel_size_m) +
                                " m; allowed: up to 512 cells");
  const Eigen::Vector3d base = place.T_world_base.translation();
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(reach_m);
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
  if (d.cells.count() == 0) {
    d.map = grid.geometry();
    d.makeCells();
  } else if (!(grid.geometry() == d.map)) {
    throw std::invalid_argument("the collision cells of an arm keep the geometry of the first ones");
  }
  std::size_t written = 0;
  const Eigen::Vector3i first = d.map.voxelAt(d.cells.origin_m);
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

void ArmCollision::Data::moveBodies(const JointVector& q) {
  const ArmFrames frames = forwardKinematics(model, q);
  for (Body& body : bodies) {
    body.object.setTransform(place.T_world_base * frames.of(body.shape.frame) * body.shape.T_frame_shape);
    body.object.computeAABB();
  }
}

ArmContact ArmCollision::Data::withObstacles() const {
  for (const Body& body : bodies) {
    if (body.shape.frame < 0) continue;
    if (world && clearBox(body.object.getAABB())) continue;
    fcl::CollisionResultd result;
    if (!world || fcl::collide(world.get(), &body.object, {}, result) > 0)
      return {ArmContact::With::Obstacle, body.shape.link, {}};
  }
  return {};
}

ArmContact ArmCollision::Data::withItself() const {
  for (const auto& [a, b] : pairs) {
    const Body &first = bodies[a], &second = bodies[b];
    fcl::CollisionResultd result;
    if (first.object.getAABB().overlap(second.object.getAABB()) &&
        fcl::collide(&first.object, &second.object, {}, result) > 0)
      return {ArmContact::With::Itself, first.shape.link, second.shape.link};
  }
  return {};
}

ArmContact ArmCollision::check(const JointVector& q) const {
  data_->moveBodies(q);
  const ArmContact contact = data_->withObstacles();
  return contact.free() ? data_->withItself() : contact;
}

}  // namespace vantage
