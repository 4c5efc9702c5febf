// Solids of revolution: lathe profiles, vessels, cylinders and cones.
#include <limits>

#include "io/solid.h"
#include "io/solid_parts.h"

namespace vantage {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A simple polygon in the half plane (r >= 0, z) turned around the z axis; counter-clockwise.
class LatheShape final : public Shape {
 public:
  explicit LatheShape(std::vector<Vector2d> polygon) : polygon_(std::move(polygon)) {
    double area = 0.0;
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
      const Vector2d &a = polygon_[i], &b = next(i);
      area += a.x() * b.y() - b.x() * a.y();
    }
    if (area < 0) std::reverse(polygon_.begin(), polygon_.end());
  }

  double signedDistance(const Vector3d& p) const override {
    const Vector2d q(std::hypot(p.x(), p.y()), p.z());
    double distance = std::numeric_limits<double>::infinity();
    bool inside = false;
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
      const Vector2d &a = polygon_[i], &b = next(i);
      if (onAxis(a) && onAxis(b)) continue;  // no surface; q lies to the right of it, as the crossings need
      distance = std::min(distance, solid_parts::distanceToSegment(q, a, b));
      if ((a.y() > q.y()) == (b.y() > q.y())) continue;
      const double r = a.x() + (q.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (q.x() < r) inside = !inside;  // crossings of a ray away from the axis
    }
    return inside ? -distance : distance;
  }

  TriangleMesh mesh() const override {
    double widest = 0.0;
    for (const Vector2d& p : polygon_) widest = std::max(widest, p.x());
    const int sides = solid_parts::circleSides(widest);
    TriangleMesh mesh;
    std::vector<std::uint32_t> first(polygon_.size());
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
      first[i] = static_cast<std::uint32_t>(mesh.vertices.size());
      const int count = onAxis(polygon_[i]) ? 1 : sides;
      for (int s = 0; s < count; ++s) {
        const double angle = 2 * std::numbers::pi * s / sides;
        const double r = polygon_[i].x();
        mesh.vertices.push_back(
            Vector3d(r * std::cos(angle), r * std::sin(angle), polygon_[i].y()).cast<float>());
      }
    }
    for (std::size_t i = 0; i < polygon_.size(); ++i) addBand(first, i, sides, mesh);
    return mesh;
  }

 private:
  const Vector2d& next(std::size_t i) const { return polygon_[(i + 1) % polygon_.size()]; }
  static bool onAxis(const Vector2d& p) { return p.x() == 0.0; }

  void addBand(const std::vector<std::uint32_t>& first, std::size_t i, int sides, TriangleMesh& mesh) const {
    const std::size_t j = (i + 1) % polygon_.size();
    const bool lower_axis = onAxis(polygon_[i]), upper_axis = onAxis(polygon_[j]);
    if (lower_axis && upper_axis) return;
    for (int s = 0; s < sides; ++s) {
      const auto at = [&](std::size_t k, bool axis, int side) {
        return first[k] + (axis ? 0u : static_cast<std::uint32_t>(side % sides));
      };
      const std::uint32_t a0 = at(i, lower_axis, s), a1 = at(i, lower_axis, s + 1);
      const std::uint32_t b0 = at(j, upper_axis, s), b1 = at(j, upper_axis, s + 1);
      if (!lower_axis) mesh.triangles.push_back({a0, a1, b1});
      if (!upper_axis) mesh.triangles.push_back({a0, b1, b0});
    }
  }

  std::vector<Vector2d> polygon_;
};

/// Checked profile without repeated points, smooth if wanted.
std::vector<Vector2d> profileCurve(const std::vector<Vector2d>& profile, bool smooth) {
  requireInRange("profile_m: number of points", profile.size(), 2u, 10000u);
  for (const Vector2d& p : profile) {
    requireInRange("profile_m: radius", p.x(), 0.0, solid_parts::kMaxSize_m);
    requireInRange("profile_m: height", p.y(), -solid_parts::kMaxSize_m, solid_parts::kMaxSize_m);
  }
  std::vector<Vector2d> curve = smooth ? solid_parts::smoothCurve(profile) : profile;
  std::vector<Vector2d> distinct;
  for (Vector2d p : curve) {
    p.x() = p.x() < 1e-9 ? 0.0 : p.x();  // a smooth curve may swing over the axis
    if (distinct.empty() || (p - distinct.back()).norm() > 1e-9) distinct.push_back(p);
  }
  if (distinct.size() < 2) throw std::invalid_argument("profile_m has only one point; give at least two");
  return distinct;
}

bool segmentsCross(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const auto side = [](const Vector2d& p, const Vector2d& q, const Vector2d& r) {
    return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
  };
  return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

void requireSimple(const std::vector<Vector2d>& polygon) {
  for (std::size_t i = 0; i < polygon.size(); ++i)
    for (std::size_t j = i + 2; j < polygon.size(); ++j)
      if (segmentsCross(polygon[i], polygon[i + 1], polygon[j], polygon[(j + 1) % polygon.size()]))
        throw std::invalid_argument("profile_m crosses itself; move its points or make thickness_m smaller");
}

/// The curve moved sideways by `distance` to its left, with mitred corners.
std::vector<Vector2d> offsetCurve(const std::vector<Vector2d>& curve, double distance) {
  const auto normal = [&](std::size_t i) {  // left of segment i
    const Vector2d d = (curve[i + 1] - curve[i]).normalized();
    return Vector2d(-d.y(), d.x());
  };
  std::vector<Vector2d> moved;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Vector2d before = normal(i > 0 ? i - 1 : 0);
    const Vector2d after = normal(std::min(i, curve.size() - 2));
    const double fold = std::max(0.25, 1.0 + before.dot(after));
    moved.push_back(curve[i] + distance * (before + after) / fold);
  }
  return moved;
}

}  // namespace

ShapePtr makeLathe(const std::vector<ProfilePoint>& profile, bool smooth) {
  std::vector<Vector2d> polygon = profileCurve(profile, smooth);
  if (polygon.front().x() > 0) polygon.insert(polygon.begin(), Vector2d(0, polygon.front().y()));
  if (polygon.back().x() > 0) polygon.push_back(Vector2d(0, polygon.back().y()));
  requireSimple(polygon);
  double widest = 0.0;
  for (const Vector2d& p : polygon) widest = std::max(widest, p.x());
  solid_parts::requireSize("profile_m: largest radius", widest);
  if (polygon.size() < 3) throw std::invalid_argument("profile_m encloses nothing; give more points");
  return std::make_shared<LatheShape>(std::move(polygon));
}

ShapePtr makeLatheShell(const std::vector<ProfilePoint>& profile, double thickness_m, bool smooth) {
  solid_parts::requireSize("thickness_m", thickness_m);
  std::vector<Vector2d> polygon = profileCurve(profile, smooth);
  if (polygon.front().x() > 0) polygon.insert(polygon.begin(), Vector2d(0, polygon.front().y()));
  // Outward and up: the wall lies to the left of the profile.
  std::vector<Vector2d> inner = offsetCurve(polygon, thickness_m);
  inner.front().x() = 0.0;
  for (const Vector2d& p : inner)
    requireInRange("thickness_m: radius of the inner wall", p.x(), 0.0, solid_parts::kMaxSize_m);
  polygon.insert(polygon.end(), inner.rbegin(), inner.rend());
  requireSimple(polygon);
  return std::make_shared<LatheShape>(std::move(polygon));
}

ShapePtr makeCone(double radius_bottom_m, double radius_top_m, double height_m) {
  requireInRange("radius_bottom_m", radius_bottom_m, 0.0, solid_parts::kMaxSize_m);
  requireInRange("radius_top_m", radius_top_m, 0.0, solid_parts::kMaxSize_m);
  solid_parts::requireSize("height_m", height_m);
  solid_parts::requireSize("larger radius", std::max(radius_bottom_m, radius_top_m));
  return makeLathe({{radius_bottom_m, 0.0}, {radius_top_m, height_m}}, false);
}

}  // namespace vantage
