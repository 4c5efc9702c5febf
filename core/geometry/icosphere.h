#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace vantage {

/// Icosahedron whose faces are split in four, `subdivisions` times, and its vertices put on the unit sphere:
/// 20 * 4^n faces.
struct Icosphere {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> faces;  ///< counter-clockwise seen from outside
};

/// \param subdivisions 0..6. \throws std::invalid_argument otherwise.
Icosphere makeIcosphere(int subdivisions);

/// Unit vectors to the middles of the faces, in their order (D-A21).
std::vector<Eigen::Vector3d> faceDirections(const Icosphere& sphere);

}  // namespace vantage
