// Round tubes: swept handles and torus sections.
#include <Eigen/Geometry>
#include <limits>

#include "io/solid.h"
#include "io/solid_parts.h"

namespace vantage {
namespace {

using Eigen::Vector3d;

/// Adds a ring of `sides` vertices around `center`, in the plane of `x` and `y`.
void addRing(const Vector3d& center, const Vector3d& x, const Vector3d& y, double radius, int sides,
             TriangleMesh& mesh) {
  for (int s = 0; s < sides; ++s) {
    const double angle = 2 * std::numbers::pi * s / sides;
    const Vector3d p = center + radius * (std::cos(angle) * x + std::sin(angle) * y);
    mesh.vertices.push_back(p.cast<float>());
  }
}

/// Joins the ring that starts at vertex `a` to the next one along the tube.
void joinRings(std::uint32_t a, std::uint32_t b, int sides, TriangleMesh& mesh) {
  for (int s = 0; s < sides; ++s) {
    const auto i = static_cast<std::uint32_t>(s), j = static_cast<std::uint32_t>((s + 1) % sides);
    mesh.triangles.push_back({a + i, a + j, b + j});
    mesh.triangles.push_back({a + i, b + j, b + i});
  }
}

/// Closes the tube by a half ball at an end; `along` is the outward direction.
void addCap(std::uint32_t rim, const Vector3d& center, const Vector3d& x, const Vector3d& y,
            const Vector3d& along, double radius, int sides, bool at_start, TriangleMesh& mesh) {
  const int steps = std::max(3, sides / 4);
  std::uint32_t last = rim;
  for (int i = 1; i < steps; ++i) {
    const double angle = std::numbers::pi / 2 * i / steps;
    const auto ring = static_cast<std::uint32_t>(mesh.vertices.size());
    addRing(center + radius * std::sin(angle) * along, x, y, radius * std::cos(angle), sides, mesh);
    at_start ? joinRings(ring, last, sides, mesh) : joinRings(last, ring, sides, mesh);
    last = ring;
  }
  const auto pole = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back((center + radius * along).cast<float>());
  for (int s = 0; s < sides; ++s) {
    const std::uint32_t a = last + static_cast<std::uint32_t>(s);
    const std::uint32_t b = last + static_cast<std::uint32_t>((s + 1) % sides);
    at_start ? mesh.triangles.push_back({a, pole, b}) : mesh.triangles.push_back({a, b, pole});
  }
}

/// Surface of a tube around a polyline whose bends are slight; open ends get half balls.
TriangleMesh tubeMesh(const std::vector<Vector3d>& line, double radius, bool closed) {
  const std::size_t n = line.size();
  const int sides = solid_parts::circleSides(radius);
  const auto direction = [&](std::size_t i, std::size_t j) { return (line[j] - line[i]).normalized(); };
  TriangleMesh mesh;
  Vector3d x = direction(0, 1).unitOrthogonal(), first_x, first_y, last_y;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = i > 0 ? i - 1 : (closed ? n - 1 : 0);
    const std::size_t after = i + 1 < n ? i + 1 : (closed ? 0 : n - 1);
    const Vector3d tangent = direction(before, after);
    x = (x - x.dot(tangent) * tangent).normalized();  // carried along without twist
    last_y = tangent.cross(x);
    if (i == 0) first_x = x, first_y = last_y;
    addRing(line[i], x, last_y, radius, sides, mesh);
  }
  const auto ring = [&](std::size_t i) {
    return static_cast<std::uint32_t>(i * static_cast<std::size_t>(sides));
  };
  for (std::size_t i = 0; i + 1 < n; ++i) joinRings(ring(i), ring(i + 1), sides, mesh);
  if (closed) {
    joinRings(ring(n - 1), ring(0), sides, mesh);
  } else {
    addCap(ring(0), line[0], first_x, first_y, direction(1, 0), radius, sides, true, mesh);
    addCap(ring(n - 1), line[n - 1], x, last_y, direction(n - 2, n - 1), radius, sides, false, mesh);
  }
  return mesh;
}

class SweepShape final : public Shape {
 public:
  SweepShape(std::vector<Vector3d> line, double radius) : line_(std::move(line)), radius_(radius) {}

  double signedDistance(const Vector3d& p) const override {
    double distance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < line_.size(); ++i)
      distance = std::min(distance, solid_parts::distanceToSegment(p, line_[i], line_[i + 1]));
    return distance - radius_;
  }
  TriangleMesh mesh() const override { return tubeMesh(line_, radius_, false); }

 private:
  std::vector<Vector3d> line_;
  double radius_;
};

class TorusShape final : public Shape {
 public:
  TorusShape(double radius, double tube, double angle) : radius_(radius), tube_(tube), angle_(angle) {}

  double signedDistance(const Vector3d& p) const override {
    if (full()) return std::hypot(std::hypot(p.x(), p.y()) - radius_, p.z()) - tube_;
    const double turn = 2 * std::numbers::pi;
    double angle = std::atan2(p.y(), p.x());
    if (angle < 0) angle += turn;
    if (angle > angle_) angle = angle - angle_ < turn - angle ? angle_ : 0.0;  // the nearer end
    return (p - onCircle(angle)).norm() - tube_;
  }

  TriangleMesh mesh() const override {
    const double share = angle_ / (2 * std::numbers::pi);
    const int steps =
        std::max(3, static_cast<int>(std::ceil(solid_parts::circleSides(radius_ + tube_) * share)));
    std::vector<Vector3d> line;
    for (int i = 0; i < steps + (full() ? 0 : 1); ++i) line.push_back(onCircle(angle_ * i / steps));
    return tubeMesh(line, tube_, full());
  }

 private:
  bool full() const { return angle_ > 2 * std::numbers::pi - 1e-6; }
  Vector3d onCircle(double angle) const { return radius_ * Vector3d(std::cos(angle), std::sin(angle), 0); }

  double radius_, tube_, angle_;
};

}  // namespace

ShapePtr makeTorus(double radius_m, double tube_radius_m, double angle_rad) {
  solid_parts::requireSize("radius_m", radius_m);
  solid_parts::requireSize("tube_radius_m", tube_radius_m);
  if (tube_radius_m >= radius_m)
    throw std::invalid_argument("tube_radius_m = " + std::to_string(tube_radius_m) +
                                " is out of range; allowed: less than radius_m");
  requireInRange("angle", angle_rad, 1e-3, 2 * std::numbers::pi + 1e-9);
  return std::make_shared<TorusShape>(radius_m, tube_radius_m, angle_rad);
}

ShapePtr makeSweep(const std::vector<Vector3d>& path, double radius_m) {
  solid_parts::requireSize("radius_m", radius_m);
  requireInRange("path_m: number of points", path.size(), 2u, 10000u);
  for (std::size_t i = 0; i < path.size(); ++i) {
    for (const double coordinate : path[i])
      requireInRange("path_m: coordinate", coordinate, -solid_parts::kMaxSize_m, solid_parts::kMaxSize_m);
    if (i > 0 && (path[i] - path[i - 1]).norm() < 1e-6)
      throw std::invalid_argument("path_m: two points in a row are the same; remove one");
  }
  std::vector<Vector3d> line = solid_parts::smoothCurve(path);
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const Vector3d a = line[i] - line[i - 1], b = line[i + 1] - line[i];
    const double bend = std::atan2(a.cross(b).norm(), a.dot(b));
    if (bend * radius_m > (a.norm() + b.norm()) / 2)
      throw std::invalid_argument(
          "path_m bends more sharply than radius_m allows; spread its points or make "
          "the radius smaller");
  }
  return std::make_shared<SweepShape>(std::move(line), radius_m);
}

}  // namespace vantage
