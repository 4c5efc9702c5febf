#include "core/perception/surface_cloud.h"

#include <tbb/parallel_for.h>

#include <bit>

#include "core/geometry/check.h"
#include "core/perception/contours.h"
#include "core/perception/marching_cubes_table.h"
#include "core/perception/voxel_masks.h"

namespace vantage {

namespace {

using Word = std::uint64_t;

/// Cut voxel edges of one word of a row: bit x of cut[a] = the edge from voxel x to its next along axis a
/// carries a vertex. Vertices are numbered row by row, in a word along x, y, then z.
struct EdgeWord {
  std::array<Word, 3> cut{};
  std::uint32_t first = 0;  ///< id of the first vertex of this word

  std::uint32_t vertices() const {
    return std::popcount(cut[0]) + std::popcount(cut[1]) + std::popcount(cut[2]);
  }
  std::uint32_t id(int axis, int bit) const {
    std::uint32_t id = first + std::popcount(cut[axis] & ((Word{1} << bit) - 1));
    for (int a = 0; a < axis; ++a) id += std::popcount(cut[a]);
    return id;
  }
};

class MarchingCubes {
 public:
  MarchingCubes(const TsdfVolume& volume, int weight_threshold)
      : volume_(volume),
        size_(volume.geometry().size),
        masks_(volume, weight_threshold),
        words_(masks_.wordsPerRow()) {}

  SurfaceCloud run() {
    findCells();
    findEdges();
    SurfaceCloud cloud;
    placeVertices(cloud);
    connect(cloud);
    return cloud;
  }

 private:
  std::size_t rows() const { return static_cast<std::size_t>(size_.y()) * size_.z(); }
  std::size_t row(int y, int z) const { return static_cast<std::size_t>(z) * size_.y() + y; }
  /// Cells of row (y, z) whose eight corners are known; zero rows outside the grid. Padded as VoxelMasks.
  const Word* cells(int y, int z) const {
    if (y < 0 || z < 0) return no_cells_.data() + 1;
    return cells_.data() + 1 + row(y, z) * (words_ + 1);
  }

  void findCells() {
    cells_.assign(1 + rows() * (words_ + 1), 0);
    no_cells_.assign(words_ + 2, 0);
    tbb::parallel_for(0, size_.z() - 1, [&](int z) {
      for (int y = 0; y + 1 < size_.y(); ++y) {
        Word* out = cells_.data() + 1 + row(y, z) * (words_ + 1);
        for (int w = 0; w < words_; ++w) {
          Word known = ~Word{0};
          for (const Word* corner_row : {masks_.known(y, z), masks_.known(y + 1, z), masks_.known(y, z + 1),
                                         masks_.known(y + 1, z + 1)}) {
            known &= corner_row[w] & fromNext(corner_row, w);
          }
          out[w] = known;
        }
      }
    });
  }

  /// Edges with a sign change that belong to at least one known cell; then the numbering of their vertices.
  void findEdges() {
    edges_.resize(rows() * words_);
    std::vector<std::uint32_t> of_row(rows() + 1, 0);
    tbb::parallel_for(0, size_.z(), [&](int z) {
      for (int y = 0; y < size_.y(); ++y) of_row[row(y, z) + 1] = cutRow(y, z);
    });
    for (std::size_t r = 0; r < rows(); ++r) of_row[r + 1] += of_row[r];
    tbb::parallel_for(std::size_t{0}, rows(), [&](std::size_t r) {
      std::uint32_t id = of_row[r];
      if (of_row[r + 1] == id) return;
      for (int w = 0; w < words_; ++w) {
        edges_[r * words_ + w].first = id;
        id += edges_[r * words_ + w].vertices();
      }
    });
    vertices_ = of_row.back();
  }

  std::uint32_t cutRow(int y, int z) {
    const Word* here = masks_.positive(y, z);
    const Word* cell = cells(y, z);
    const Word* cell_y = cells(y - 1, z);
    const Word* cell_z = cells(y, z - 1);
    const Word* cell_yz = cells(y - 1, z - 1);
    std::uint32_t count = 0;
    for (int w = 0; w < words_; ++w) {
      EdgeWord& edge = edges_[row(y, z) * words_ + w];
      const Word near_z = cell[w] | fromPrevious(cell, w);
      edge.cut[0] = (here[w] ^ fromNext(here, w)) & (cell[w] | cell_y[w] | cell_z[w] | cell_yz[w]);
      if (y + 1 < size_.y()) {
        edge.cut[1] =
            (here[w] ^ masks_.positive(y + 1, z)[w]) & (near_z | cell_z[w] | fromPrevious(cell_z, w));
      }
      if (z + 1 < size_.z()) {
        edge.cut[2] =
            (here[w] ^ masks_.positive(y, z + 1)[w]) & (near_z | cell_y[w] | fromPrevious(cell_y, w));
      }
      count += edge.vertices();
    }
    return count;
  }

  void placeVertices(SurfaceCloud& cloud) const {
    cloud.points.resize(vertices_);
    cloud.normals.resize(vertices_);
    tbb::parallel_for(0, size_.z(), [&](int z) {
      for (int y = 0; y < size_.y(); ++y) {
        for (int w = 0; w < words_; ++w) {
          const EdgeWord& edge = edges_[row(y, z) * words_ + w];
          std::uint32_t id = edge.first;
          for (int axis = 0; axis < 3; ++axis) {
            for (Word bits = edge.cut[axis]; bits != 0; bits &= bits - 1) {
              placeVertex({64 * w + std::countr_zero(bits), y, z}, axis, cloud.points[id], cloud.normals[id]);
              ++id;
            }
          }
        }
      }
    });
  }

  void placeVertex(const Eigen::Vector3i& voxel, int axis, Eigen::Vector3f& point,
                   Eigen::Vector3f& normal) const {
    const Eigen::Vector3i next = voxel + Eigen::Vector3i::Unit(axis);
    const double a = volume_.at(voxel).value, b = volume_.at(next).value;  // one is > 0, the other is not
    const double t = a / (a - b);
    const Eigen::Vector3d grid = voxel.cast<double>() + t * Eigen::Vector3d::Unit(axis);
    const GridGeometry& geometry = volume_.geometry();
    point = (geometry.origin_m + geometry.voxel_size_m * grid).cast<float>();

    const Eigen::Vector3f gradient = static_cast<float>(1.0 - t) * tsdfGradient(volume_, voxel) +
                                     static_cast<float>(t) * tsdfGradient(volume_, next);
    const float length = gradient.norm();
    // Where the gradients cancel (sheets thinner than a voxel) the sign change along the edge still has a
    // side.
    normal = length > 1e-6f ? Eigen::Vector3f(gradient / length)
                            : Eigen::Vector3f((b > a ? 1.0f : -1.0f) * Eigen::Vector3f::Unit(axis));
  }

  void connect(SurfaceCloud& cloud) const {
    using Triangles = std::vector<std::array<std::uint32_t, 3>>;
    std::vector<Triangles> of_slab(size_.z());
    tbb::parallel_for(0, size_.z() - 1, [&](int z) {
      for (int y = 0; y + 1 < size_.y(); ++y) {
        for (int w = 0; w < words_; ++w) connectWord(y, z, w, of_slab[z]);
      }
    });
    std::size_t total = 0;
    for (const Triangles& slab : of_slab) total += slab.size();
    cloud.triangles.reserve(total);
    for (const Triangles& slab : of_slab)
      cloud.triangles.insert(cloud.triangles.end(), slab.begin(), slab.end());
  }

  void connectWord(int y, int z, int w, std::vector<std::array<std::uint32_t, 3>>& out) const {
    const Word known = cells(y, z)[w];
    if (known == 0) return;
    std::array<Word, 8> positive;
    Word any = 0, all = ~Word{0};
    for (int corner = 0; corner < 8; ++corner) {
      const Word* corner_row = masks_.positive(y + (corner >> 1 & 1), z + (corner >> 2));
      positive[corner] = corner & 1 ? fromNext(corner_row, w) : corner_row[w];
      any |= positive[corner];
      all &= positive[corner];
    }
    for (Word bits = known & any & ~all; bits != 0; bits &= bits - 1) {
      const int bit = std::countr_zero(bits);
      int inside = 0;
      for (int corner = 0; corner < 8; ++corner)
        inside |= static_cast<int>(~positive[corner] >> bit & 1) << corner;
      const CubeTriangles& cube = table_[inside];
      for (int k = 0; k < cube.count; ++k) {
        const auto& e = cube.triangles[k];
        const Eigen::Vector3i cell(64 * w + bit, y, z);
        out.push_back({vertexOf(cell, e[0]), vertexOf(cell, e[1]), vertexOf(cell, e[2])});
      }
    }
  }

  std::uint32_t vertexOf(const Eigen::Vector3i& cell, int cube_edge) const {
    const int corner = cubeEdgeStart(cube_edge);
    const int x = cell.x() + (corner & 1), y = cell.y() + (corner >> 1 & 1), z = cell.z() + (corner >> 2);
    return edges_[row(y, z) * words_ + x / 64].id(cube_edge / 4, x % 64);
  }

  const TsdfVolume& volume_;
  const Eigen::Vector3i size_;
  const VoxelMasks masks_;
  const int words_;
  const std::array<CubeTriangles, 256>& table_ = marchingCubesTable();
  std::vector<Word> cells_, no_cells_;
  std::vector<EdgeWord> edges_;
  std::uint32_t vertices_ = 0;
};

}  // namespace

SurfaceCloud extractSurface(const TsdfVolume& volume, int weight_threshold) {
  requireInRange("surface weight threshold", weight_threshold, 1, 60000);
  if ((volume.geometry().size.array() < 2).any()) return {};
  return MarchingCubes(volume, weight_threshold).run();
}

}  // namespace vantage
