#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/grid_geometry.h"
#include "core/geometry/pose.h"
#include "core/geometry/triangle_mesh.h"

namespace vantage {

/// A closed form in a frame of its own, metres. Immutable; all functions may be called from many threads.
class Shape {
 public:
  virtual ~Shape() = default;
  /// Distance to the surface, negative inside. Never larger in magnitude than the true distance.
  virtual double signedDistance(const Eigen::Vector3d& p_solid) const = 0;
  /// Closed surface, triangles counter-clockwise seen from outside; curved parts deviate by less than 0.3 mm
  /// for forms of tabletop size. No colours.
  virtual TriangleMesh mesh() const = 0;
};
using ShapePtr = std::shared_ptr<const Shape>;

/// Box of the given edge lengths; origin in the middle of its lower face.
ShapePtr makeBox(const Eigen::Vector3d& size_m);
/// Sphere around the origin.
ShapePtr makeSphere(double radius_m);
/// Frustum with its axis on z, from z = 0 to `height_m`; one of the radii may be 0. Equal radii: a cylinder.
ShapePtr makeCone(double radius_bottom_m, double radius_top_m, double height_m);
/// Section of a torus around the z axis, from angle 0 (the x axis) to `angle_rad` in (0, 2 pi], with round
/// ends unless it is a full turn. The tube's circle has radius `tube_radius_m` < `radius_m`.
ShapePtr makeTorus(double radius_m, double tube_radius_m, double angle_rad);

/// Point (radius, height) of a lathe profile.
using ProfilePoint = Eigen::Vector2d;
/// Solid of revolution around z. The profile runs along its outside, from bottom to top or back; its ends are
/// joined to the axis by flat discs. With `smooth` a Catmull-Rom curve runs through the points, with a corner
/// where a point stands twice.
ShapePtr makeLathe(const std::vector<ProfilePoint>& profile, bool smooth);
/// Open vessel: the profile runs from the middle of the outer bottom to the rim; the wall lies within it and
/// is `thickness_m` thick.
ShapePtr makeLatheShell(const std::vector<ProfilePoint>& profile, double thickness_m, bool smooth);
/// Ball of `radius_m` swept along a smooth curve (Catmull-Rom) through at least two points.
ShapePtr makeSweep(const std::vector<Eigen::Vector3d>& path, double radius_m);
/// A closed triangle mesh; the inside is found by ray parity. Small holes are tolerated.
ShapePtr makeMeshShape(TriangleMesh mesh);
// All of these throw std::invalid_argument that names the size, its value and what is allowed.

/// What a solid is for. Only `Object` counts as an object in the metrics.
enum class SolidRole : std::uint8_t { Object, Table, Panel, Room, Other };
std::string_view toString(SolidRole role);
/// Role of a name, empty if there is none such.
std::optional<SolidRole> solidRole(std::string_view name);

/// One placed form of a scene.
class Solid {
 public:
  using Color = std::array<std::uint8_t, 3>;

  /// \throws std::invalid_argument if there is no shape.
  Solid(ShapePtr shape, const Pose& T_world_solid, SolidRole role, std::string object, Color color);

  SolidRole role() const { return role_; }
  /// Solids of the same name form one object (the body and the handle of a jug).
  const std::string& object() const { return object_; }
  Color color() const { return color_; }
  const Pose& pose() const { return T_world_solid_; }
  const Shape& shape() const { return *shape_; }

  /// Distance to the surface, negative inside, metres.
  double signedDistance(const Eigen::Vector3d& p_world) const {
    return shape_->signedDistance(T_solid_world_ * p_world);
  }
  /// Surface in world coordinates, coloured.
  const TriangleMesh& mesh() const { return mesh_; }
  /// Bounding box of the surface in world coordinates.
  const Box& bounds() const { return bounds_; }

 private:
  ShapePtr shape_;
  Pose T_world_solid_;
  Pose T_solid_world_;
  SolidRole role_;
  std::string object_;
  Color color_;
  TriangleMesh mesh_;
  Box bounds_;
};

/// Adds a mesh to another, colours included (grey where the added one has none).
void appendMesh(const TriangleMesh& added, TriangleMesh& mesh);

}  // namespace vantage
