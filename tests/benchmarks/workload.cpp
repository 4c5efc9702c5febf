#include "tests/benchmarks/workload.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace vantage::benchmarks {
namespace {

using Eigen::Vector3d;

const Vector3d kCenter(0, 0, 0.10);

/// Parameter at which a ray meets a box from outside, or leaves it from inside; infinite if it does neither.
double meetBox(const Vector3d& o, const Vector3d& d, const Box& box, bool inside) {
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    double first = (box.min()[a] - o[a]) / d[a], second = (box.max()[a] - o[a]) / d[a];
    if (first > second) std::swap(first, second);
    enter = std::max(enter, first);
    leave = std::min(leave, second);
  }
  if (inside) return leave;
  return enter < leave && enter > 0 ? enter : std::numeric_limits<double>::infinity();
}

double meetSphere(const Vector3d& o, const Vector3d& d, const Vector3d& center, double radius) {
  const Vector3d m = o - center;
  const double a = d.squaredNorm(), b = m.dot(d), q = b * b - a * (m.squaredNorm() - radius * radius);
  const double t = q >= 0 ? (-b - std::sqrt(q)) / a : -1;
  return t > 0 ? t : std::numeric_limits<double>::infinity();
}

double firstSurface(const Vector3d& o, const Vector3d& d) {
  double t = meetBox(o, d, Box(Vector3d(-2, -2, -0.8), Vector3d(2, 2, 2)), true);  // the room
  const Box solids[] = {Box(Vector3d(-1, -0.66, -0.04), Vector3d(1, 0.66, 0)),     // table
                        Box(Vector3d(-0.9, 0.5, 0), Vector3d(0.9, 0.54, 0.6)),     // panel
                        Box(Vector3d(-0.4, -0.1, 0), Vector3d(-0.22, 0.1, 0.25)),
                        Box(Vector3d(0.2, 0.0, 0), Vector3d(0.45, 0.15, 0.15))};
  for (const Box& box : solids) t = std::min(t, meetBox(o, d, box, false));
  t = std::min(t, meetSphere(o, d, {0.0, -0.2, 0.1}, 0.1));
  return std::min(t, meetSphere(o, d, {0.3, 0.08, 0.24}, 0.09));
}

}  // namespace

DepthImage tabletopDepth(const PinholeCamera& camera, const Pose& T_world_camera) {
  DepthImage image(camera.width, camera.height);
  tbb::parallel_for(0, camera.height, [&](int v) {
    for (int u = 0; u < camera.width; ++u)
      image.at(u, v) = static_cast<float>(
          firstSurface(T_world_camera.translation(), T_world_camera.linear() * camera.ray(u, v)));
  });
  return image;
}

GridGeometry tabletopGeometry() {
  return {Vector3d(-1.5, -1.0, -0.05), 3.0 / 512, Eigen::Vector3i(512, 341, 200)};
}

GridGeometry w1Geometry() {
  return {Vector3d(-1.0, -0.66, -0.3), 0.0058, Eigen::Vector3i(345, 228, 207)};
}

std::vector<Pose> scanPoses(int count) {
  std::vector<Pose> poses;
  const double elevation = std::numbers::pi / 6;
  for (int n = 0; n < count; ++n) {
    const double azimuth = 0.6 / std::cos(elevation) * ((n + 0.5) / count - 0.5);
    const Vector3d out(std::sin(azimuth) * std::cos(elevation), -std::cos(azimuth) * std::cos(elevation),
                       std::sin(elevation));
    poses.push_back(lookAt(kCenter + out, kCenter));
  }
  return poses;
}

const TsdfVolume& scannedTabletop() {
  static const TsdfVolume scanned = [] {
    TsdfVolume volume(tabletopGeometry());
    const PinholeCamera camera;
    for (const Pose& pose : scanPoses(30)) {
      clearSphere(volume, pose.translation(), 0.3);
      fuseDepth(volume, tabletopDepth(camera, pose), camera, pose, {});
    }
    return volume;
  }();
  return scanned;
}

std::vector<Pose> tabletopViews() {
  std::vector<Pose> views;
  for (int n = 0; n < 24; ++n) {
    const double azimuth = std::numbers::pi * (-0.5 + 0.9 * ((n * 7 % 24) / 23.0 - 0.5));
    const double elevation = (15.0 + 10.0 * (n % 5)) * std::numbers::pi / 180;
    const Vector3d out(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                       std::sin(elevation));
    const Vector3d target(0.3 * ((n % 3) - 1), 0.05 * (n % 4), 0.1);
    views.push_back(lookAt(target + 0.8 * out, target, n % 8 * std::numbers::pi / 4));
  }
  return views;
}

}  // namespace vantage::benchmarks
