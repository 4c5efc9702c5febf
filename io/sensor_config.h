#pragma once

namespace vantage {

/// What a simulated depth camera does to true depth.
struct SensorNoiseConfig {
  double noise_at_1m_m =
      0.002;  ///< standard deviation at 1 m, metres, 0 = none; grows with the square of depth
  bool emitter_shadow = true;  ///< pixels that the emitter does not light are invalid
  /// The faults of a Kinect V2 (hardware/sensor_faults.h): a wrong depth where the emitter does not light,
  /// instead of none, and the mean of both sides at depth steps.
  bool faults = false;
  double emitter_offset_m =
      0.08;  ///< emitter to the left of the camera, metres, -1..1; negative = to the right
  bool operator==(const SensorNoiseConfig&) const = default;
  /// \throws std::invalid_argument naming field, value and range.
  void validate() const;
};

}  // namespace vantage
