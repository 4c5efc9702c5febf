#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "viewer/app/experiments/b2_first_step.h"

namespace vantage::experiments {

/// Segments with contour points that are no object, against the least salient object (each object as salient
/// as its best segment).
struct NoiseRanks {
  std::size_t others = 0;
  std::size_t above_by_roundness = 0;  ///< of them, above it by d_min/d_max alone
  std::size_t above_by_saliency = 0;   ///< and by eq. (12), with isolation
};
NoiseRanks rankNoise(const FirstStep& first);

/// What makes a cloud noisy: a sensor with faults, no filters, and small segments that stay.
std::vector<std::string> noisySettings();

/// B2 (b), Fig. 9: noisy segments rank lower once isolation is used. Not comparable without a noisy segment
/// that outranks an object by roundness. \param noisy a cloud with noise
Claim judgeNoise(const NoiseRanks& noisy);

}  // namespace vantage::experiments
