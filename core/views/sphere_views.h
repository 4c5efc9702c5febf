#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/grid_geometry.h"
#include "core/geometry/pose.h"

namespace vantage {

/// A candidate view of the hierarchical planner.
struct ViewCandidate {
  std::uint32_t id = 0;
  Pose T_world_camera = Pose::Identity();
  std::int32_t frame = -1;  ///< recorded pose: number of its frame in the sequence
};

/// Views from the face directions of an icosphere around a point, looking at it, roll 0 (D-A21); ids are face
/// numbers. \throws std::invalid_argument for subdivisions outside 0..6 or a radius <= 0.
std::vector<ViewCandidate> icosphereViews(const Eigen::Vector3d& center_world, double radius_m,
                                          int subdivisions);

/// Views drawn uniformly: positions in the box, orientations over all rotations. The n-th view depends on the
/// seed and n alone. \throws std::invalid_argument for a negative count or an empty box.
std::vector<ViewCandidate> workspaceViews(const Box& positions, int count, std::uint64_t seed);

}  // namespace vantage
