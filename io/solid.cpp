#include "io/solid.h"

#include <array>
#include <utility>

#include "io/solid_parts.h"

namespace vantage {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

class BoxShape final : public Shape {
 public:
  explicit BoxShape(const Vector3d& size) : half_(size / 2) {}

  double signedDistance(const Vector3d& p) const override {
    const Vector3d outside = (p - Vector3d(0, 0, half_.z())).cwiseAbs() - half_;
    return outside.cwiseMax(0.0).norm() + std::min(outside.maxCoeff(), 0.0);
  }

  TriangleMesh mesh() const override {
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 2 : 0);
      mesh.vertices.push_back(half_.cwiseProduct(sign).cast<float>());
    }
    constexpr std::array<std::array<std::uint32_t, 4>, 6> faces = {
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& f : faces) {
      mesh.triangles.push_back({f[0], f[1], f[2]});
      mesh.triangles.push_back({f[0], f[2], f[3]});
    }
    return mesh;
  }

 private:
  Vector3d half_;
};

class SphereShape final : public Shape {
 public:
  explicit SphereShape(double radius) : radius_(radius) {
    const int steps = std::max(6, solid_parts::circleSides(radius) / 2);
    std::vector<ProfilePoint> profile;
    for (int i = 0; i <= steps; ++i) {
      const double angle = std::numbers::pi * (static_cast<double>(i) / steps - 0.5);
      const bool pole = i == 0 || i == steps;
      profile.emplace_back(pole ? 0.0 : radius * std::cos(angle), radius * std::sin(angle));
    }
    lathe_ = makeLathe(profile, false);
  }
  double signedDistance(const Vector3d& p) const override { return p.norm() - radius_; }
  TriangleMesh mesh() const override { return lathe_->mesh(); }

 private:
  double radius_;
  ShapePtr lathe_;
};

}  // namespace

ShapePtr makeBox(const Vector3d& size_m) {
  for (int axis = 0; axis < 3; ++axis) solid_parts::requireSize("size_m", size_m[axis]);
  return std::make_shared<BoxShape>(size_m);
}

ShapePtr makeSphere(double radius_m) {
  solid_parts::requireSize("radius_m", radius_m);
  return std::make_shared<SphereShape>(radius_m);
}

namespace {
constexpr std::array<std::string_view, 5> kRoles = {"object", "table", "panel", "room", "other"};
}

std::string_view toString(SolidRole role) {
  return kRoles[static_cast<std::size_t>(role)];
}

std::optional<SolidRole> solidRole(std::string_view name) {
  for (std::size_t i = 0; i < kRoles.size(); ++i)
    if (kRoles[i] == name) return static_cast<SolidRole>(i);
  return std::nullopt;
}

Solid::Solid(ShapePtr shape, const Pose& T_world_solid, SolidRole role, std::string object, Color color)
    : shape_(std::move(shape)),
      T_world_solid_(T_world_solid),
      T_solid_world_(T_world_solid.inverse()),
      role_(role),
      object_(std::move(object)),
      color_(color) {
  if (!shape_) throw std::invalid_argument("Solid: no shape");
  mesh_ = shape_->mesh();
  for (Vector3f& vertex : mesh_.vertices) {
    const Vector3d p_world = T_world_solid_ * vertex.cast<double>();
    vertex = p_world.cast<float>();
    bounds_.extend(p_world);
  }
  mesh_.colors.assign(mesh_.triangles.size(), color_);
}

void appendMesh(const TriangleMesh& added, TriangleMesh& mesh) {
  constexpr std::array<std::uint8_t, 3> grey = {200, 200, 200};
  mesh.colors.resize(mesh.triangles.size(), grey);
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), added.vertices.begin(), added.vertices.end());
  for (std::size_t i = 0; i < added.triangles.size(); ++i) {
    const auto& t = added.triangles[i];
    mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    mesh.colors.push_back(i < added.colors.size() ? added.colors[i] : grey);
  }
}

}  // namespace vantage
