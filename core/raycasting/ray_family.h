#pragma once

#include <cstdint>

namespace vantage {

/// Children of one ray: a run of the next finer level in family order. No Eigen here, the casting kernels
/// read it.
struct RayFamily {
  std::uint32_t first_child = 0;
  std::uint32_t children = 0;
  std::uint32_t leaves = 0;  ///< lf(r)
};

}  // namespace vantage
