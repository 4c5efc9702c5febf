#include "io/scene_rays.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

namespace vantage {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kPacket = 8;

RTCRayHit makeRay(const Vector3f& origin, const Vector3f& direction, float near, float far) {
  RTCRayHit ray = {};
  ray.ray.org_x = origin.x();
  ray.ray.org_y = origin.y();
  ray.ray.org_z = origin.z();
  ray.ray.dir_x = direction.x();
  ray.ray.dir_y = direction.y();
  ray.ray.dir_z = direction.z();
  ray.ray.tnear = near;
  ray.ray.tfar = far;
  ray.ray.mask = 0xffffffffu;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return ray;
}

void setLane(RTCRay8& ray, std::size_t lane, const Vector3f& origin, const Vector3f& direction, float far) {
  ray.org_x[lane] = origin.x();
  ray.org_y[lane] = origin.y();
  ray.org_z[lane] = origin.z();
  ray.dir_x[lane] = direction.x();
  ray.dir_y[lane] = direction.y();
  ray.dir_z[lane] = direction.z();
  ray.tnear[lane] = 0.0f;
  ray.tfar[lane] = far;
  ray.mask[lane] = 0xffffffffu;
}

/// Closest point of a triangle (Ericson, Real-Time Collision Detection, 5.1.5), as a distance.
double distanceToTriangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.norm();
  const Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.norm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).norm();
  const Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.norm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).norm();
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).norm();
  return std::abs(ab.cross(ac).normalized().dot(ap));
}

}  // namespace

struct SceneRays::Data {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  TriangleMesh mesh;

  ~Data() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void build();
  double distanceTo(std::uint32_t triangle, const Vector3d& p) const {
    const auto& t = mesh.triangles[triangle];
    return distanceToTriangle(p, mesh.vertices[t[0]].cast<double>(), mesh.vertices[t[1]].cast<double>(),
                              mesh.vertices[t[2]].cast<double>());
  }
  bool oddCrossings(const Vector3f& p, const Vector3f& direction) const;
};

void SceneRays::Data::build() {
  device = rtcNewDevice(nullptr);
  if (!device)
    throw std::runtime_error("Embree: cannot start, error " +
                             std::to_string(static_cast<int>(rtcGetDeviceError(nullptr))));
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(Vector3f), mesh.vertices.size());
  void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(std::uint32_t), mesh.triangles.size());
  const bool allocated = vertices && triangles;
  if (allocated) {
    std::memcpy(vertices, mesh.vertices.data(), mesh.vertices.size() * sizeof(Vector3f));
    std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(std::uint32_t));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
  }
  rtcReleaseGeometry(geometry);
  if (!allocated) throw std::runtime_error("Embree: the mesh does not fit in memory");
  rtcCommitScene(scene);
}

bool SceneRays::Data::oddCrossings(const Vector3f& p, const Vector3f& direction) const {
  bool odd = false;
  float near = 0.0f;
  for (int crossing = 0; crossing < 1000; ++crossing) {
    RTCRayHit ray = makeRay(p, direction, near, kInfinity);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
    odd = !odd;
    near = std::nextafter(ray.ray.tfar, kInfinity) + 1e-6f;
  }
  return odd;
}

SceneRays::SceneRays(const TriangleMesh& mesh) : data_(std::make_unique<Data>()) {
  data_->mesh.vertices = mesh.vertices;
  data_->mesh.triangles = mesh.triangles;
  if (!mesh.empty()) data_->build();
}
SceneRays::~SceneRays() = default;
SceneRays::SceneRays(SceneRays&&) noexcept = default;
SceneRays& SceneRays::operator=(SceneRays&&) noexcept = default;

void SceneRays::firstHits(const Vector3f& origin, std::span<const Vector3f> directions,
                          std::span<float> t) const {
  std::fill(t.begin(), t.end(), kInfinity);
  if (!data_->scene) return;
  alignas(32) RTCRayHit8 packet = {};
  alignas(32) std::array<int, kPacket> active;
  for (std::size_t start = 0; start < directions.size(); start += kPacket) {
    const std::size_t count = std::min(kPacket, directions.size() - start);
    active.fill(0);
    for (std::size_t lane = 0; lane < count; ++lane) {
      active[lane] = -1;
      setLane(packet.ray, lane, origin, directions[start + lane], kInfinity);
      packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(active.data(), data_->scene, &context, &packet);
    for (std::size_t lane = 0; lane < count; ++lane)
      if (packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID) t[start + lane] = packet.ray.tfar[lane];
  }
}

void SceneRays::visible(const Vector3f& from, std::span<const Vector3f> targets, float margin_m,
                        std::span<std::uint8_t> result) const {
  std::fill(result.begin(), result.end(), std::uint8_t{1});
  if (!data_->scene) return;
  alignas(32) RTCRay8 packet = {};
  alignas(32) std::array<int, kPacket> active;
  for (std::size_t start = 0; start < targets.size(); start += kPacket) {
    const std::size_t count = std::min(kPacket, targets.size() - start);
    active.fill(0);
    for (std::size_t lane = 0; lane < count; ++lane) {
      const Vector3f path = targets[start + lane] - from;
      const float far = 1.0f - margin_m / std::max(path.norm(), 1e-9f);
      active[lane] = far > 0.0f ? -1 : 0;
      setLane(packet, lane, from, path, far);
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded8(active.data(), data_->scene, &context, &packet);
    for (std::size_t lane = 0; lane < count; ++lane)
      if (active[lane] && packet.tfar[lane] < 0.0f) result[start + lane] = 0;
  }
}

bool SceneRays::segmentFree(const Vector3f& from, const Vector3f& to) const {
  if (!data_->scene) return true;
  RTCRay ray = makeRay(from, to - from, 0.0f, 1.0f).ray;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(data_->scene, &context, &ray);
  return ray.tfar >= 0.0f;
}

double SceneRays::distance(const Vector3d& p) const {
  if (!data_->scene) return std::numeric_limits<double>::infinity();
  struct Search {
    const Data* data;
    Vector3d p;
    double best;
  } search = {data_.get(), p, std::numeric_limits<double>::infinity()};
  RTCPointQuery query = {};
  query.x = static_cast<float>(p.x());
  query.y = static_cast<float>(p.y());
  query.z = static_cast<float>(p.z());
  query.radius = kInfinity;
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  const auto visit = [](RTCPointQueryFunctionArguments* arguments) {
    auto& s = *static_cast<Search*>(arguments->userPtr);
    const double d = s.data->distanceTo(arguments->primID, s.p);
    if (d >= s.best) return false;
    s.best = d;
    arguments->query->radius = std::nextafter(static_cast<float>(d), kInfinity);
    return true;
  };
  rtcPointQuery(data_->scene, &query, &context, visit, &search);
  return search.best;
}

bool SceneRays::inside(const Vector3d& p) const {
  if (!data_->scene) return false;
  static const std::array<Vector3f, 5> directions = {
      Vector3f(0.211f, 0.137f, 0.968f), Vector3f(-0.853f, 0.331f, 0.404f), Vector3f(0.417f, -0.806f, 0.420f),
      Vector3f(0.690f, 0.623f, -0.368f), Vector3f(-0.302f, -0.517f, -0.801f)};
  int odd = 0;
  for (const Vector3f& direction : directions) odd += data_->oddCrossings(p.cast<float>(), direction) ? 1 : 0;
  return odd >= 3;
}

}  // namespace vantage
