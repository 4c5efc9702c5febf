#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace vantage {

/// Triangle mesh in world coordinates, metres; triangles counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< one RGB colour per triangle, or empty
  bool empty() const { return triangles.empty(); }
};

}  // namespace vantage
