#pragma once

#include <cstdint>

namespace vantage {

/// What is known about a voxel. Unknown is never free.
enum class VoxelState : std::uint8_t { Unknown = 0, Free = 1, Occupied = 2 };

}  // namespace vantage
