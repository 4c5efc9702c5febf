#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/exploration/ports.h"
#include "io/scene_file.h"
#include "io/sensor_config.h"

namespace vantage {

struct SimulatedCameraConfig {
  PinholeCamera camera;  ///< image, optics and range; the range limits the measured depth (along the axis)
  SensorNoiseConfig sensor;  ///< noise and emitter shadow
  std::uint64_t seed = 1;    ///< of the noise

  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

/// Depth camera in a scene file: one ray through the centre of every pixel. A pixel is invalid (NaN) where
/// the ray leaves the scene, where the emitter, a point beside the camera, cannot see what the camera sees
/// (D-B30), and where the measurement lies outside the range. Noise is Gaussian with a standard deviation of
/// `noise_at_1m_m * z^2`. With faults (hardware/sensor_faults.h) what the emitter does not light has a wrong
/// depth instead of none, and pixels at depth steps mix both sides. The same seed, index and pose give the
/// same frame, bit for bit, for any thread count.
class SimulatedDepthCamera : public DepthCamera {
 public:
  /// Takes a copy of the scene's surfaces, room included. \throws std::invalid_argument as validate().
  SimulatedDepthCamera(const SceneFile& scene, const SimulatedCameraConfig& config);
  ~SimulatedDepthCamera() override;

  const PinholeCamera& model() const override;
  /// Always a frame; capture() is const in effect and may run on many threads.
  std::optional<DepthFrame> capture(const Pose& T_world_camera, std::uint64_t index) override;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

}  // namespace vantage
