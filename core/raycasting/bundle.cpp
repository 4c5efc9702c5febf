#include "core/raycasting/bundle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage::casting {
namespace {

/// Centres of a grid's axis inside [low_m, high_m], decided by the centre itself so that rounding cannot move
/// the border; first > last if there is none.
void centersWithin(const GridGeometry& g, int axis, double low_m, double high_m, int& first, int& last) {
  const auto center = [&](int i) { return g.origin_m[axis] + g.voxel_size_m * i; };
  const auto guess = [&](double p) { return (p - g.origin_m[axis]) / g.voxel_size_m; };
  const double end = g.size[axis];
  first = static_cast<int>(std::clamp(std::floor(guess(low_m)) - 1, 0.0, end));
  last = static_cast<int>(std::clamp(std::ceil(guess(high_m)) + 1, -1.0, end - 1));
  while (first <= last && center(first) < low_m) ++first;
  while (last >= first && center(last) > high_m) --last;
}

/// Slopes of the pixels of a rectangle as tiles of 4 x 4.
class Tiles {
 public:
  Tiles(const PinholeCamera& camera, const PixelRectangle& pixels) : camera_(camera), pixels_(pixels) {
    tiles_ = (pixels.u1 - pixels.u0 + 3) / 4;
    slope_x_.resize(16 * static_cast<std::size_t>(tiles_));
    lanes_.resize(tiles_);
    for (std::size_t k = 0; k < slope_x_.size(); ++k)
      slope_x_[k] = slopeX(camera, std::min(columnOf(k), pixels.u1 - 1));
  }

  int rows() const { return (pixels_.v1 - pixels_.v0 + 3) / 4; }

  /// The tiles of one row; valid until the next call.
  TileRow row(int r) {
    const int top = pixels_.v0 + 4 * r;
    for (int k = 0; k < 16; ++k) slope_y_[k] = slopeY(camera_, std::min(top + k / 4, pixels_.v1 - 1));
    for (int t = 0; t < tiles_; ++t) {
      unsigned mask = 0;
      for (int k = 0; k < 16; ++k)
        if (columnOf(16 * static_cast<std::size_t>(t) + k) < pixels_.u1 && top + k / 4 < pixels_.v1)
          mask |= 1u << k;
      lanes_[t] = static_cast<std::uint16_t>(mask);
    }
    return {slope_x_.data(), slope_y_, 0, lanes_.data(), tiles_};
  }

 private:
  int columnOf(std::size_t k) const {
    return pixels_.u0 + 4 * static_cast<int>(k / 16) + static_cast<int>(k % 4);
  }

  const PinholeCamera& camera_;
  PixelRectangle pixels_;
  int tiles_ = 0;
  std::vector<float> slope_x_;
  float slope_y_[16] = {};
  std::vector<std::uint16_t> lanes_;
};

}  // namespace

float squaredDistance(const Region& region, const int (&voxel)[3]) {
  const float x = static_cast<float>(voxel[0]) - region.center[0];
  const float y = static_cast<float>(voxel[1]) - region.center[1];
  const float z = static_cast<float>(voxel[2]) - region.center[2];
  return x * x + y * y + z * z;
}

bool withinBounds(const Region& region, const int (&voxel)[3]) {
  for (int a = 0; a < 3; ++a)
    if (voxel[a] < region.low[a] || voxel[a] > region.high[a]) return false;
  return true;
}

PlainRay<float> plainRay(const Bundle& bundle, float slope_x, float slope_y, float& length) {
  PlainRay<float> ray{};
  length = std::sqrt(slope_x * slope_x + slope_y * slope_y + 1.0f);
  for (int a = 0; a < 3; ++a) {
    ray.origin[a] = bundle.origin[a];
    ray.direction[a] = bundle.axis[2][a] + slope_x * bundle.axis[0][a] + slope_y * bundle.axis[1][a];
  }
  ray.end = bundle.max_range_m / length;
  return ray;
}

std::uint64_t countDistinct(std::vector<std::int32_t> voxels) {
  std::sort(voxels.begin(), voxels.end());
  return static_cast<std::uint64_t>(std::unique(voxels.begin(), voxels.end()) - voxels.begin());
}

Region makeRegion(const GridGeometry& g, const VisibilityQuery& query) {
  Region region;
  region.radius2 = std::numeric_limits<float>::infinity();
  if (query.sphere) {
    const Eigen::Vector3d center = g.toGrid(query.sphere->center);
    for (int a = 0; a < 3; ++a) region.center[a] = static_cast<float>(center[a]);
    const double radius = query.sphere->radius / g.voxel_size_m;
    region.radius2 = radius < 0 ? -1.0f : static_cast<float>(radius * radius);
  }
  for (int a = 0; a < 3; ++a) {
    region.low[a] = 0;
    region.high[a] = g.size[a] - 1;
    if (query.bounds)
      centersWithin(g, a, query.bounds->min()[a], query.bounds->max()[a], region.low[a], region.high[a]);
  }
  return region;
}

bool makeBundle(const StateGrid& grid, const PinholeCamera& camera, const Pose& T_world_camera,
                const VisibilityQuery& query, Bundle& bundle) {
  if (!makeBundle(grid, T_world_camera, camera.min_range_m, camera.max_range_m, bundle)) return false;
  bundle.region = makeRegion(grid.geometry(), query);
  bundle.transparent = query.outside == OutsideUnknown::Transparent;
  return true;
}

bool makeBundle(const StateGrid& grid, const Pose& T_world_camera, double min_range_m, double max_range_m,
                Bundle& bundle) {
  const GridGeometry& g = grid.geometry();
  const Eigen::Vector3d origin = g.toGrid(T_world_camera.translation()) + Eigen::Vector3d::Constant(0.5);
  if (g.count() == 0 || !(origin.cwiseAbs().maxCoeff() < kFarthestOrigin)) return false;
  bundle.grid = {grid.states().data(), grid.freeRadius().data(), {g.size.x(), g.size.y(), g.size.z()}};
  const Eigen::Matrix3d axes = T_world_camera.linear() / g.voxel_size_m;
  for (int a = 0; a < 3; ++a) {
    bundle.origin[a] = static_cast<float>(origin[a]);
    bundle.start[a] = static_cast<int>(std::floor(bundle.origin[a]));
    for (int c = 0; c < 3; ++c) bundle.axis[c][a] = static_cast<float>(axes(a, c));
  }
  bundle.min_range_m = static_cast<float>(min_range_m);
  bundle.max_range_m = static_cast<float>(max_range_m);
  // Rounding moves a computed position by less than 4 units in the last place of the coordinates involved.
  bundle.doubt = static_cast<float>((origin.cwiseAbs().maxCoeff() + g.size.maxCoeff()) * 0x1p-20);
  return true;
}

HitCounter::HitCounter(const VisibilityQuery& query, const GridGeometry& geometry)
    : query_(query), voxel_m_(geometry.voxel_size_m) {
  if (!query.sphere || query.histogram_bins <= 0) return;
  histogram_.assign(query.histogram_bins, 0);
  for (int k = 0; k < query.histogram_bins; ++k) {
    const double edge = (query.histogram_start_m + k * query.histogram_width_m) / voxel_m_;
    edge2_voxels_.push_back(edge < 0 ? -1.0f : static_cast<float>(edge * edge));
  }
}

void HitCounter::addToHistogram(float center2_voxels) {
  const double distance = std::sqrt(static_cast<double>(center2_voxels)) * voxel_m_;
  const double bin = std::ceil((distance - query_.histogram_start_m) / query_.histogram_width_m);
  const int last = static_cast<int>(edge2_voxels_.size()) - 1;
  int k = static_cast<int>(std::clamp(bin, 0.0, static_cast<double>(last)));
  while (k > 0 && center2_voxels <= edge2_voxels_[k - 1]) --k;
  while (k <= last && center2_voxels > edge2_voxels_[k]) ++k;
  if (k <= last) ++histogram_[k];
}

void HitCounter::take(Totals& totals, const PixelRectangle& pixels) {
  counts_.rays += static_cast<std::uint64_t>(pixels.u1 - pixels.u0) * (pixels.v1 - pixels.v0);
  counts_.unknown += totals.unknown;
  counts_.occupied += totals.occupied;
  counts_.visited += totals.visited;
  if (!totals.hits) return;
  for (const Hit& hit : *totals.hits) {
    if (!histogram_.empty() && hit.unknown) addToHistogram(hit.center2_voxels);
    if (query_.distinct_voxels && hit.in_sphere)
      (hit.unknown ? seen_unknown_ : seen_occupied_).push_back(hit.voxel);
  }
}

void HitCounter::cast(CpuPath path, const StateGrid& grid, const PinholeCamera& camera,
                      const Pose& T_world_camera, const PixelRectangle& pixels) {
  if (pixels.u1 <= pixels.u0 || pixels.v1 <= pixels.v0) return;
  Totals totals;
  std::vector<Hit> hits;
  if (wantsHits()) totals.hits = &hits;
  Bundle bundle;
  if (makeBundle(grid, camera, T_world_camera, query_, bundle)) {
    const CastRow castRow = castRowFor(path);
    Tiles tiles(camera, pixels);
    for (int r = 0; r < tiles.rows(); ++r) castRow(bundle, tiles.row(r), totals);
  }
  take(totals, pixels);
}

void HitCounter::castPlainly(const StateGrid& grid, const PinholeCamera& camera, const Pose& T_world_camera,
                             const PixelRectangle& pixels) {
  Totals totals;
  std::vector<Hit> hits;
  if (wantsHits()) totals.hits = &hits;
  Bundle bundle;
  if (!makeBundle(grid, camera, T_world_camera, query_, bundle)) return take(totals, pixels);
  const Region& region = bundle.region;
  const auto inRegion = [&](const int(&v)[3]) {
    return withinBounds(region, v) && squaredDistance(region, v) <= region.radius2;
  };
  const auto stops = [&](int i, int j, int k) {
    const VoxelState state = grid.at(i, j, k);
    if (state == VoxelState::Free) return false;
    return !(bundle.transparent && state == VoxelState::Unknown && !inRegion({i, j, k}));
  };
  for (int v = pixels.v0; v < pixels.v1; ++v)
    for (int u = pixels.u0; u < pixels.u1; ++u) {
      float length = 1.0f;
      const auto ray = plainRay(bundle, slopeX(camera, u), slopeY(camera, v), length);
      const auto end = walkPlainly(bundle.grid.size, ray, stops);
      totals.visited += end.visited;
      if (!end.hit || end.t < bundle.min_range_m / length || !withinBounds(region, end.voxel)) continue;
      const bool unknown = grid.at(end.voxel[0], end.voxel[1], end.voxel[2]) == VoxelState::Unknown;
      const bool counts = inRegion(end.voxel);
      if (counts) ++(unknown ? totals.unknown : totals.occupied);
      const auto voxel = grid.geometry().index(end.voxel[0], end.voxel[1], end.voxel[2]);
      if (totals.hits)
        hits.push_back(
            {static_cast<std::int32_t>(voxel), squaredDistance(region, end.voxel), unknown, counts});
    }
  take(totals, pixels);
}

VisibilityCounts HitCounter::counts() const {
  VisibilityCounts counts = counts_;
  counts.histogram = histogram_;
  counts.unknown_voxels = countDistinct(seen_unknown_);
  counts.occupied_voxels = countDistinct(seen_occupied_);
  return counts;
}

}  // namespace vantage::casting
