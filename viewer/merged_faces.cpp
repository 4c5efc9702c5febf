#include "viewer/merged_faces.h"

#include <tbb/parallel_for.h>

#include <bit>
#include <limits>

#include "viewer/face_rows.h"

namespace vantage {
namespace {

/// Axes of the planes of a side: its normal and the two in the plane.
struct PlaneAxes {
  int normal, u, v;
};
constexpr PlaneAxes kAxes[3] = {{0, 1, 2}, {1, 0, 2}, {2, 0, 1}};

/// Sides whose outside sees (u, v) mirrored.
constexpr bool isMirrored(int side) {
  return side == 0 || side == 3 || side == 4;
}

/// A face within its plane.
struct Cell {
  std::int32_t u, v;
};

/// Faces of one side in one plane, by v, then u.
struct Plane {
  int side = 0;
  int at = 0;  ///< of the corners, along the normal
  std::vector<Cell> cells;
};

/// Corners from (u0, v0) to (u1, v1).
struct Rectangle {
  std::int32_t u0, u1, v0, v1;
};

/// Runs of faces along u, joined where the next rows repeat them.
std::vector<Rectangle> mergeCells(const std::vector<Cell>& cells) {
  std::vector<Rectangle> done, open, row;
  std::int32_t row_v = 0;
  const auto close_row = [&] {
    std::vector<Rectangle> next;
    std::size_t o = 0;
    for (Rectangle run : row) {
      while (o < open.size() && open[o].u0 < run.u0) done.push_back(open[o++]);
      if (o < open.size() && open[o].u0 == run.u0) {
        if (open[o].u1 == run.u1 && open[o].v1 == run.v0)
          run.v0 = open[o].v0;
        else
          done.push_back(open[o]);
        ++o;
      }
      next.push_back(run);
    }
    done.insert(done.end(), open.begin() + static_cast<std::ptrdiff_t>(o), open.end());
    open = std::move(next);
    row.clear();
  };
  for (const Cell& cell : cells) {
    if (!row.empty() && cell.v != row_v) close_row();
    row_v = cell.v;
    if (!row.empty() && row.back().u1 == cell.u)
      ++row.back().u1;
    else
      row.push_back({cell.u, cell.u + 1, cell.v, cell.v + 1});
  }
  if (!row.empty()) close_row();
  done.insert(done.end(), open.begin(), open.end());
  return done;
}

/// A set of corners of the lattice over a range of voxels, each with its rank.
class CornerSet {
 public:
  explicit CornerSet(const VoxelRange& range)
      : size_(range.end - range.begin + Eigen::Vector3i::Ones()),
        words_((static_cast<std::size_t>(size_.x()) * size_.y() * size_.z() + 63) / 64, 0) {}

  void add(const Eigen::Vector3i& corner) {
    const std::size_t slot = slotOf(corner);
    words_[slot / 64] |= std::uint64_t{1} << (slot % 64);
  }
  bool has(const Eigen::Vector3i& corner) const {
    const std::size_t slot = slotOf(corner);
    return words_[slot / 64] >> (slot % 64) & 1;
  }
  /// Call once after the last add().
  void rank() {
    before_.resize(words_.size());
    std::uint32_t count = 0;
    for (std::size_t w = 0; w < words_.size(); ++w) {
      before_[w] = count;
      count += static_cast<std::uint32_t>(std::popcount(words_[w]));
    }
    count_ = count;
  }
  std::uint32_t count() const { return count_; }
  std::uint32_t rankOf(const Eigen::Vector3i& corner) const {
    const std::size_t slot = slotOf(corner);
    const std::uint64_t below = (std::uint64_t{1} << (slot % 64)) - 1;
    return before_[slot / 64] + static_cast<std::uint32_t>(std::popcount(words_[slot / 64] & below));
  }
  /// Calls visit(corner) by ascending rank.
  template <class Visit>
  void forEach(Visit&& visit) const {
    for (std::size_t w = 0; w < words_.size(); ++w) {
      for (std::uint64_t left = words_[w]; left; left &= left - 1) {
        const std::size_t slot = w * 64 + static_cast<std::size_t>(std::countr_zero(left));
        const std::size_t row = slot / size_.x();
        visit(Eigen::Vector3i(static_cast<int>(slot % size_.x()), static_cast<int>(row % size_.y()),
                              static_cast<int>(row / size_.y())));
      }
    }
  }

 private:
  std::size_t slotOf(const Eigen::Vector3i& c) const {
    return (static_cast<std::size_t>(c.z()) * size_.y() + c.y()) * size_.x() + c.x();
  }

  Eigen::Vector3i size_;
  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> before_;
  std::uint32_t count_ = 0;
};

/// Triangles of one plane. Vertices from kMiddle on are middles of rectangles, counted from there.
struct PlaneMesh {
  static constexpr std::uint32_t kMiddle = std::uint32_t{1} << 31;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Eigen::Vector3f> middles;  ///< in lattice units
};

/// Where rectangles of a plane lie in the lattice.
Eigen::Vector3i cornerAt(const Plane& plane, std::int32_t u, std::int32_t v) {
  const PlaneAxes& axes = kAxes[plane.side / 2];
  Eigen::Vector3i corner;
  corner[axes.normal] = plane.at;
  corner[axes.u] = u;
  corner[axes.v] = v;
  return corner;
}

/// The outline of a rectangle through all corners of the set that lie on it, and where its own four stand.
struct Outline {
  std::vector<std::uint32_t> points;
  std::array<std::size_t, 5> own;  ///< the last one is the end
};

void traceOutline(const Plane& plane, const Rectangle& r, const CornerSet& corners, Outline& outline) {
  outline.points.clear();
  const auto edge = [&](std::int32_t u, std::int32_t v, std::int32_t du, std::int32_t dv,
                        std::int32_t steps) {
    outline.points.push_back(corners.rankOf(cornerAt(plane, u, v)));
    for (std::int32_t s = 1; s < steps; ++s) {
      const Eigen::Vector3i at = cornerAt(plane, u + s * du, v + s * dv);
      if (corners.has(at)) outline.points.push_back(corners.rankOf(at));
    }
  };
  outline.own[0] = 0;
  edge(r.u0, r.v0, 1, 0, r.u1 - r.u0);
  outline.own[1] = outline.points.size();
  edge(r.u1, r.v0, 0, 1, r.v1 - r.v0);
  outline.own[2] = outline.points.size();
  edge(r.u1, r.v1, -1, 0, r.u1 - r.u0);
  outline.own[3] = outline.points.size();
  edge(r.u0, r.v1, 0, -1, r.v1 - r.v0);
  outline.own[4] = outline.points.size();
}

/// A corner whose two edges bear no further points, so that a fan from it has no empty triangles; -1 if there
/// is none.
int fanCorner(const Outline& outline) {
  for (int c = 0; c < 4; ++c) {
    const int before = (c + 3) % 4;
    if (outline.own[c + 1] - outline.own[c] == 1 && outline.own[before + 1] - outline.own[before] == 1)
      return c;
  }
  return -1;
}

void addTriangle(PlaneMesh& mesh, bool mirrored, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (mirrored)
    mesh.triangles.push_back({a, c, b});
  else
    mesh.triangles.push_back({a, b, c});
}

PlaneMesh meshPlane(const Plane& plane, const std::vector<Rectangle>& rectangles, const CornerSet& corners) {
  PlaneMesh mesh;
  mesh.triangles.reserve(2 * rectangles.size());
  const bool mirrored = isMirrored(plane.side);
  Outline outline;
  for (const Rectangle& r : rectangles) {
    traceOutline(plane, r, corners, outline);
    const std::size_t count = outline.points.size();
    const auto point = [&](std::size_t n) { return outline.points[n % count]; };
    if (const int c = fanCorner(outline); c >= 0) {
      const std::size_t first = outline.own[c];
      for (std::size_t n = 1; n + 1 < count; ++n)
        addTriangle(mesh, mirrored, point(first), point(first + n), point(first + n + 1));
      continue;
    }
    const auto middle = PlaneMesh::kMiddle + static_cast<std::uint32_t>(mesh.middles.size());
    mesh.middles.push_back((cornerAt(plane, r.u0, r.v0) + cornerAt(plane, r.u1, r.v1)).cast<float>() / 2.0f);
    for (std::size_t n = 0; n < count; ++n) addTriangle(mesh, mirrored, middle, point(n), point(n + 1));
  }
  return mesh;
}

/// All faces of a range by side and plane; within a plane they come by v, then u.
std::vector<Plane> facesByPlane(const StateGrid& grid, VoxelState of, FaceRule rule, const VoxelRange& range,
                                std::size_t& total) {
  const int layers = range.end.z() - range.begin.z();
  std::vector<std::vector<VoxelFace>> faces(layers);
  tbb::parallel_for(0, layers, [&](int layer) {
    faces[layer] = facesOfLayer(grid, of, rule, range, range.begin.z() + layer);
  });
  const Eigen::Vector3i size = range.end - range.begin;
  std::array<std::size_t, 7> first{};
  for (int side = 0; side < 6; ++side) first[side + 1] = first[side] + size[side / 2];
  std::vector<Plane> planes(first[6]);
  for (int side = 0; side < 6; ++side) {
    for (int n = 0; n < size[side / 2]; ++n) {
      planes[first[side] + n].side = side;
      planes[first[side] + n].at = n + side % 2;
    }
  }
  total = 0;
  for (int layer = 0; layer < layers; ++layer) {
    total += faces[layer].size();
    for (const VoxelFace& face : faces[layer]) {
      const Eigen::Vector3i voxel(face.i - range.begin.x(), face.j - range.begin.y(), layer);
      const PlaneAxes& axes = kAxes[face.side / 2];
      planes[first[face.side] + voxel[axes.normal]].cells.push_back({voxel[axes.u], voxel[axes.v]});
    }
  }
  return planes;
}

/// World positions of lattice corners and of the middles of rectangles.
void placeCorners(const GridGeometry& geometry, const VoxelRange& range, const CornerSet& corners,
                  const std::vector<PlaneMesh>& meshes, MergedFaces& merged) {
  const double voxel = geometry.voxel_size_m;
  const Eigen::Vector3d low = geometry.center(range.begin) - Eigen::Vector3d::Constant(voxel / 2);
  merged.corners.reserve(corners.count());
  corners.forEach([&](const Eigen::Vector3i& at) {
    merged.corners.push_back((low + voxel * at.cast<double>()).cast<float>());
  });
  for (const PlaneMesh& mesh : meshes)
    for (const Eigen::Vector3f& at : mesh.middles)
      merged.corners.push_back((low + voxel * at.cast<double>()).cast<float>());
}

}  // namespace

MergedFaces extractMergedFaces(const StateGrid& grid, VoxelState of, FaceRule rule, const Box& clip_world) {
  MergedFaces merged;
  const VoxelRange range = voxelsIn(grid.geometry(), clip_world);
  if (range.empty()) return merged;
  const std::vector<Plane> planes = facesByPlane(grid, of, rule, range, merged.faces);
  std::vector<std::vector<Rectangle>> rectangles(planes.size());
  tbb::parallel_for(std::size_t{0}, planes.size(),
                    [&](std::size_t n) { rectangles[n] = mergeCells(planes[n].cells); });
  CornerSet corners(range);
  for (std::size_t n = 0; n < planes.size(); ++n) {
    merged.rectangles += rectangles[n].size();
    for (const Rectangle& r : rectangles[n]) {
      for (const auto& [u, v] : {std::pair{r.u0, r.v0}, {r.u1, r.v0}, {r.u0, r.v1}, {r.u1, r.v1}})
        corners.add(cornerAt(planes[n], u, v));
    }
  }
  corners.rank();
  std::vector<PlaneMesh> meshes(planes.size());
  tbb::parallel_for(std::size_t{0}, planes.size(),
                    [&](std::size_t n) { meshes[n] = meshPlane(planes[n], rectangles[n], corners); });
  placeCorners(grid.geometry(), range, corners, meshes, merged);
  std::uint32_t middle = corners.count();
  for (const PlaneMesh& mesh : meshes) {
    for (std::array<std::uint32_t, 3> triangle : mesh.triangles) {
      for (std::uint32_t& corner : triangle)
        if (corner >= PlaneMesh::kMiddle) corner = corner - PlaneMesh::kMiddle + middle;
      merged.triangles.push_back(triangle);
    }
    middle += static_cast<std::uint32_t>(mesh.middles.size());
  }
  return merged;
}

}  // namespace vantage
