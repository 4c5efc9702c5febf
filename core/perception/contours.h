#pragma once

#include <cstdint>
#include <vector>

#include "core/volume/tsdf_volume.h"

namespace vantage {

/// Which normal a contour voxel gets, against which its views look.
enum class ContourNormal {
  Frontier,  ///< eq. (5)-(6): toward well-observed empty space, "view C"
  Surface    ///< eq. (4) at the closest occupied voxel, "view B" (D-B5): the ablation
};

/// Contour extraction and reduction (eq. 2, 5-7, Monica & Aleotti 2017).
struct ContourConfig {
  int weight_threshold = 5;        ///< W_th, observations, 1..1000: a voxel is known from here on
  double group_distance_m = 0.02;  ///< D_th, metres, > 0
  double group_angle_rad = 0.52359877559829887;  ///< A_th, radians in (0, pi]; 30 deg
  bool occupied_six_neighbours = false;          ///< ablation of D-B1: N6 instead of N18 for occupied
  bool unknown_eighteen_neighbours = false;      ///< ablation of D-B1: N18 instead of N6 for unknown
  ContourNormal normal = ContourNormal::Frontier;
  bool operator==(const ContourConfig&) const = default;
  void validate() const;
};

/// An empty voxel next to both unknown and occupied space.
struct ContourVoxel {
  Eigen::Vector3i voxel;
  Eigen::Vector3f raw_normal;  ///< eq. (5)-(6), or eq. (4), before normalisation
  Eigen::Vector3f normal;      ///< unit; the frontier normal points toward well-observed empty space
  std::uint32_t group = 0;     ///< index of its contour point
};

/// Mean of a group of similar contour voxels.
struct ContourPoint {
  Eigen::Vector3d position_m;  ///< world
  Eigen::Vector3d normal;      ///< unit, world
  std::uint32_t voxels = 0;    ///< size of the group
};

struct Contours {
  std::vector<ContourVoxel> voxels;  ///< ascending (x, y, z) index: x slowest
  std::vector<ContourPoint> points;  ///< in the order of their seeds
};

/// Contour voxels and points of a map; empty for an empty map. A margin of one voxel is excluded (D-B1).
/// Deterministic for any number of threads. \throws std::invalid_argument naming field, value and range.
Contours extractContours(const TsdfVolume& volume, const ContourConfig& config);

/// Eq. (4): gradient of the TSDF at a voxel, not normalised, outward. Unknown neighbours (w = 0) are replaced
/// by the one-sided difference (D-B32), doubled so that every axis spans two voxels, unless `skip_unknown` is
/// off. The same holds at the border of the volume.
Eigen::Vector3f tsdfGradient(const TsdfVolume& volume, const Eigen::Vector3i& voxel,
                             bool skip_unknown = true);

}  // namespace vantage
