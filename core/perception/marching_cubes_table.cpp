#include "core/perception/marching_cubes_table.h"

#include <cassert>
#include <utility>
#include <vector>

namespace vantage {

namespace {

/// The edge between two neighbouring corners.
int edgeBetween(int a, int b) {
  for (int edge = 0; edge < 12; ++edge) {
    const int start = cubeEdgeStart(edge), end = start | 1 << (edge / 4);
    if ((a == start && b == end) || (a == end && b == start)) return edge;
  }
  assert(false);
  return -1;
}

/// Corners of the face at offset `side` of `axis`, counter-clockwise seen from outside the cube.
std::array<int, 4> faceCorners(int axis, int side) {
  const int u = 1 << ((axis + 1) % 3), v = 1 << ((axis + 2) % 3), base = side << axis;
  if (side == 1) return {base, base | u, base | u | v, base | v};
  return {base, base | v, base | u | v, base | u};
}

/// The cut edge that follows each cut edge around the surface, -1 for edges that are not cut. Walking around
/// a face, each run of inside corners is entered through one edge and left through another: they are joined.
std::array<int, 12> successors(int inside) {
  std::array<int, 12> next;
  next.fill(-1);
  const auto in = [&](int corner) { return (inside >> corner & 1) != 0; };
  for (int face = 0; face < 6; ++face) {
    const std::array<int, 4> corner = faceCorners(face / 2, face % 2);
    for (int i = 0; i < 4; ++i) {
      if (in(corner[i]) || !in(corner[(i + 1) % 4])) continue;
      int last = (i + 1) % 4;
      while (in(corner[(last + 1) % 4])) last = (last + 1) % 4;
      next[edgeBetween(corner[i], corner[(i + 1) % 4])] = edgeBetween(corner[last], corner[(last + 1) % 4]);
    }
  }
  return next;
}

bool shareFace(int a, int b) {
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2, side = face % 2;
    const auto on = [&](int edge) { return edge / 4 != axis && (cubeEdgeStart(edge) >> axis & 1) == side; };
    if (on(a) && on(b)) return true;
  }
  return false;
}

/// Start of the fan with the fewest diagonals inside a face of the cube, where the neighbour might draw the
/// same.
std::size_t bestFanStart(const std::vector<int>& loop) {
  std::size_t best = 0, fewest = loop.size();
  for (std::size_t start = 0; start < loop.size(); ++start) {
    std::size_t diagonals = 0;
    for (std::size_t k = 2; k + 1 < loop.size(); ++k) {
      diagonals += shareFace(loop[start], loop[(start + k) % loop.size()]);
    }
    if (diagonals < fewest) best = start, fewest = diagonals;
  }
  return best;
}

CubeTriangles triangulate(int inside) {
  CubeTriangles result;
  std::array<int, 12> next = successors(inside);
  for (int first = 0; first < 12; ++first) {
    std::vector<int> loop;
    for (int edge = first; next[edge] >= 0;) {
      loop.push_back(edge);
      edge = std::exchange(next[edge], -1);
    }
    if (loop.empty()) continue;
    const std::size_t start = bestFanStart(loop);
    const auto at = [&](std::size_t k) { return static_cast<std::uint8_t>(loop[(start + k) % loop.size()]); };
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
      assert(result.count < result.triangles.size());
      result.triangles[result.count++] = {at(0), at(k), at(k + 1)};
    }
  }
  return result;
}

}  // namespace

const std::array<CubeTriangles, 256>& marchingCubesTable() {
  static const std::array<CubeTriangles, 256> table = [] {
    std::array<CubeTriangles, 256> all;
    for (int inside = 0; inside < 256; ++inside) all[inside] = triangulate(inside);
    return all;
  }();
  return table;
}

}  // namespace vantage
