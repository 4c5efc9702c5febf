#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "core/perception/depth_filters.h"
#include "core/run_control.h"
#include "io/config_file.h"

namespace vantage::experiments {

/// What is left of an image of planes.
struct PlanesResult {
  std::uint64_t valid = 0;     ///< points inside the workspace
  std::uint64_t outliers = 0;  ///< of them farther than 3 cm from every plane that faces the camera
  std::uint64_t lost = 0;      ///< points on planes that the bilateral filter alone keeps
  MaskCounts removed;          ///< in the whole image
  double rate() const {
    return valid == 0 ? 0.0 : static_cast<double>(outliers) / static_cast<double>(valid);
  }
};

/// The planes scene of B3 (evaluation.md, section 5): seen once, from the first pose of its initial scan, by
/// a sensor with faults.
class PlanesScene {
 public:
  /// \param tune changes the settings; may be empty
  explicit PlanesScene(const std::function<void(Settings&)>& tune);
  ~PlanesScene();

  /// Constants of the filters.
  const DepthFilterConfig& filters() const;
  /// Mean of 30 frames, pixel by pixel over those that are valid.
  DepthImage meanDepth(std::uint64_t seed, const RunControl& control) const;
  FilteredDepth filtered(const DepthImage& depth, const DepthFilterConfig& config) const;
  /// \param smooth result of the bilateral filter alone
  PlanesResult measure(const FilteredDepth& smooth, const FilteredDepth& filtered) const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

}  // namespace vantage::experiments
