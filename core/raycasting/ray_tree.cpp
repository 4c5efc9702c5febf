#include "core/raycasting/ray_tree.h"

#include <algorithm>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "core/geometry/check.h"

namespace vantage {
namespace {

/// Most rays of the finest level: an image of 16 megapixels.
constexpr double kMaxRays = 16.0 * 1024 * 1024;

/// Largest voxel that a sensor's rays can be made for: two rays per axis. Section 4 of the specification
/// asks for l_i <= d sin(a / 2), which its own toy table (l_i = 0.40 m at d = 1 m and 45 deg) exceeds.
double largestVoxel(const RaySensor& sensor) {
  const double aperture = std::min(sensor.horizontal_fov_rad, sensor.vertical_fov_rad);
  return sensor.max_range_m * std::sin(std::min(aperture, std::numbers::pi / 2));
}

/// Rays along an axis: floor(a / delta) + 1.
double raysAlong(double fov_rad, double step_rad) {
  return std::floor(fov_rad / step_rad + 1e-9) + 1;
}

// Eq. (6) per axis. D-A1: centred by default, else from the lower border of the aperture.
RayAxis makeAxis(double fov_rad, double step_rad, RayAnchor anchor) {
  RayAxis axis;
  const int count = static_cast<int>(raysAlong(fov_rad, step_rad));
  for (int j = 0; j < count; ++j)
    axis.angle_rad.push_back(anchor == RayAnchor::Centered ? (j - (count - 1) / 2.0) * step_rad
                                                           : -fov_rad / 2 + j * step_rad);
  return axis;
}

// Nearest parent by angle; D-A2: ties go to the lower index.
void linkAxis(const RayAxis& coarse, RayAxis& fine) {
  constexpr double kTie = 1e-12;
  std::uint32_t parent = 0;
  for (const double angle : fine.angle_rad) {
    const auto distance = [&](std::uint32_t i) { return std::abs(coarse.angle_rad[i] - angle); };
    while (parent + 1 < coarse.count() && distance(parent + 1) < distance(parent) - kTie) ++parent;
    fine.parent.push_back(parent);
  }
}

void countChildren(const RayAxis& fine, RayAxis& coarse) {
  coarse.first_child.assign(coarse.count() + 1, 0);
  coarse.leaves.assign(coarse.count(), 0);
  for (std::uint32_t i = 0; i < fine.count(); ++i) {
    ++coarse.first_child[fine.parent[i] + 1];
    coarse.leaves[fine.parent[i]] += fine.leaves[i];
  }
  for (std::uint32_t i = 0; i < coarse.count(); ++i) coarse.first_child[i + 1] += coarse.first_child[i];
}

void fillSlopes(RayLevel& level) {
  level.slope_x.reserve(level.count());
  level.slope_y.reserve(level.count());
  for (const double beta : level.rows.angle_rad)
    for (const double alpha : level.columns.angle_rad) {
      level.slope_x.push_back(static_cast<float>(std::tan(alpha)));
      level.slope_y.push_back(static_cast<float>(std::tan(beta) / std::cos(alpha)));
    }
}

// Lanes in Morton order: four neighbours are a square, and so are their children in a packet.
void fillTiles(RayLevel& level) {
  RayTiles& tiles = level.tiles;
  const std::uint32_t rows = level.rows.count(), columns = level.columns.count();
  for (std::uint32_t top = 0; top < rows; top += 4)
    for (std::uint32_t left = 0; left < columns; left += 4) {
      unsigned lanes = 0;
      for (std::uint32_t k = 0; k < 16; ++k) {
        const std::uint32_t row = top + (k >> 1 & 1) + (k >> 2 & 2), column = left + (k & 1) + (k >> 1 & 2);
        if (row < rows && column < columns) lanes |= 1u << k;
        const std::uint32_t ray = level.index(std::min(row, rows - 1), std::min(column, columns - 1));
        tiles.ray.push_back(ray);
        tiles.slope_x.push_back(level.slope_x[ray]);
        tiles.slope_y.push_back(level.slope_y[ray]);
      }
      tiles.lanes.push_back(static_cast<std::uint16_t>(lanes));
    }
}

/// Completes a level whose rays are in family order.
void finishOrder(RayLevel& level) {
  RayFamilies& order = level.families;
  std::vector<std::uint32_t> place(level.count());
  for (std::uint32_t n = 0; n < level.count(); ++n) {
    const std::uint32_t ray = order.ray[n];
    place[ray] = n;
    order.slope_x.push_back(level.slope_x[ray]);
    order.slope_y.push_back(level.slope_y[ray]);
  }
  order.slope_x.resize(level.count() + RayFamilies::kMargin, 0.0f);
  order.slope_y.resize(level.count() + RayFamilies::kMargin, 0.0f);
  for (const std::uint32_t ray : level.tiles.ray) level.tiles.place.push_back(place[ray]);
}

/// The coarsest level is in the order of its tiles.
void orderByTiles(RayLevel& coarsest) {
  const RayTiles& tiles = coarsest.tiles;
  for (std::size_t n = 0; n < tiles.ray.size(); ++n)
    if (tiles.lanes[n / 16] >> (n % 16) & 1) coarsest.families.ray.push_back(tiles.ray[n]);
  finishOrder(coarsest);
}

/// A finer level is in the order of its parents.
void orderByParents(RayLevel& coarse, RayLevel& fine) {
  const RayAxis &rows = coarse.rows, &columns = coarse.columns;
  std::vector<std::uint32_t>& children = fine.families.ray;
  for (const std::uint32_t ray : coarse.families.ray) {
    const std::uint32_t j = ray / columns.count(), k = ray % columns.count();
    const auto first = static_cast<std::uint32_t>(children.size());
    for (std::uint32_t r = rows.first_child[j]; r < rows.first_child[j + 1]; ++r)
      for (std::uint32_t c = columns.first_child[k]; c < columns.first_child[k + 1]; ++c)
        children.push_back(fine.index(r, c));
    const std::uint32_t count = static_cast<std::uint32_t>(children.size()) - first;
    coarse.families.family.push_back({first, count, coarse.leaves(j, k)});
    coarse.families.most_children = std::max(coarse.families.most_children, count);
  }
  finishOrder(fine);
}

RayLevel makeLevel(const RaySensor& sensor, double voxel_size_m) {
  RayLevel level;
  level.voxel_size_m = voxel_size_m;
  level.step_rad = std::asin(voxel_size_m / sensor.max_range_m);
  level.rows = makeAxis(sensor.vertical_fov_rad, level.step_rad, sensor.anchor);
  level.columns = makeAxis(sensor.horizontal_fov_rad, level.step_rad, sensor.anchor);
  fillSlopes(level);
  fillTiles(level);
  return level;
}

}  // namespace

void RaySensor::validate() const {
  constexpr double kSmallest = 1e-3, kWidest = std::numbers::pi - 1e-3;
  requireInRange("horizontal_fov_rad", horizontal_fov_rad, kSmallest, kWidest);
  requireInRange("vertical_fov_rad", vertical_fov_rad, kSmallest, kWidest);
  requireInRange("min_range_m", min_range_m, 0.0, 1e3);
  requireInRange("max_range_m", max_range_m, 1e-3, 1e3);
  if (max_range_m > min_range_m) return;
  std::ostringstream text;
  text << "max_range_m = " << max_range_m << " must exceed min_range_m = " << min_range_m;
  throw std::invalid_argument(text.str());
}

int maxCoarseLevels(const RaySensor& sensor, double voxel_size_m) {
  sensor.validate();
  int levels = -1;
  while (levels < RayTree::kMaxCoarseLevels && std::ldexp(voxel_size_m, levels + 1) <= largestVoxel(sensor))
    ++levels;
  return levels;
}

RayTree::RayTree(const RaySensor& sensor, double voxel_size_m, int coarse_levels) : sensor_(sensor) {
  sensor.validate();
  requireInRange("ray tree: voxel_size_m", voxel_size_m, 1e-6, largestVoxel(sensor));
  requireInRange("ray tree: coarse_levels", coarse_levels, 0, maxCoarseLevels(sensor, voxel_size_m));
  const double step = std::asin(voxel_size_m / sensor.max_range_m);
  requireInRange("ray tree: rays at the finest level",
                 raysAlong(sensor.horizontal_fov_rad, step) * raysAlong(sensor.vertical_fov_rad, step), 1,
                 kMaxRays);
  for (int i = 0; i <= coarse_levels; ++i) levels_.push_back(makeLevel(sensor, std::ldexp(voxel_size_m, i)));
  levels_[0].rows.leaves.assign(levels_[0].rows.count(), 1);
  levels_[0].columns.leaves.assign(levels_[0].columns.count(), 1);
  for (int i = 1; i <= coarse_levels; ++i) {
    RayLevel &fine = levels_[i - 1], &coarse = levels_[i];
    linkAxis(coarse.rows, fine.rows);
    linkAxis(coarse.columns, fine.columns);
    countChildren(fine.rows, coarse.rows);
    countChildren(fine.columns, coarse.columns);
  }
  orderByTiles(levels_.back());
  for (int i = coarse_levels; i > 0; --i) orderByParents(levels_[i], levels_[i - 1]);
}

Eigen::Vector3d RayLevel::direction(std::uint32_t row, std::uint32_t column) const {
  const double beta = rows.angle_rad[row], alpha = columns.angle_rad[column];
  return {std::cos(beta) * std::sin(alpha), std::sin(beta), std::cos(beta) * std::cos(alpha)};
}

}  // namespace vantage
