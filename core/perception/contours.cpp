#include "core/perception/contours.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "core/geometry/check.h"
#include "core/perception/voxel_masks.h"

namespace vantage {

namespace {

using Word = std::uint64_t;

bool before(const Eigen::Vector3i& a, const Eigen::Vector3i& b) {
  return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
}

/// Eq. (2) for the 64 voxels of one word; rows outside the one-voxel margin only.
class ContourTest {
 public:
  ContourTest(const VoxelMasks& masks, const ContourConfig& config) : masks_(masks), config_(config) {}

  Word operator()(int y, int z, int w) const {
    const Word empty = masks_.known(y, z)[w] & masks_.positive(y, z)[w] & inside(w);
    if (empty == 0) return 0;
    const Word frontier = empty & nextToUnknown(y, z, w);
    if (frontier == 0) return 0;
    return frontier & nextToOccupied(y, z, w);
  }

 private:
  /// Bits 1 .. size-2 of the row.
  Word inside(int w) const {
    const int last = masks_.size().x() - 2 - 64 * w;  // highest allowed bit of this word
    if (last < 0) return 0;
    Word bits = last >= 63 ? ~Word{0} : (Word{2} << last) - 1;
    return w == 0 ? bits & ~Word{1} : bits;
  }

  Word nextToUnknown(int y, int z, int w) const {
    const Word* row = masks_.known(y, z);
    Word known = fromPrevious(row, w) & fromNext(row, w);
    for (const auto& [dy, dz] : kSides) known &= masks_.known(y + dy, z + dz)[w];
    if (!config_.unknown_eighteen_neighbours) return ~known;
    for (const auto& [dy, dz] : kSides) {
      const Word* side = masks_.known(y + dy, z + dz);
      known &= fromPrevious(side, w) & fromNext(side, w);
    }
    for (const auto& [dy, dz] : kCorners) known &= masks_.known(y + dy, z + dz)[w];
    return ~known;
  }

  Word nextToOccupied(int y, int z, int w) const {
    Word found = occupiedBefore(y, z, w) | occupiedAfter(y, z, w);
    for (const auto& [dy, dz] : kSides) found |= occupied(y + dy, z + dz, w);
    if (config_.occupied_six_neighbours) return found;
    for (const auto& [dy, dz] : kSides) {
      found |= occupiedBefore(y + dy, z + dz, w) | occupiedAfter(y + dy, z + dz, w);
    }
    for (const auto& [dy, dz] : kCorners) found |= occupied(y + dy, z + dz, w);
    return found;
  }

  Word occupied(int y, int z, int w) const { return masks_.known(y, z)[w] & ~masks_.positive(y, z)[w]; }
  Word occupiedBefore(int y, int z, int w) const {
    return fromPrevious(masks_.known(y, z), w) & ~fromPrevious(masks_.positive(y, z), w);
  }
  Word occupiedAfter(int y, int z, int w) const {
    return fromNext(masks_.known(y, z), w) & ~fromNext(masks_.positive(y, z), w);
  }

  static constexpr std::array<std::array<int, 2>, 4> kSides{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  static constexpr std::array<std::array<int, 2>, 4> kCorners{{{-1, -1}, {-1, 1}, {1, -1}, {1, 1}}};

  const VoxelMasks& masks_;
  const ContourConfig& config_;
};

/// Eq. (5)-(6), Monica & Aleotti 2017, not normalised; points toward well-observed empty space (D-B2).
Eigen::Vector3f frontierNormal(const TsdfVolume& volume, const Eigen::Vector3i& e, int threshold) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx == 0 && dy == 0 && dz == 0) continue;
        const TsdfVoxel& c = volume.at(e.x() + dx, e.y() + dy, e.z() + dz);
        const bool occupied = c.weight >= threshold && c.value <= 0;
        const int weight = occupied ? -threshold : std::min(c.weight - threshold, threshold);
        const Eigen::Vector3d offset(dx, dy, dz);
        sum += weight / offset.norm() * offset;
      }
    }
  }
  return sum.cast<float>();
}

/// Eq. (4) at the occupied voxel closest to an empty one, not normalised (D-B5); of equally close ones the
/// first in (x, y, z) order. Eq. (2) puts one among the 18 neighbours.
Eigen::Vector3f surfaceNormal(const TsdfVolume& volume, const Eigen::Vector3i& e, int threshold) {
  std::optional<Eigen::Vector3i> closest;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        const Eigen::Vector3i offset(dx, dy, dz);
        const TsdfVoxel& c = volume.at(e + offset);
        if (c.weight < threshold || c.value > 0) continue;
        if (!closest || offset.squaredNorm() < closest->squaredNorm()) closest = offset;
      }
    }
  }
  return closest ? tsdfGradient(volume, e + *closest) : Eigen::Vector3f::Zero().eval();
}

void appendRow(const TsdfVolume& volume, const ContourTest& test, const ContourConfig& config, int words,
               int y, int z, std::vector<ContourVoxel>& out) {
  for (int w = 0; w < words; ++w) {
    for (Word bits = test(y, z, w); bits != 0; bits &= bits - 1) {
      ContourVoxel found;
      found.voxel = {64 * w + std::countr_zero(bits), y, z};
      found.raw_normal = config.normal == ContourNormal::Surface
                             ? surfaceNormal(volume, found.voxel, config.weight_threshold)
                             : frontierNormal(volume, found.voxel, config.weight_threshold);
      const float length = found.raw_normal.norm();
      if (!(length > 1e-4f)) continue;  // D-B2: no direction, no contour voxel
      found.normal = found.raw_normal / length;
      out.push_back(found);
    }
  }
}

std::vector<ContourVoxel> findContourVoxels(const TsdfVolume& volume, const ContourConfig& config) {
  const Eigen::Vector3i& size = volume.geometry().size;
  std::vector<ContourVoxel> voxels;
  if ((size.array() < 3).any()) return voxels;
  const VoxelMasks masks(volume, config.weight_threshold);
  const ContourTest test(masks, config);
  std::vector<std::vector<ContourVoxel>> of_slab(size.z());
  tbb::parallel_for(1, size.z() - 1, [&](int z) {
    for (int y = 1; y < size.y() - 1; ++y) {
      appendRow(volume, test, config, masks.wordsPerRow(), y, z, of_slab[z]);
    }
  });
  for (const auto& slab : of_slab) voxels.insert(voxels.end(), slab.begin(), slab.end());
  std::sort(voxels.begin(), voxels.end(),
            [](const auto& a, const auto& b) { return before(a.voxel, b.voxel); });
  return voxels;
}

/// Region growing from one seed; every candidate is compared with the seed (D-B4).
class RegionGrowing {
 public:
  RegionGrowing(std::vector<ContourVoxel>& voxels, const GridGeometry& geometry, const ContourConfig& config)
      : voxels_(voxels), geometry_(geometry), grouped_(voxels.size(), 0) {
    max_squared_voxels_ = std::pow(config.group_distance_m / geometry.voxel_size_m, 2);
    min_cosine_ = std::cos(config.group_angle_rad);
    index_of_.reserve(voxels.size());
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      index_of_.emplace(geometry.index(voxels[i].voxel), static_cast<std::uint32_t>(i));
    }
  }

  std::vector<ContourPoint> run() {
    std::vector<ContourPoint> points;
    for (std::uint32_t seed = 0; seed < voxels_.size(); ++seed) {
      if (!grouped_[seed]) points.push_back(grow(seed, static_cast<std::uint32_t>(points.size())));
    }
    return points;
  }

 private:
  ContourPoint grow(std::uint32_t seed, std::uint32_t group) {
    members_.assign(1, seed);
    grouped_[seed] = 1;
    for (std::size_t k = 0; k < members_.size(); ++k) addNeighbours(seed, members_[k]);
    std::sort(members_.begin(), members_.end());

    Eigen::Vector3d position = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
    for (const std::uint32_t member : members_) {
      position += geometry_.center(voxels_[member].voxel);
      normal += voxels_[member].normal.cast<double>();
      voxels_[member].group = group;
    }
    ContourPoint point;
    point.position_m = position / static_cast<double>(members_.size());
    const bool cancels = normal.norm() < 1e-9;  // only with A_th near pi
    point.normal = cancels ? voxels_[seed].normal.cast<double>().normalized() : normal.normalized();
    point.voxels = static_cast<std::uint32_t>(members_.size());
    return point;
  }

  void addNeighbours(std::uint32_t seed, std::uint32_t from) {
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          const auto found =
              index_of_.find(geometry_.index(voxels_[from].voxel + Eigen::Vector3i(dx, dy, dz)));
          if (found == index_of_.end() || grouped_[found->second]) continue;
          if (!similar(voxels_[seed], voxels_[found->second])) continue;
          grouped_[found->second] = 1;
          members_.push_back(found->second);
        }
      }
    }
  }

  // Eq. (7) as the text means it (D-B3); signed, so opposite normals never join.
  bool similar(const ContourVoxel& a, const ContourVoxel& b) const {
    const double distance2 = (a.voxel - b.voxel).squaredNorm();
    const double cosine = a.normal.cast<double>().dot(b.normal.cast<double>());
    return distance2 < max_squared_voxels_ && cosine > min_cosine_;
  }

  std::vector<ContourVoxel>& voxels_;
  const GridGeometry& geometry_;
  double max_squared_voxels_ = 0.0, min_cosine_ = 0.0;
  std::vector<std::uint8_t> grouped_;
  std::vector<std::uint32_t> members_;
  std::unordered_map<std::size_t, std::uint32_t> index_of_;
};

}  // namespace

void ContourConfig::validate() const {
  requireInRange("contours.weight_threshold", weight_threshold, 1, 1000);
  requireInRange("contours.group_distance_m", group_distance_m, 1e-6, 10.0);
  requireInRange("contours.group_angle_rad", group_angle_rad, 1e-6, std::numbers::pi);
}

Contours extractContours(const TsdfVolume& volume, const ContourConfig& config) {
  config.validate();
  Contours contours;
  contours.voxels = findContourVoxels(volume, config);
  contours.points = RegionGrowing(contours.voxels, volume.geometry(), config).run();
  return contours;
}

Eigen::Vector3f tsdfGradient(const TsdfVolume& volume, const Eigen::Vector3i& voxel, bool skip_unknown) {
  const GridGeometry& geometry = volume.geometry();
  const float here = volume.at(voxel).distance();
  Eigen::Vector3f gradient;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3i next = voxel, previous = voxel;
    ++next[axis];
    --previous[axis];
    const auto usable = [&](const Eigen::Vector3i& v) {
      return v[axis] >= 0 && v[axis] < geometry.size[axis] && (!skip_unknown || volume.at(v).weight > 0);
    };
    const bool has_next = usable(next), has_previous = usable(previous);
    // A one-sided difference spans one voxel instead of two: doubled, it weighs as much as the other axes.
    const float scale = has_next && has_previous ? 1.0f : 2.0f;
    const float high = has_next ? volume.at(next).distance() : here;
    const float low = has_previous ? volume.at(previous).distance() : here;
    gradient[axis] = scale * (high - low);
  }
  return gradient;
}

}  // namespace vantage
