#include "viewer/app/experiments/objects.h"

#include <filesystem>
#include <numbers>
#include <utility>

#include "io/mesh_file.h"

namespace vantage::experiments {
namespace {

/// A solid's form, larger or smaller.
class ScaledShape : public Shape {
 public:
  ScaledShape(Solid solid, double scale) : solid_(std::move(solid)), scale_(scale) {}

  double signedDistance(const Eigen::Vector3d& p_solid) const override {
    return scale_ * solid_.shape().signedDistance(p_solid / scale_);
  }
  TriangleMesh mesh() const override {
    TriangleMesh mesh = solid_.shape().mesh();
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex *= static_cast<float>(scale_);
    return mesh;
  }

 private:
  Solid solid_;
  double scale_;
};

Pose uprightFrom(UpAxis up) {
  constexpr double kQuarter = std::numbers::pi / 2;
  Pose pose = Pose::Identity();
  if (up == UpAxis::Y) pose.rotate(Eigen::AngleAxisd(kQuarter, Eigen::Vector3d::UnitX()));
  if (up == UpAxis::X) pose.rotate(Eigen::AngleAxisd(-kQuarter, Eigen::Vector3d::UnitY()));
  return pose;
}

void replaceObject(SceneFile& scene, const ObjectSource& source) {
  std::erase_if(scene.solids, [](const Solid& solid) { return solid.role() == SolidRole::Object; });
  scene.solids.emplace_back(makeMeshShape(loadMesh(source.mesh)), uprightFrom(source.up), SolidRole::Object,
                            source.name, Solid::Color{0, 114, 178});
}

}  // namespace

ObjectSource compactStandIn() {
  return {.name = "compact", .scene = "a1_compact", .mesh = "", .up = UpAxis::Z};
}
ObjectSource elongatedStandIn() {
  return {.name = "elongated", .scene = "a1_elongated", .mesh = "", .up = UpAxis::Z};
}
ObjectSource meshObject(const std::string& file, UpAxis up) {
  return {.name = std::filesystem::path(file).stem().string(), .scene = "a1_compact", .mesh = file, .up = up};
}

Box objectBounds(const SceneFile& scene) {
  Box bounds;
  for (const Solid& solid : scene.solids)
    if (solid.role() == SolidRole::Object) bounds.extend(solid.bounds());
  return bounds;
}

double tableTop_m(const SceneFile& scene) {
  Box bounds;
  for (const Solid& solid : scene.solids)
    if (solid.role() == SolidRole::Table) bounds.extend(solid.bounds());
  if (bounds.isEmpty()) throw InputError(scene.source_path, "has no solid with role = \"table\"; add one");
  return bounds.max().z();
}

SceneFile sceneOnTable(const ObjectSource& source, double largest_extent_m) {
  SceneFile scene = loadScene(source.scene);
  if (!source.mesh.empty()) replaceObject(scene, source);
  const Box bounds = objectBounds(scene);
  if (bounds.isEmpty() || !(bounds.sizes().maxCoeff() > 0.0))
    throw InputError(source.mesh.empty() ? source.scene : source.mesh, "holds nothing that has an extent");

  const double scale = largest_extent_m / bounds.sizes().maxCoeff();
  const Eigen::Vector3d foot(bounds.center().x(), bounds.center().y(), bounds.min().z());
  const Eigen::Vector3d place(0.0, 0.0, tableTop_m(scene));
  for (Solid& solid : scene.solids) {
    if (solid.role() != SolidRole::Object) continue;
    Pose pose = solid.pose();
    pose.translation() = place + scale * (pose.translation() - foot);
    solid = Solid(std::make_shared<ScaledShape>(solid, scale), pose, SolidRole::Object, solid.object(),
                  solid.color());
  }
  return scene;
}

}  // namespace vantage::experiments
