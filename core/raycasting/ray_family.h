#pragma once

#include <cstdint>

namespace vantage {

/// Children of one ray: a block of rows and columns of the next finer level. No Eigen here, the casting
/// kernels read it.
struct RayFamily {
  std::uint32_t first_child = 0;  ///< RayLevel::index() of the block's first row and column
  std::uint16_t rows = 0, columns = 0;
  std::uint32_t leaves = 0;  ///< lf(r)
};

}  // namespace vantage
