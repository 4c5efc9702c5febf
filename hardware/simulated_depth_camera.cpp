#include "hardware/simulated_depth_camera.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "hardware/sensor_faults.h"
#include "io/scene_rays.h"

namespace vantage {
namespace {

using Eigen::Vector3f;

/// What the emitter's ray may miss of the point that the camera sees.
constexpr float kShadowMargin_m = 2e-4f;

/// Standard normal number of a column: a counter through a hash, then Box-Muller. Neighbouring columns share
/// a hash.
float normalNumber(std::uint64_t row_seed, int column) {
  const std::uint64_t bits =
      mixedBits(row_seed ^ (static_cast<std::uint64_t>(column / 2) * 0xd1342543de82ef95u));
  constexpr double kScale = 1.0 / 4294967296.0;
  const double u = (static_cast<double>(bits >> 32) + 0.5) * kScale;
  const double angle = 2 * std::numbers::pi * static_cast<double>(bits & 0xffffffffu) * kScale;
  const double radius = std::sqrt(-2.0 * std::log(u));
  return static_cast<float>(radius * (column % 2 ? std::sin(angle) : std::cos(angle)));
}

/// A row of an image; empty beyond its border.
template <class Image>
auto rowOf(Image& image, int v) {
  const auto width = static_cast<std::size_t>(image.width);
  return v < 0 || v >= image.height
             ? std::span<std::remove_pointer_t<decltype(image.depth_m.data())>>()
             : std::span(image.depth_m.data() + static_cast<std::size_t>(v) * width, width);
}

}  // namespace

void SimulatedCameraConfig::validate() const {
  camera.validate();
  sensor.validate();
}

struct SimulatedDepthCamera::Data {
  SceneRays rays;
  SimulatedCameraConfig config;

  /// Depths along the axis at columns `first`, `first` + 1 / `per_pixel` ... of image row `v`; infinity where
  /// nothing is hit.
  void castRow(const Pose& T_world_camera, double v, double first, int per_pixel, std::span<float> row) const;
  /// 1 where the emitter sees what the camera sees.
  std::vector<std::uint8_t> litPixels(const Pose& T_world_camera, int v, std::span<const float> row) const;
  /// What the sensor makes of row `v` of a true image.
  void measureRow(const Pose& T_world_camera, const DepthImage& truth, int v, std::span<float> row) const;
  void veil(const Pose& T_world_camera, const DepthImage& truth, int v, std::span<const std::uint8_t> lit,
            std::span<float> row) const;
  void addNoise(std::uint64_t index, int v, std::span<float> row) const;
  void applyRange(std::span<float> row) const;
};

void SimulatedDepthCamera::Data::castRow(const Pose& T_world_camera, double v, double first, int per_pixel,
                                         std::span<float> row) const {
  const Eigen::Matrix3d rotation = T_world_camera.linear();
  std::vector<Vector3f> directions(row.size());
  for (std::size_t i = 0; i < row.size(); ++i)  // z = 1, so the ray parameter is the depth
    directions[i] =
        (rotation * config.camera.ray(first + static_cast<double>(i) / per_pixel, v)).cast<float>();
  rays.firstHits(T_world_camera.translation().cast<float>(), directions, row);
}

std::vector<std::uint8_t> SimulatedDepthCamera::Data::litPixels(const Pose& T_world_camera, int v,
                                                                std::span<const float> row) const {
  const Vector3f emitter =
      (T_world_camera * Eigen::Vector3d(-config.sensor.emitter_offset_m, 0, 0)).cast<float>();
  std::vector<Vector3f> points;
  std::vector<std::size_t> columns;
  for (std::size_t u = 0; u < row.size(); ++u)
    if (std::isfinite(row[u])) {
      const Eigen::Vector3d ray = config.camera.ray(static_cast<double>(u), v);
      points.push_back((T_world_camera.translation().cast<float>()) +
                       row[u] * (T_world_camera.linear() * ray).cast<float>());
      columns.push_back(u);
    }
  std::vector<std::uint8_t> seen(points.size()), lit(row.size(), 1);
  rays.visible(emitter, points, kShadowMargin_m, seen);
  for (std::size_t i = 0; i < columns.size(); ++i) lit[columns[i]] = seen[i];
  return lit;
}

void SimulatedDepthCamera::Data::measureRow(const Pose& T_world_camera, const DepthImage& truth, int v,
                                            std::span<float> row) const {
  std::ranges::copy(rowOf(truth, v), row.begin());
  std::vector<std::uint8_t> lit(row.size(), 1);
  if (config.sensor.emitter_shadow) lit = litPixels(T_world_camera, v, row);
  if (config.sensor.faults) {
    corruptShadow(row, lit, config.sensor.emitter_offset_m > 0.0,
                  mixedBits(mixedBits(config.seed) ^ static_cast<std::uint64_t>(v)));
    veil(T_world_camera, truth, v, lit, row);
  } else {
    for (std::size_t u = 0; u < row.size(); ++u)
      if (!lit[u]) row[u] = DepthImage::kInvalid;
  }
}

void SimulatedDepthCamera::Data::veil(const Pose& T_world_camera, const DepthImage& truth, int v,
                                      std::span<const std::uint8_t> lit, std::span<float> row) const {
  constexpr int kSide = kinect_faults::kSubRays, kHalf = kSide / 2;
  const std::span<const float> here = rowOf(truth, v), above = rowOf(truth, v - 1),
                               below = rowOf(truth, v + 1);
  for (std::size_t u = 0; u < row.size(); ++u) {
    if (!lit[u] || !isStep(here, above, below, u)) continue;
    std::array<float, kSide> depths;
    float sum = 0.0f;
    int count = 0;
    for (int i = -kHalf; i <= kHalf; ++i) {
      castRow(T_world_camera, v + static_cast<double>(i) / kSide,
              static_cast<double>(u) - static_cast<double>(kHalf) / kSide, kSide, depths);
      for (const float depth : depths)
        if (std::isfinite(depth)) {
          sum += depth;
          ++count;
        }
    }
    if (count > 0) row[u] = sum / static_cast<float>(count);
  }
}

void SimulatedDepthCamera::Data::addNoise(std::uint64_t index, int v, std::span<float> row) const {
  const auto sigma_1m = static_cast<float>(config.sensor.noise_at_1m_m);
  if (sigma_1m == 0.0f) return;
  const std::uint64_t row_seed =
      mixedBits(mixedBits(mixedBits(config.seed) ^ index) ^ static_cast<std::uint64_t>(v));
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
  DepthImage truth = frame.depth;
  const auto forRows = [&](DepthImage& image, const auto& action) {
    tbb::parallel_for(tbb::blocked_range<int>(0, camera.height, 8), [&](const tbb::blocked_range<int>& rows) {
      for (int v = rows.begin(); v < rows.end(); ++v) action(v, rowOf(image, v));
    });
  };
  forRows(truth, [&](int v, std::span<float> row) { data_->castRow(T_world_camera, v, 0.0, 1, row); });
  forRows(frame.depth, [&](int v, std::span<float> row) {
    data_->measureRow(T_world_camera, truth, v, row);
    data_->addNoise(index, v, row);
    data_->applyRange(row);
  });
  return frame;
}

}  // namespace vantage
