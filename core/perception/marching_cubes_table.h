#pragma once

#include <array>
#include <cstdint>

namespace vantage {

// A cube's corner c has offset (c & 1, c >> 1 & 1, c >> 2 & 1). Its edge e runs along axis e / 4 from
// cubeEdgeStart(e); the two low bits of e are the offsets in the next two axes, cyclically.

/// Lower corner of a cube edge, 0..11.
constexpr int cubeEdgeStart(int edge) {
  const int axis = edge / 4;
  return (edge & 1) << ((axis + 1) % 3) | (edge >> 1 & 1) << ((axis + 2) % 3);
}

/// Triangles of one configuration of inside corners, as cube edges, counter-clockwise seen from outside.
struct CubeTriangles {
  std::uint8_t count = 0;
  std::array<std::array<std::uint8_t, 3>, 6> triangles{};
};

/// Triangles of all 256 configurations; bit c of the index = corner c is inside. On a face with two inside
/// corners in opposition each is cut off by itself, on both sides of the face: surfaces have no holes.
const std::array<CubeTriangles, 256>& marchingCubesTable();

}  // namespace vantage
