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

#include "core/raycasting/ray_family.h"

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
  const float* slope_y = nullptr;        ///< 16 a tile, or shared by the tiles
  int stride_y = 0;                      ///< entries of slope_y from one tile to the next: 16, or 0 if shared
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
  std::uint64_t unknown_outside = 0;  ///< rays that end on unknown outside the region
  std::vector<Hit>* hits = nullptr;   ///< filled if not null with hits inside the bounds, in any order
};

/// Rays in packets of 16, each with a start of its own.
struct RayList {
  const float* slope_x = nullptr;
  const float* slope_y = nullptr;
  const float* start_m = nullptr;        ///< along the ray; 0 = at the origin. Null: all are
  const std::uint32_t* ray = nullptr;    ///< place in family order, RayFamilies
  const std::uint16_t* lanes = nullptr;  ///< one mask a packet; null: every ray is cast
  std::uint32_t count = 0;               ///< entries; 16 can be read from any multiple of 16 below
};

/// Rays to be cast on the next finer level: appended to, with room for RayFamilies::kMargin more.
struct ChildList {
  float* slope_x = nullptr;
  float* slope_y = nullptr;
  float* start_m = nullptr;
  std::uint32_t* ray = nullptr;
  std::uint32_t count = 0;
};

/// How the rays of a level are refined; see castHierarchical().
struct Refinement {
  const RayFamily* families = nullptr;  ///< of the rays of this level; null at the finest: nothing is refined
  const float* child_slope_x = nullptr;  ///< of the next finer level
  const float* child_slope_y = nullptr;
  float step_back_m = 0;  ///< children start so far before the hit; at the origin if that lies behind it
  bool refine_unknown = false;
  ChildList* children = nullptr;
};

using CastRow = void (*)(const Bundle&, const TileRow&, Totals&);
using CastList = void (*)(const Bundle&, const RayList&, const Refinement&, Totals&);

void castRowPortable(const Bundle& bundle, const TileRow& row, Totals& totals);
void castListPortable(const Bundle& bundle, const RayList& list, const Refinement& refinement,
                      Totals& totals);
#ifdef VANTAGE_X86_KERNELS
void castRowAvx2(const Bundle& bundle, const TileRow& row, Totals& totals);
void castListAvx2(const Bundle& bundle, const RayList& list, const Refinement& refinement, Totals& totals);
void castRowAvx512(const Bundle& bundle, const TileRow& row, Totals& totals);
void castListAvx512(const Bundle& bundle, const RayList& list, const Refinement& refinement, Totals& totals);
#endif

}  // namespace vantage::casting
