#include "tests/support/reference_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/views/sphere_views.h"

namespace vantage::testing {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kVoxel = 0.01;
constexpr double kTableTop = 0.43, kTableThickness = 0.03;
const Vector3d kScanner(-1.5, 0.0, 0.7);

struct Ball {
  Vector3d center;
  double radius;
};

class Object {
 public:
  explicit Object(double scale)
      : balls_{ball({0, 0, 0.15}, 0.15, scale), ball({0.10, 0, 0.32}, 0.09, scale),
               ball({0.12, 0.06, 0.42}, 0.045, scale), ball({0.12, -0.06, 0.42}, 0.045, scale)} {}

  double distance(const Vector3d& p) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Ball& b : balls_) nearest = std::min(nearest, (p - b.center).norm() - b.radius);
    return nearest;
  }

  /// True if the segment from the scanner towards `p`, `gap` short of it, meets no ball.
  bool isClear(const Vector3d& p, double gap) const {
    const double length = (p - kScanner).norm();
    const Vector3d direction = (p - kScanner) / length;
    return std::all_of(balls_.begin(), balls_.end(), [&](const Ball& b) {
      const double t = std::clamp((b.center - kScanner).dot(direction), 0.0, std::max(0.0, length - gap));
      return (kScanner + t * direction - b.center).norm() >= b.radius;
    });
  }

  Box bounds() const {
    Box box;
    for (const Ball& b : balls_)
      box.extend(Box(b.center - Vector3d::Constant(b.radius), b.center + Vector3d::Constant(b.radius)));
    return box;
  }

 private:
  static Ball ball(const Vector3d& center, double radius, double scale) {
    return {scale * center + Vector3d(0, 0, kTableTop), scale * radius};
  }
  std::array<Ball, 4> balls_;
};

/// Walls one voxel thick, which are the outer layer of the grid, and the table.
VoxelState roomState(const GridGeometry& g, const Vector3i& v) {
  if ((v.array() == 0).any() || (v.array() == g.size.array() - 1).any()) return VoxelState::Occupied;
  const Vector3d p = g.center(v).cwiseAbs();
  if (p.x() < 0.6 && p.y() < 0.6 && p.z() > kTableTop - kTableThickness && p.z() < kTableTop)
    return VoxelState::Occupied;
  const bool leg =
      std::abs(p.x() - 0.55) < 0.025 && std::abs(p.y() - 0.55) < 0.025 && p.z() < kTableTop - kTableThickness;
  return leg ? VoxelState::Occupied : VoxelState::Free;
}

/// What one scan without a limited field of view leaves of the object's box. Surfaces are seen if nothing
/// stands before them, two voxels off: this gap meets both counts of the specification exactly.
VoxelState scannedState(const Object& object, const Vector3d& p) {
  constexpr double kSurface = 0.006, kGap = 0.02;
  if (std::abs(object.distance(p)) < kSurface && object.isClear(p, kGap)) return VoxelState::Occupied;
  return object.isClear(p, 0.0) ? VoxelState::Free : VoxelState::Unknown;
}

Box boxOf(const Object& object, double scale, RoomBox kind) {
  if (kind == RoomBox::Paper)
    return {Vector3d(-0.4 * scale, -0.4 * scale, kTableTop),
            Vector3d(0.4 * scale, 0.4 * scale, kTableTop + 0.52 * scale)};
  Box box = object.bounds();
  box.min() -= Vector3d::Constant(0.05);
  box.max() += Vector3d::Constant(0.05);
  box.min().z() = kTableTop;
  return box;
}

/// A cube of five voxels about the sensor is free, and the floor is not too near.
bool isFeasible(const StateGrid& grid, const Vector3d& eye) {
  if (eye.z() <= 0.06) return false;
  const Vector3i center = grid.geometry().voxelAt(eye);
  for (int k = -2; k <= 2; ++k)
    for (int j = -2; j <= 2; ++j)
      for (int i = -2; i <= 2; ++i) {
        const Vector3i v = center + Vector3i(i, j, k);
        if (!grid.geometry().contains(v) || grid.at(v) != VoxelState::Free) return false;
      }
  return true;
}

}  // namespace

ReferenceRoom makeReferenceRoom(double scale, RoomBox kind) {
  const Object object(scale);
  ReferenceRoom room;
  room.object_box = boxOf(object, scale, kind);
  GridGeometry g;
  g.voxel_size_m = kVoxel;
  g.size = {360, 360, 200};
  g.origin_m = Vector3d(-1.8, -1.8, 0.0) + Vector3d::Constant(kVoxel / 2);
  room.grid = StateGrid(g);
  for (std::size_t i = 0; i < g.count(); ++i) {
    const Vector3i v = g.voxel(i);
    room.grid.set(
        v, room.object_box.contains(g.center(v)) ? scannedState(object, g.center(v)) : roomState(g, v));
  }
  room.grid.rebuildFreeRadius();
  for (const ViewCandidate& view : icosphereViews(room.object_box.center(), 1.0, 2)) {
    const Vector3d eye = view.T_world_camera.translation();
    if (isFeasible(room.grid, eye))
      room.views.push_back({view.T_world_camera, eye.z() < kTableTop - kTableThickness});
  }
  return room;
}

}  // namespace vantage::testing
