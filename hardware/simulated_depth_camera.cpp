#include "hardware/simulated_depth_camera.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "io/scene_rays.h"

namespace vantage {
namespace {

using Eigen::Vector3f;

/// What the emitter's ray may miss of the point that the camera sees.
constexpr float kShadowMargin_m = 2e-4f;

/// Mixes bits well (Steele, Lea & Flood 2014, splitmix64).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Standard normal number of a column: a counter through a hash, then Box-Muller. Neighbouring columns share
/// a hash.
float normalNumber(std::uint64_t row_seed, int column) {
  const std::uint64_t bits = mixed(row_seed ^ (static_cast<std::uint64_t>(column / 2) * 0xd1342543de82ef95u));
  constexpr double kScale = 1.0 / 4294967296.0;
  const double u = (static_cast<double>(bits >> 32) + 0.5) * kScale;
  const double angle = 2 * std::numbers::pi * static_cast<double>(bits & 0xffffffffu) * kScale;
  const double radius = std::sqrt(-2.0 * std::log(u));
  return static_cast<float>(radius * (column % 2 ? std::sin(angle) : std::cos(angle)));
}

}  // namespace

void SimulatedCameraConfig::validate() const {
  camera.validate();
  sensor.validate();
}

struct SimulatedDepthCamera::Data {
  SceneRays rays;
  SimulatedCameraConfig config;

  /// Depth along the axis of one row, infinity where nothing is hit; NaN where the emitter has no sight.
  void trueRow(const Pose& T_world_camera, int v, std::span<float> row) const;
  void addNoise(std::uint64_t index, int v, std::span<float> row) const;
  void applyRange(std::span<float> row) const;
};

void SimulatedDepthCamera::Data::trueRow(const Pose& T_world_camera, int v, std::span<float> row) const {
  const Eigen::Matrix3d rotation = T_world_camera.linear();
  const Vector3f origin = T_world_camera.translation().cast<float>();
  std::vector<Vector3f> directions(row.size());
  for (std::size_t u = 0; u < row.size(); ++u)  // z = 1, so the ray parameter is the depth
    directions[u] = (rotation * config.camera.ray(static_cast<double>(u), v)).cast<float>();
  rays.firstHits(origin, directions, row);
  if (!config.sensor.emitter_shadow) return;

  const Vector3f emitter =
      (T_world_camera * Eigen::Vector3d(-config.sensor.emitter_offset_m, 0, 0)).cast<float>();
  std::vector<Vector3f> points;
  std::vector<std::size_t> columns;
  for (std::size_t u = 0; u < row.size(); ++u)
    if (std::isfinite(row[u])) {
      points.push_back(origin + row[u] * directions[u]);
      columns.push_back(u);
    }
  std::vector<std::uint8_t> lit(points.size());
  rays.visible(emitter, points, kShadowMargin_m, lit);
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (!lit[i]) row[columns[i]] = DepthImage::kInvalid;
}

void SimulatedDepthCamera::Data::addNoise(std::uint64_t index, int v, std::span<float> row) const {
  const auto sigma_1m = static_cast<float>(config.sensor.noise_at_1m_m);
  if (sigma_1m == 0.0f) return;
  const std::uint64_t row_seed = mixed(mixed(mixed(config.seed) ^ index) ^ static_cast<std::uint64_t>(v));
  for (std::size_t u = 0; u < row.size(); ++u)
    if (std::isfinite(row[u]))
      row[u] += sigma_1m * row[u] * row[u] * normalNumber(row_seed, static_cast<int>(u));
}

void SimulatedDepthCamera::Data::applyRange(std::span<float> row) const {
  const auto low = static_cast<float>(config.camera.min_range_m);
  const auto high = static_cast<float>(config.camera.max_range_m);
  for (float& depth : row)
    if (!(depth >= low && depth <= high && depth > 0.0f)) depth = DepthImage::kInvalid;
}

SimulatedDepthCamera::SimulatedDepthCamera(const SceneFile& scene, const SimulatedCameraConfig& config) {
  config.validate();
  data_.reset(new Data{SceneRays(sceneMesh(scene, true)), config});
}
SimulatedDepthCamera::~SimulatedDepthCamera() = default;

const PinholeCamera& SimulatedDepthCamera::model() const {
  return data_->config.camera;
}

std::optional<DepthFrame> SimulatedDepthCamera::capture(const Pose& T_world_camera, std::uint64_t index) {
  const PinholeCamera& camera = data_->config.camera;
  DepthFrame frame;
  frame.depth = DepthImage(camera.width, camera.height);
  frame.T_world_camera = T_world_camera;
  const auto width = static_cast<std::size_t>(camera.width);
  tbb::parallel_for(tbb::blocked_range<int>(0, camera.height, 8), [&](const tbb::blocked_range<int>& rows) {
    for (int v = rows.begin(); v < rows.end(); ++v) {
      const std::span<float> row(frame.depth.depth_m.data() + static_cast<std::size_t>(v) * width, width);
      data_->trueRow(T_world_camera, v, row);
      data_->addNoise(index, v, row);
      data_->applyRange(row);
    }
  });
  return frame;
}

}  // namespace vantage
