#include "io/scene_truth.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>

#include "core/geometry/check.h"
#include "io/scene_rays.h"

namespace vantage {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kSampleArea_m2 = 4e-6;  // one point per 4 mm^2
constexpr double kContact_m = 1e-3;
constexpr float kStart_m = 3e-4f;  // rays start this far off the surface: its facets deviate by 0.1 mm

struct Object {
  std::string name;
  std::vector<const Solid*> solids;
  Box bounds;

  /// Distance to the united solids, negative inside; infinity if the bounding box is farther than `within`.
  double signedDistance(const Vector3d& p, double within) const {
    double distance = std::numeric_limits<double>::infinity();
    if (bounds.exteriorDistance(p) > within) return distance;
    for (const Solid* solid : solids) {
      if (solid->bounds().exteriorDistance(p) > std::min(within, std::max(distance, 0.0))) continue;
      distance = std::min(distance, solid->signedDistance(p));
    }
    return distance;
  }
};

struct SurfacePoint {
  Vector3f p, n;
  const Solid* solid;
};

/// Evenly spread unit vectors (Fibonacci lattice).
std::vector<Vector3f> sphereDirections(int count) {
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Vector3f> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - 2.0 * (i + 0.5) / count, r = std::sqrt(1.0 - z * z);
    directions.push_back(Vector3d(r * std::cos(golden * i), r * std::sin(golden * i), z).cast<float>());
  }
  return directions;
}

/// One point per 4 mm^2 on the surface of a solid, by a low-discrepancy sequence (R2) in every triangle.
void sampleSurface(const Solid& solid, std::vector<SurfacePoint>& points) {
  const TriangleMesh& mesh = solid.mesh();
  double area = 0.0;
  std::uint64_t drawn = 0;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Vector3d ab = mesh.vertices[t[1]].cast<double>() - a, ac = mesh.vertices[t[2]].cast<double>() - a;
    const Vector3d normal = ab.cross(ac);
    if (normal.norm() < 1e-16) continue;
    area += normal.norm() / 2;
    const auto due = static_cast<std::uint64_t>(area / kSampleArea_m2);
    for (; drawn < due; ++drawn) {
      double u = std::fmod(0.5 + 0.7548776662466927 * static_cast<double>(drawn), 1.0);
      double v = std::fmod(0.5 + 0.5698402909980532 * static_cast<double>(drawn), 1.0);
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      points.push_back({(a + u * ab + v * ac).cast<float>(), normal.normalized().cast<float>(), &solid});
    }
  }
}

}  // namespace

void FeasibleViews::validate() const {
  if (region.isEmpty())
    throw std::invalid_argument("region is empty; its lower corner must be below the upper");
  requireInRange("distance_m", distance_m, 1e-3, 100.0);
  requireInRange("body_radius_m", body_radius_m, 0.0, 10.0);
  requireInRange("directions", directions, 1, 10000);
}

struct SceneTruth::Data {
  SceneFile scene;
  FeasibleViews feasible;
  std::vector<Object> objects;
  std::vector<std::string> names;
  std::once_flag surface_once;
  std::vector<Vector3f> surface;

  bool clear(const Vector3d& p, double radius) const {
    return std::none_of(scene.solids.begin(), scene.solids.end(), [&](const Solid& solid) {
      return solid.bounds().exteriorDistance(p) <= radius && solid.signedDistance(p) < radius;
    });
  }
  bool buried(const SurfacePoint& point) const {
    const Vector3d p = point.p.cast<double>();
    return std::any_of(scene.solids.begin(), scene.solids.end(), [&](const Solid& solid) {
      return &solid != point.solid && solid.bounds().exteriorDistance(p) < kContact_m &&
             solid.signedDistance(p) < kContact_m;
    });
  }
  bool observable(const SurfacePoint& point, const std::vector<Vector3f>& directions,
                  const SceneRays& rays) const;
  void computeSurface();
};

bool SceneTruth::Data::observable(const SurfacePoint& point, const std::vector<Vector3f>& directions,
                                  const SceneRays& rays) const {
  if (buried(point)) return false;
  const Vector3f start = point.p + kStart_m * point.n;
  for (const Vector3f& direction : directions) {
    if (direction.dot(point.n) < 0.05f) continue;
    const Vector3f sensor = point.p + static_cast<float>(feasible.distance_m) * direction;
    if (!feasible.region.contains(sensor.cast<double>())) continue;
    if (rays.segmentFree(start, sensor) && clear(sensor.cast<double>(), feasible.body_radius_m)) return true;
  }
  return false;
}

void SceneTruth::Data::computeSurface() {
  std::vector<SurfacePoint> points;
  for (const Solid& solid : scene.solids)
    if (solid.role() == SolidRole::Object) sampleSurface(solid, points);
  const SceneRays rays(sceneMesh(scene, true));
  const std::vector<Vector3f> directions = sphereDirections(feasible.directions);
  std::vector<std::uint8_t> kept(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(),
                    [&](std::size_t i) { kept[i] = observable(points[i], directions, rays) ? 1 : 0; });
  for (std::size_t i = 0; i < points.size(); ++i)
    if (kept[i]) surface.push_back(points[i].p);
}

SceneTruth::SceneTruth(const SceneFile& scene, const FeasibleViews& feasible)
    : data_(std::make_unique<Data>()) {
  feasible.validate();
  data_->scene = scene;
  data_->feasible = feasible;
  for (const Solid& solid : data_->scene.solids) {
    if (solid.role() != SolidRole::Object) continue;
    const auto same = [&](const Object& object) { return object.name == solid.object(); };
    auto object = std::find_if(data_->objects.begin(), data_->objects.end(), same);
    if (object == data_->objects.end()) {
      data_->names.push_back(solid.object());
      object = data_->objects.insert(object, Object{solid.object(), {}, {}});
    }
    object->solids.push_back(&solid);
    object->bounds.extend(solid.bounds());
  }
}
SceneTruth::~SceneTruth() = default;

double SceneTruth::objectDistance(const Vector3d& p_world) const {
  double distance = std::numeric_limits<double>::infinity();
  for (const Object& object : data_->objects)
    distance = std::min(distance, std::abs(object.signedDistance(p_world, distance)));
  return distance;
}

int SceneTruth::objectAt(const Vector3d& p_world, double within_m) const {
  int nearest = -1;
  double best = within_m;
  for (std::size_t i = 0; i < data_->objects.size(); ++i) {
    const double distance = std::abs(data_->objects[i].signedDistance(p_world, best));
    if (distance > best || (nearest >= 0 && distance == best)) continue;
    best = distance;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

bool SceneTruth::insideSolid(const Vector3d& p_world) const {
  return !data_->clear(p_world, 0.0);
}

std::vector<Box> SceneTruth::knownBoxes() const {
  std::vector<Box> boxes;
  for (const Solid& solid : data_->scene.solids)
    if (solid.role() != SolidRole::Object) boxes.push_back(solid.bounds());
  return boxes;
}

bool SceneTruth::insideKnown(const Vector3d& p_world) const {
  return std::ranges::any_of(data_->scene.solids, [&](const Solid& solid) {
    return solid.role() != SolidRole::Object && solid.bounds().contains(p_world) &&
           solid.signedDistance(p_world) <= 0.0;
  });
}

std::vector<Box> SceneTruth::objectBoxes() const {
  std::vector<Box> boxes;
  for (const Object& object : data_->objects) boxes.push_back(object.bounds);
  return boxes;
}

const std::vector<Vector3f>& SceneTruth::observableSurface() const {
  // Isolated: a waiting thread must not take up another task that asks for the surface too.
  std::call_once(data_->surface_once,
                 [this] { tbb::this_task_arena::isolate([this] { data_->computeSurface(); }); });
  return data_->surface;
}

const std::vector<std::string>& SceneTruth::objectNames() const {
  return data_->names;
}

}  // namespace vantage
