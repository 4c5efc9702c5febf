#pragma once

// One bundle of rays as the casting kernels see it. No Eigen here: the vector versions are compiled with
// instruction sets of their own. All kernels do the same single-precision operations in the same order,
// without contraction, so that they agree bit for bit with each other and with the plain walk.
//
// A voxel i covers [i, i+1) in grid coordinates. A ray is o + t d with t the depth along the optical axis in
// metres; it crosses plane p of an axis at T(p) = (p - o) / d, always computed by that formula and never
// accumulated. The walk is the sequence of all crossings ordered by (T, axis), so that a jump to any of them
// can tell exactly which others come before it.

#include <cstdint>
#include <vector>

namespace vantage::casting {

/// Slopes below this (voxels a metre) count as zero: such a ray keeps its index along the axis.
inline constexpr float kFlat = 1e-9f;
inline constexpr float kNever = 1e30f;  ///< 1 / d of a flat axis
/// Origins farther out than this (voxels) see nothing; float keeps neighbouring planes apart below it.
inline constexpr double kFarthestOrigin = 1e6;

struct Grid {
  const std::uint8_t* states = nullptr;  ///< VoxelState
  const std::uint8_t* radius = nullptr;  ///< StateGrid::freeRadius()
  int size[3] = {};
};

/// Voxels that count: index within [low, high] and squared distance from the centre within the radius.
struct Region {
  float center[3] = {};  ///< in continuous voxel coordinates, integers at voxel centres
  float radius2 = 0;     ///< voxels squared; infinite without a sphere
  int low[3] = {}, high[3] = {};
};

struct Bundle {
  Grid grid;
  Region region;
  bool transparent = false;  ///< unknown voxels outside the region do not stop rays
  float origin[3] = {};      ///< grid coordinates
  int start[3] = {};         ///< voxel of the origin; may lie outside the grid
  float axis[3][3] = {};     ///< camera x, y, z in voxels a metre, [camera axis][grid axis]
  float min_range_m = 0, max_range_m = 0;
  /// Positions farther than this from any plane, voxels, are on the right side of it whatever the rounding.
  float doubt = 0;
};

/// Rays in packets of 16: slopes of 4 x 4 pixels, tile by tile along a row of tiles. Lanes beyond the
/// rectangle repeat a pixel and are masked out.
struct TileRow {
  const float* slope_x = nullptr;        ///< 16 a tile
  const float* slope_y = nullptr;        ///< 16, shared by the tiles
  const std::uint16_t* lanes = nullptr;  ///< one mask a tile
  int tiles = 0;
};

/// A first hit that counts, for histograms and distinct voxels.
struct Hit {
  std::int32_t voxel;    ///< linear index
  float center2_voxels;  ///< squared distance of its centre from the region's centre, voxels
  bool unknown;
  bool in_sphere;
};

struct Totals {
  std::uint64_t unknown = 0, occupied = 0, visited = 0;
  std::vector<Hit>* hits = nullptr;  ///< filled if not null with hits inside the bounds, in any order
};

using CastRow = void (*)(const Bundle&, const TileRow&, Totals&);

void castRowPortable(const Bundle& bundle, const TileRow& row, Totals& totals);
#ifdef VANTAGE_X86_KERNELS
void castRowAvx2(const Bundle& bundle, const TileRow& row, Totals& totals);
void castRowAvx512(const Bundle& bundle, const TileRow& row, Totals& totals);
#endif

}  // namespace vantage::casting
