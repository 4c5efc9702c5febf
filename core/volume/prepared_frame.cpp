#include "core/volume/prepared_frame.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace vantage::fusion {
namespace {

constexpr int kTileBits = 3;
constexpr double kTooNear_m = 0.01;  ///< bricks that come nearer to the image plane are not judged

void requireSize(const DepthImage& depth, const PinholeCamera& camera) {
  const std::size_t pixels = static_cast<std::size_t>(camera.width) * camera.height;
  if (depth.width == camera.width && depth.height == camera.height && depth.depth_m.size() == pixels) return;
  std::ostringstream text;
  text << "depth image is " << depth.width << " x " << depth.height << ", its camera " << camera.width
       << " x " << camera.height << "; they must agree";
  throw std::invalid_argument(text.str());
}

}  // namespace

RangeTiles::RangeTiles(const std::vector<float>& range_m, int width, int height) {
  constexpr int kTile = 1 << kTileBits;
  constexpr Limits kNothing{1e30f, kNoRange};
  const auto tilesFor = [](int pixels, int bits) { return ((pixels - 1) >> bits) + 1; };
  const auto merge = [](Limits& into, const Limits& from) {
    into.low = std::min(into.low, from.low);
    into.high = std::max(into.high, from.high);
  };
  Level first{tilesFor(width, kTileBits), tilesFor(height, kTileBits), {}};
  first.tiles.assign(static_cast<std::size_t>(first.width) * first.height, kNothing);
  tbb::parallel_for(tbb::blocked_range<int>(0, first.height, 8), [&](const tbb::blocked_range<int>& rows) {
    for (int v = rows.begin() * kTile; v < std::min(rows.end() * kTile, height); ++v)
      for (int t = 0; t < first.width; ++t) {
        const float* pixel = range_m.data() + static_cast<std::size_t>(v) * width;
        Limits limits = kNothing;
        for (int u = t * kTile; u < std::min(t * kTile + kTile, width); ++u)
          merge(limits, {pixel[u], pixel[u]});
        merge(first.tiles[static_cast<std::size_t>(v >> kTileBits) * first.width + t], limits);
      }
  });
  levels_.push_back(std::move(first));
  while (levels_.back().tiles.size() > 1) {
    const Level& fine = levels_.back();
    Level coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
    coarse.tiles.assign(static_cast<std::size_t>(coarse.width) * coarse.height, kNothing);
    for (int y = 0; y < fine.height; ++y)
      for (int x = 0; x < fine.width; ++x)
        merge(coarse.tiles[static_cast<std::size_t>(y / 2) * coarse.width + x / 2],
              fine.tiles[static_cast<std::size_t>(y) * fine.width + x]);
    levels_.push_back(std::move(coarse));
  }
}

RangeTiles::Limits RangeTiles::over(int u0, int v0, int u1, int v1) const {
  std::size_t level = 0;
  const int span = std::max(u1 - u0, v1 - v0);
  while (level + 1 < levels_.size() && (span >> (kTileBits + level)) > 4) ++level;
  const int bits = kTileBits + static_cast<int>(level);
  Limits limits{1e30f, kNoRange};
  for (int y = v0 >> bits; y <= v1 >> bits; ++y)
    for (int x = u0 >> bits; x <= u1 >> bits; ++x) {
      const Limits& tile = levels_[level].tiles[static_cast<std::size_t>(y) * levels_[level].width + x];
      limits.low = std::min(limits.low, tile.low);
      limits.high = std::max(limits.high, tile.high);
    }
  return limits;
}

/// Bounds of projected points, pixels (+1/2 as in Row), and of their depth.
struct PreparedFrame::Footprint {
  float u0, u1, v0, v1, z0, z1;

  void add(float u, float v, float z) {
    u0 = std::min(u0, u), u1 = std::max(u1, u);
    v0 = std::min(v0, v), v1 = std::max(v1, v);
    z0 = std::min(z0, z), z1 = std::max(z1, z);
  }
  static Footprint none() { return {1e30f, -1e30f, 1e30f, -1e30f, 1e30f, -1e30f}; }
  Footprint operator+(const Footprint& o) const {
    return {std::min(u0, o.u0), std::max(u1, o.u1), std::min(v0, o.v0),
            std::max(v1, o.v1), std::min(z0, o.z0), std::max(z1, o.z1)};
  }
};

/// The four edges of a row of bricks as in Row.
struct PreparedFrame::Edges {
  float u[4], v[4], z[4];
  float du, dv, dz;
};

PreparedFrame::PreparedFrame(const TsdfVolume& volume, const DepthImage& depth, const PinholeCamera& camera,
                             const Pose& T_world_camera, const FusionConfig& config)
    : camera_(camera), truncation_m_(config.truncation_m), voxel_m_(volume.geometry().voxel_size_m) {
  camera.validate();
  config.validate(voxel_m_);
  requireSize(depth, camera);
  if (!T_world_camera.matrix().allFinite()) throw std::invalid_argument("camera pose is not finite");
  measureRanges(depth);
  const Pose T_camera_world = T_world_camera.inverse();
  corner_ = T_camera_world * volume.geometry().origin_m;
  axes_ = T_camera_world.linear() * voxel_m_;
  camera_grid_ = volume.geometry().toGrid(T_world_camera.translation());
  frame_.range_m = range_m_.data();
  frame_.width = camera.width;
  frame_.height = camera.height;
  frame_.units_per_m = static_cast<float>(kFull / config.truncation_m);
  frame_.voxel_m = static_cast<float>(voxel_m_);
  frame_.camera_x = static_cast<float>(camera_grid_.x());
  frame_.observations = static_cast<float>(config.observations_per_frame);
  frame_.increment = config.observations_per_frame;
  frame_.max_weight = config.max_weight;
  frame_.row_pitch = volume.geometry().size.x();
}

void PreparedFrame::measureRanges(const DepthImage& depth) {
  const auto low = static_cast<float>(camera_.min_range_m), high = static_cast<float>(camera_.max_range_m);
  range_m_.resize(depth.depth_m.size());
  std::vector<float> x2(camera_.width);
  for (int u = 0; u < camera_.width; ++u)
    x2[u] = static_cast<float>(std::pow((u - camera_.cx) / camera_.fx, 2));
  tbb::parallel_for(tbb::blocked_range<int>(0, camera_.height, 32), [&](const tbb::blocked_range<int>& rows) {
    for (int v = rows.begin(); v < rows.end(); ++v) {
      const std::size_t first = static_cast<std::size_t>(v) * camera_.width;
      const auto y2_plus_1 = static_cast<float>(std::pow((v - camera_.cy) / camera_.fy, 2) + 1.0);
      for (int u = 0; u < camera_.width; ++u) {
        const float z = depth.depth_m[first + u];
        const float length = z * std::sqrt(x2[u] + y2_plus_1);
        const bool valid = (z >= low) & (z <= high) & (z > 0.0f);
        range_m_[first + u] = valid ? length : kNoRange;
      }
    }
  });
}

Row PreparedFrame::row(int y, int z) const {
  const Eigen::Vector3d c = corner_ + y * axes_.col(1) + z * axes_.col(2), d = axes_.col(0);
  const double cx = camera_.cx + 0.5, cy = camera_.cy + 0.5;
  const double ry = (y - camera_grid_.y()) * voxel_m_, rz = (z - camera_grid_.z()) * voxel_m_;
  Row row;
  row.u0 = static_cast<float>(camera_.fx * c.x() + cx * c.z());
  row.du = static_cast<float>(camera_.fx * d.x() + cx * d.z());
  row.v0 = static_cast<float>(camera_.fy * c.y() + cy * c.z());
  row.dv = static_cast<float>(camera_.fy * d.y() + cy * d.z());
  row.z0 = static_cast<float>(c.z());
  row.dz = static_cast<float>(d.z());
  row.across2_m2 = static_cast<float>(ry * ry + rz * rz);
  return row;
}

PreparedFrame::Footprint PreparedFrame::column(int x, const Edges& edges) const {
  Footprint f = Footprint::none();
  const auto at = static_cast<float>(x);
  for (int n = 0; n < 4; ++n) {
    const float z = edges.z[n] + at * edges.dz;
    const float inverse = 1.0f / std::max(z, static_cast<float>(kTooNear_m));
    f.add((edges.u[n] + at * edges.du) * inverse, (edges.v[n] + at * edges.dv) * inverse, z);
  }
  return f;
}

Sight PreparedFrame::sight(const Footprint& f, double nearest_m, double farthest_m) const {
  constexpr float kMargin = 1.0f;  // pixels, far more than rounding can do
  if (f.z1 < -static_cast<float>(kTooNear_m)) return Sight::Hidden;
  if (f.z0 < 2 * static_cast<float>(kTooNear_m)) return Sight::Mixed;
  const auto width = static_cast<float>(camera_.width), height = static_cast<float>(camera_.height);
  const float u0 = f.u0 - kMargin, u1 = f.u1 + kMargin, v0 = f.v0 - kMargin, v1 = f.v1 + kMargin;
  if (u1 < 0 || v1 < 0 || u0 >= width || v0 >= height) return Sight::Hidden;
  const bool whole = u0 >= 0 && v0 >= 0 && u1 < width && v1 < height;
  const RangeTiles::Limits seen = tiles_.front().over(
      static_cast<int>(std::max(u0, 0.0f)), static_cast<int>(std::max(v0, 0.0f)),
      static_cast<int>(std::min(u1, width - 1)), static_cast<int>(std::min(v1, height - 1)));
  const double slack = 1e-4 + 1e-5 * farthest_m;
  if (seen.high + truncation_m_ < nearest_m - slack) return Sight::Hidden;
  return whole && seen.low - truncation_m_ > farthest_m + slack ? Sight::Empty : Sight::Mixed;
}

void PreparedFrame::lookAt(int y0, int y1, int z0, int z1, int voxels_x, std::vector<Sight>& sights) const {
  const auto alongAxis = [&](int axis, int first, int last, double& nearest, double& farthest) {
    const double low = (first - camera_grid_[axis]) * voxel_m_, high = (last - camera_grid_[axis]) * voxel_m_;
    nearest = std::max({0.0, low, -high});
    farthest = std::max(std::abs(low), std::abs(high));
  };
  double near_y, far_y, near_z, far_z;
  alongAxis(1, y0, y1 - 1, near_y, far_y);
  alongAxis(2, z0, z1 - 1, near_z, far_z);
  Edges edges{};
  for (int n = 0; n < 4; ++n) {
    const Row edge = row(n & 1 ? y1 - 1 : y0, n & 2 ? z1 - 1 : z0);
    edges.u[n] = edge.u0, edges.v[n] = edge.v0, edges.z[n] = edge.z0;
    edges.du = edge.du, edges.dv = edge.dv, edges.dz = edge.dz;
  }
  // Neighbouring bricks share a column of corners: each is judged with the first voxels of the next.
  Footprint left = column(0, edges);
  for (std::size_t b = 0; b < sights.size(); ++b) {
    const int x0 = static_cast<int>(b) * kBrickX;
    const Footprint right = column(x0 + kBrickX, edges);
    double near_x, far_x;
    alongAxis(0, x0, std::min(x0 + kBrickX, voxels_x) - 1, near_x, far_x);
    sights[b] = sight(left + right, std::sqrt(near_x * near_x + near_y * near_y + near_z * near_z),
                      std::sqrt(far_x * far_x + far_y * far_y + far_z * far_z));
    left = right;
  }
}

}  // namespace vantage::fusion
