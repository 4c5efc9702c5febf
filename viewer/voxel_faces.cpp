#include "viewer/voxel_faces.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <unordered_map>

#include "viewer/face_rows.h"

namespace vantage {
namespace {

/// Corners of the six faces, in the order -x +x -y +y -z +z, counter-clockwise from outside.
constexpr int kCorner[6][4][3] = {
    {{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0}}, {{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}},
    {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}, {{0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0}},
    {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

/// What the passes share: the range and the corner lattice over it.
class FaceExtractor {
 public:
  FaceExtractor(const StateGrid& grid, VoxelState of, FaceRule rule, const VoxelRange& range)
      : grid_(grid), geometry_(grid.geometry()), of_(of), rule_(rule), range_(range) {
    corners_x_ = range.end.x() - range.begin.x() + 1;
    corners_y_ = range.end.y() - range.begin.y() + 1;
  }

  FaceMesh run() {
    const int layers = range_.end.z() - range_.begin.z();
    faces_.resize(layers);
    tbb::parallel_for(0, layers, [&](int layer) {
      faces_[layer] = facesOfLayer(grid_, of_, rule_, range_, range_.begin.z() + layer);
    });
    corner_ids_.resize(layers + 1);
    std::vector<std::uint32_t> corner_count(layers + 1);
    tbb::parallel_for(0, layers + 1, [&](int plane) { corner_count[plane] = numberCorners(plane); });
    return assemble(corner_count);
  }

 private:
  std::size_t cornerSlot(const VoxelFace& face, int corner) const {
    const int* c = kCorner[face.side][corner];
    return static_cast<std::size_t>(face.j - range_.begin.y() + c[1]) * corners_x_ +
           (face.i - range_.begin.x() + c[0]);
  }

  /// Gives the corners used on one plane of the lattice ids in the order of their position.
  std::uint32_t numberCorners(int plane) {
    std::vector<std::uint32_t>& ids = corner_ids_[plane];
    for (const int below : {1, 0}) {  // the layer under the plane touches it with its upper corners
      const int layer = plane - below;
      if (layer < 0 || layer >= static_cast<int>(faces_.size()) || faces_[layer].empty()) continue;
      if (ids.empty()) ids.assign(static_cast<std::size_t>(corners_x_) * corners_y_, 0);
      for (const VoxelFace& face : faces_[layer]) {
        for (int corner = 0; corner < 4; ++corner) {
          if (kCorner[face.side][corner][2] == below) ids[cornerSlot(face, corner)] = 1;
        }
      }
    }
    std::uint32_t count = 0;
    for (std::uint32_t& id : ids) id = id ? ++count : 0;  // 1-based, 0 = not used
    return count;
  }

  FaceMesh assemble(const std::vector<std::uint32_t>& corner_count) const {
    const int layers = static_cast<int>(faces_.size());
    std::vector<std::uint32_t> first_corner(layers + 2, 0), first_quad(layers + 1, 0);
    for (int p = 0; p <= layers; ++p) first_corner[p + 1] = first_corner[p] + corner_count[p];
    for (int l = 0; l < layers; ++l)
      first_quad[l + 1] = first_quad[l] + static_cast<std::uint32_t>(faces_[l].size());
    FaceMesh mesh;
    mesh.corners.resize(first_corner[layers + 1]);
    mesh.quads.resize(first_quad[layers]);
    const double voxel = geometry_.voxel_size_m;
    const Eigen::Vector3d low = geometry_.center(range_.begin) - Eigen::Vector3d::Constant(voxel / 2);
    tbb::parallel_for(0, layers + 1, [&](int plane) {
      const std::vector<std::uint32_t>& ids = corner_ids_[plane];
      for (std::size_t slot = 0; slot < ids.size(); ++slot) {
        if (!ids[slot]) continue;
        const Eigen::Vector3d at(static_cast<double>(slot % corners_x_),
                                 static_cast<double>(slot / corners_x_), plane);
        mesh.corners[first_corner[plane] + ids[slot] - 1] = (low + voxel * at).cast<float>();
      }
    });
    tbb::parallel_for(0, layers, [&](int layer) {
      std::uint32_t quad = first_quad[layer];
      for (const VoxelFace& face : faces_[layer]) {
        for (int corner = 0; corner < 4; ++corner) {
          const int plane = layer + kCorner[face.side][corner][2];
          mesh.quads[quad][corner] = first_corner[plane] + corner_ids_[plane][cornerSlot(face, corner)] - 1;
        }
        ++quad;
      }
    });
    return mesh;
  }

  const StateGrid& grid_;
  const GridGeometry& geometry_;
  VoxelState of_;
  FaceRule rule_;
  VoxelRange range_;
  int corners_x_ = 0, corners_y_ = 0;
  std::vector<std::vector<VoxelFace>> faces_;           ///< per layer of voxels
  std::vector<std::vector<std::uint32_t>> corner_ids_;  ///< per plane of corners; empty if none is used
};

}  // namespace

FaceMesh extractFaces(const StateGrid& grid, VoxelState of, FaceRule rule, const Box& clip_world) {
  const VoxelRange range = voxelsIn(grid.geometry(), clip_world);
  if (range.empty()) return {};
  return FaceExtractor(grid, of, rule, range).run();
}

FaceMesh facesOf(const GridGeometry& grid, const std::vector<std::size_t>& voxels) {
  FaceMesh mesh;
  std::unordered_map<std::uint64_t, std::uint32_t> corners;
  const Eigen::Vector3d low = grid.origin_m - Eigen::Vector3d::Constant(grid.voxel_size_m / 2);
  const auto corner = [&](const Eigen::Vector3i& at) {
    const std::uint64_t key =
        (static_cast<std::uint64_t>(at.z()) * (grid.size.y() + 1) + at.y()) * (grid.size.x() + 1) + at.x();
    const auto [entry, is_new] = corners.try_emplace(key, static_cast<std::uint32_t>(mesh.corners.size()));
    if (is_new) mesh.corners.push_back((low + grid.voxel_size_m * at.cast<double>()).cast<float>());
    return entry->second;
  };
  for (const std::size_t index : voxels) {
    const Eigen::Vector3i voxel = grid.voxel(index);
    for (int side = 0; side < 6; ++side) {
      Eigen::Vector3i neighbour = voxel;
      neighbour[side / 2] += side % 2 ? 1 : -1;
      if (grid.contains(neighbour) && std::ranges::binary_search(voxels, grid.index(neighbour))) continue;
      auto& quad = mesh.quads.emplace_back();
      for (int c = 0; c < 4; ++c)
        quad[c] = corner(voxel + Eigen::Map<const Eigen::Vector3i>(kCorner[side][c]));
    }
  }
  return mesh;
}

std::vector<std::array<std::uint32_t, 2>> edgesOf(const FaceMesh& faces) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(4 * faces.quads.size());
  for (const auto& quad : faces.quads) {
    for (int c = 0; c < 4; ++c) {
      const auto [low, high] = std::minmax(quad[c], quad[(c + 1) % 4]);
      edges.push_back({low, high});
    }
  }
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace vantage
