// Solids from triangle meshes.
#include "io/scene_rays.h"
#include "io/solid.h"
#include "io/solid_parts.h"

namespace vantage {
namespace {

class MeshShape final : public Shape {
 public:
  explicit MeshShape(TriangleMesh mesh) : mesh_(std::move(mesh)), rays_(mesh_) {}

  double signedDistance(const Eigen::Vector3d& p) const override {
    const double distance = rays_.distance(p);
    return rays_.inside(p) ? -distance : distance;
  }
  TriangleMesh mesh() const override { return mesh_; }

 private:
  TriangleMesh mesh_;
  SceneRays rays_;
};

}  // namespace

ShapePtr makeMeshShape(TriangleMesh mesh) {
  if (mesh.empty()) throw std::invalid_argument("mesh has no triangles");
  mesh.colors.clear();
  for (const Eigen::Vector3f& v : mesh.vertices)
    for (const float coordinate : v)
      requireInRange("mesh: coordinate in metres", coordinate, -1000.0f, 1000.0f);
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t corner : t)
      if (corner >= mesh.vertices.size())
        throw std::invalid_argument("mesh: a triangle names vertex " + std::to_string(corner) + " of " +
                                    std::to_string(mesh.vertices.size()));
  return std::make_shared<MeshShape>(std::move(mesh));
}

}  // namespace vantage
