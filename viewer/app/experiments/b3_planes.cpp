#include "viewer/app/experiments/b3_planes.h"

#include <algorithm>
#include <vector>

#include "hardware/simulated_depth_camera.h"
#include "io/scene_file.h"

namespace vantage::experiments {
namespace {

constexpr int kFrames = 30;
constexpr double kOutlier_m = 0.03;

/// Planes of all faces that the eye is in front of, each once. The room has none.
std::vector<Eigen::Hyperplane<double, 3>> planesSeen(const SceneFile& scene, const Eigen::Vector3d& eye) {
  std::vector<Eigen::Hyperplane<double, 3>> planes;
  for (const Solid& solid : scene.solids) {
    if (solid.role() == SolidRole::Room) continue;
    const TriangleMesh& mesh = solid.mesh();
    for (const auto& t : mesh.triangles) {
      const auto corner = [&](int i) -> Eigen::Vector3d { return mesh.vertices[t[i]].cast<double>(); };
      const Eigen::Vector3d outward = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
      const Eigen::Hyperplane<double, 3> plane(outward, corner(0));
      if (plane.signedDistance(eye) <= 0.0) continue;
      const auto same = [&](const auto& known) { return known.isApprox(plane, 1e-6); };
      if (std::ranges::none_of(planes, same)) planes.push_back(plane);
    }
  }
  return planes;
}

}  // namespace

struct PlanesScene::Data {
  SceneFile scene = loadScene("b3_planes");
  Settings settings;
  Pose T_world_camera;
  std::vector<Eigen::Hyperplane<double, 3>> planes;

  enum class Point { Outside, OnPlane, Outlier };
  Point at(const DepthImage& depth, int u, int v) const {
    const float z = depth.at(u, v);
    if (!DepthImage::valid(z)) return Point::Outside;
    const Eigen::Vector3d p = T_world_camera * (settings.camera.ray(u, v) * z);
    if (!settings.exploration.workspace.contains(p)) return Point::Outside;
    const auto near = [&](const auto& plane) { return plane.absDistance(p) <= kOutlier_m; };
    return std::ranges::any_of(planes, near) ? Point::OnPlane : Point::Outlier;
  }
};

PlanesScene::PlanesScene(const std::function<void(Settings&)>& tune) {
  auto data = std::make_unique<Data>();
  applyScene(data->settings, data->scene);
  data->settings.sensor.faults = data->settings.sensor.emitter_shadow = true;
  if (tune) tune(data->settings);
  data->settings.validate();
  data->T_world_camera = initialScanPoses(data->settings.exploration.scan).front();
  data->planes = planesSeen(data->scene, data->T_world_camera.translation());
  data_ = std::move(data);
}
PlanesScene::~PlanesScene() = default;

const DepthFilterConfig& PlanesScene::filters() const {
  return data_->settings.exploration.filter;
}

DepthImage PlanesScene::meanDepth(std::uint64_t seed, const RunControl& control) const {
  SimulatedDepthCamera camera(data_->scene, {data_->settings.camera, data_->settings.sensor, seed});
  DepthImage mean(data_->settings.camera.width, data_->settings.camera.height);
  std::vector<double> sum(mean.depth_m.size(), 0.0);
  std::vector<int> count(mean.depth_m.size(), 0);
  for (int f = 0; f < kFrames; ++f) {
    control.check();
    const DepthFrame frame = *camera.capture(data_->T_world_camera, static_cast<std::uint64_t>(f));
    for (std::size_t i = 0; i < sum.size(); ++i)
      if (DepthImage::valid(frame.depth.depth_m[i])) {
        sum[i] += frame.depth.depth_m[i];
        ++count[i];
      }
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    if (count[i] > 0) mean.depth_m[i] = static_cast<float>(sum[i] / count[i]);
  return mean;
}

FilteredDepth PlanesScene::filtered(const DepthImage& depth, const DepthFilterConfig& config) const {
  return filterDepth(depth, data_->settings.camera, config);
}

PlanesResult PlanesScene::measure(const FilteredDepth& smooth, const FilteredDepth& filtered) const {
  PlanesResult result;
  result.removed = countMask(filtered.mask);
  for (int v = 0; v < smooth.depth.height; ++v)
    for (int u = 0; u < smooth.depth.width; ++u) {
      const Data::Point before = data_->at(smooth.depth, u, v), now = data_->at(filtered.depth, u, v);
      result.valid += now != Data::Point::Outside;
      result.outliers += now == Data::Point::Outlier;
      result.lost += before == Data::Point::OnPlane && now == Data::Point::Outside;
    }
  return result;
}

}  // namespace vantage::experiments
