#pragma once

#include <cstdint>
#include <span>

#include "core/geometry/grid_geometry.h"

namespace vantage {

/// Rebuilds StateGrid::freeRadius() in the half-open voxel box [begin, end) from the states of the whole
/// grid.
void rebuildFreeRadius(const Eigen::Vector3i& grid, const std::uint8_t* states, const Eigen::Vector3i& begin,
                       const Eigen::Vector3i& end, std::uint8_t* radius);

/// The same wherever a brick (order of BrickLayout) with a flag can have had an influence. Parallel.
void rebuildFreeRadiusNear(const Eigen::Vector3i& grid, const std::uint8_t* states,
                           std::span<const std::uint8_t> brick_flags, std::uint8_t* radius);

}  // namespace vantage
