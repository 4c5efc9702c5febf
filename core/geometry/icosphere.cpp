#include "core/geometry/icosphere.h"

#include <map>
#include <numbers>
#include <utility>

#include "core/geometry/check.h"

namespace vantage {
namespace {

using Face = std::array<std::uint32_t, 3>;

/// Cyclic permutations of (0, +-1, +-phi).
Icosphere icosahedron() {
  constexpr double p = std::numbers::phi;
  Icosphere sphere;
  for (const Eigen::Vector3d& v :
       {Eigen::Vector3d(-1, p, 0), Eigen::Vector3d(1, p, 0), Eigen::Vector3d(-1, -p, 0),
        Eigen::Vector3d(1, -p, 0), Eigen::Vector3d(0, -1, p), Eigen::Vector3d(0, 1, p),
        Eigen::Vector3d(0, -1, -p), Eigen::Vector3d(0, 1, -p), Eigen::Vector3d(p, 0, -1),
        Eigen::Vector3d(p, 0, 1), Eigen::Vector3d(-p, 0, -1), Eigen::Vector3d(-p, 0, 1)})
    sphere.vertices.push_back(v.normalized());
  sphere.faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                  {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                  {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return sphere;
}

/// Vertices in the middles of edges, each made once.
class EdgeMiddles {
 public:
  explicit EdgeMiddles(std::vector<Eigen::Vector3d>& vertices) : vertices_(vertices) {}

  std::uint32_t operator()(std::uint32_t a, std::uint32_t b) {
    const auto [entry, is_new] =
        known_.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(vertices_.size()));
    if (is_new) vertices_.push_back((vertices_[a] + vertices_[b]).normalized());
    return entry->second;
  }

 private:
  std::vector<Eigen::Vector3d>& vertices_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known_;
};

/// Every face becomes its three corners and its middle.
void subdivide(Icosphere& sphere) {
  EdgeMiddles middle(sphere.vertices);
  std::vector<Face> finer;
  finer.reserve(4 * sphere.faces.size());
  for (const auto& [a, b, c] : sphere.faces) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  sphere.faces = std::move(finer);
}

}  // namespace

Icosphere makeIcosphere(int subdivisions) {
  requireInRange("icosphere subdivisions", subdivisions, 0, 6);
  Icosphere sphere = icosahedron();
  for (int n = 0; n < subdivisions; ++n) subdivide(sphere);
  return sphere;
}

std::vector<Eigen::Vector3d> faceDirections(const Icosphere& sphere) {
  std::vector<Eigen::Vector3d> directions;
  directions.reserve(sphere.faces.size());
  for (const auto& [a, b, c] : sphere.faces)
    directions.push_back((sphere.vertices[a] + sphere.vertices[b] + sphere.vertices[c]).normalized());
  return directions;
}

}  // namespace vantage
