#include "core/volume/occupancy_octree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "core/geometry/check.h"
#include "core/volume/occupancy_data.h"

namespace vantage {
namespace {

using octree::KeyBox;

void requireBetween(const char* field, double value, double low, double high) {
  if (value > low && value < high) return;
  std::ostringstream text;
  text << field << " = " << value << " is out of range; allowed: above " << low << ", below " << high;
  throw std::invalid_argument(text.str());
}

/// Index of a grid's first voxel among OctoMap's keys.
Eigen::Vector3i firstKeyOf(const GridGeometry& geometry) {
  const Eigen::Array3d first = geometry.origin_m.array() / geometry.voxel_size_m - 0.5;
  const Eigen::Array3d whole = first.round();
  std::ostringstream text;
  if (!((first - whole).abs() < 1e-4).all()) {
    text << "occupancy octree: the lower corner of the grid (" << geometry.bounds().min().transpose()
         << ") is not a multiple of the voxel size " << geometry.voxel_size_m
         << "; use OccupancyOctree::gridAround()";
    throw std::invalid_argument(text.str());
  }
  const Eigen::Array3d begin = whole + octree::kKeys / 2, end = begin + geometry.size.array().cast<double>();
  if ((begin < 0.0).any() || (end > octree::kKeys).any()) {
    const double reach = octree::kKeys / 2 * geometry.voxel_size_m;
    text << "occupancy octree: the grid reaches beyond " << reach
         << " m from the world's origin, OctoMap's limit at a voxel size of " << geometry.voxel_size_m
         << " m; use larger voxels or smaller bounds";
    throw std::invalid_argument(text.str());
  }
  return begin.cast<int>();
}

/// Voxels of the grid whose centre lies in the box.
KeyBox voxelsIn(const GridGeometry& g, const Box& box) {
  KeyBox range;
  if (box.isEmpty()) return range;
  for (int a = 0; a < 3; ++a) {
    // Candidates by index, decided by the centre itself so that rounding cannot move the border.
    const auto center = [&](int i) { return g.origin_m[a] + g.voxel_size_m * i; };
    const auto near = [&](double p) {
      return static_cast<int>(std::clamp((p - g.origin_m[a]) / g.voxel_size_m, -1.0, g.size[a] + 0.0));
    };
    int begin = std::max(0, near(box.min()[a]) - 1), end = std::min(g.size[a], near(box.max()[a]) + 2);
    while (begin < end && center(begin) < box.min()[a]) ++begin;
    while (end > begin && center(end - 1) > box.max()[a]) --end;
    range.begin[a] = begin;
    range.end[a] = end;
  }
  return range;
}

void requireGrid(const GridGeometry& geometry) {
  for (int a = 0; a < 3; ++a)
    requireInRange(std::string("occupancy octree: size along ") + "xyz"[a] + " (voxels)", geometry.size[a], 1,
                   std::numeric_limits<int>::max());
  GridGeometry checked = geometry;
  checked.size = geometry.size.cwiseMax(2);
  requireGridFits("occupancy octree", checked, 1);
}

}  // namespace

void OccupancyConfig::validate() const {
  requireBetween("hit_probability", hit_probability, 0.5, 1.0);
  requireBetween("miss_probability", miss_probability, 0.0, 0.5);
  requireBetween("clamp_min", clamp_min, 0.0, 0.5);
  requireBetween("clamp_max", clamp_max, 0.5, 1.0);
  requireInRange("unknown_low", unknown_low, clamp_min + 1e-6, 0.5);
  requireInRange("unknown_high", unknown_high, 0.5 + 1e-6, clamp_max);
  requireInRange("insert_range_m", insert_range_m, 1e-3, 1e3);
}

double probabilityOf(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

double logOddsOf(double probability) {
  return std::log(probability / (1.0 - probability));
}

OccupancyBand::OccupancyBand(const OccupancyConfig& config)
    : free_below(static_cast<float>(logOddsOf(config.unknown_low))),
      occupied_from(static_cast<float>(logOddsOf(config.unknown_high))) {}

VoxelState occupancyLabel(double log_odds, const OccupancyConfig& config) {
  return OccupancyBand(config).label(static_cast<float>(log_odds));
}

GridGeometry OccupancyOctree::gridAround(const Box& box, double voxel_size_m) {
  requireInRange("occupancy octree: voxel size (m)", voxel_size_m, 1e-6, 1e3);
  if (box.isEmpty() || !box.min().allFinite() || !box.max().allFinite())
    throw std::invalid_argument("occupancy octree: the mapped box is empty or not finite");
  constexpr double kRounding = 1e-6;  // of a voxel: a border on a plane of the grid stays there
  const Eigen::Array3d first = (box.min().array() / voxel_size_m + kRounding).floor();
  const Eigen::Array3d end = (box.max().array() / voxel_size_m - kRounding).ceil().max(first + 1.0);
  if ((first.abs() > 1 << 20).any() || (end.abs() > 1 << 20).any())
    throw std::invalid_argument(
        "occupancy octree: the mapped box reaches more than a million voxels from the world's origin; "
        "use larger voxels or smaller bounds");
  GridGeometry geometry;
  geometry.voxel_size_m = voxel_size_m;
  geometry.origin_m = (first + 0.5) * voxel_size_m;
  geometry.size = (end - first).cast<int>();
  return geometry;
}

OccupancyOctree::Data::Data(const GridGeometry& g, const Box& box, const OccupancyConfig& c)
    : geometry(g), bricks(g.size), object_box(box), config(c), band(c), nodes(g.voxel_size_m) {
  config.validate();
  hit = static_cast<float>(logOddsOf(config.hit_probability));
  miss = static_cast<float>(logOddsOf(config.miss_probability));
  low = static_cast<float>(logOddsOf(config.clamp_min));
  high = static_cast<float>(logOddsOf(config.clamp_max));
  first_key = firstKeyOf(geometry);
}

void OccupancyOctree::Data::settle() {
  requireGrid(geometry);
  try {
    marks.assign(geometry.count(), 0);
  } catch (const std::bad_alloc&) {
    throwDoesNotFit("occupancy octree", geometry, 1);
  }
  nodes.visit(keys(), [&](const KeyBox& part, float log_odds) {
    if (settled(log_odds)) setMarks(part, kSettled);
  });
}

void OccupancyOctree::Data::fill(const KeyBox& box, float log_odds) {
  if (std::isnan(log_odds))
    nodes.remove(box);
  else
    nodes.fill(box, log_odds);
  setMarks(box, settled(log_odds));
}

void OccupancyOctree::Data::setMarks(const KeyBox& box, std::uint8_t value) {
  const Eigen::Vector3i from = box.begin - first_key, to = box.end - first_key;
  for (int k = from.z(); k < to.z(); ++k)
    for (int j = from.y(); j < to.y(); ++j)
      std::fill_n(marks.begin() + static_cast<std::ptrdiff_t>(geometry.index(from.x(), j, k)),
                  to.x() - from.x(), value);
}

OccupancyOctree::OccupancyOctree()
    : data_(std::make_unique<Data>(gridAround(Box(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()), 1.0),
                                   Box(), OccupancyConfig{})) {
  data_->settle();
}
OccupancyOctree::~OccupancyOctree() = default;
OccupancyOctree::OccupancyOctree(OccupancyOctree&&) noexcept = default;
OccupancyOctree& OccupancyOctree::operator=(OccupancyOctree&&) noexcept = default;

OccupancyOctree::OccupancyOctree(const GridGeometry& geometry, const Box& object_box, VoxelState outside,
                                 const OccupancyConfig& config) {
  requireGrid(geometry);
  if (outside == VoxelState::Occupied)
    throw std::invalid_argument("occupancy octree: space outside the object's box is unknown or free");
  data_ = std::make_unique<Data>(geometry, object_box, config);
  if (outside == VoxelState::Free) data_->nodes.fill(data_->keys(), data_->low);
  const KeyBox object = voxelsIn(geometry, object_box);
  data_->nodes.fill(data_->keysOf(object.begin, object.end), 0.0f);
  data_->settle();
}

const GridGeometry& OccupancyOctree::geometry() const {
  return data_->geometry;
}
const BrickLayout& OccupancyOctree::bricks() const {
  return data_->bricks;
}
const Box& OccupancyOctree::objectBox() const {
  return data_->object_box;
}
const OccupancyConfig& OccupancyOctree::config() const {
  return data_->config;
}
std::size_t OccupancyOctree::nodeCount() const {
  return data_->nodes.nodes();
}
std::size_t OccupancyOctree::memoryBytes() const {
  return data_->nodes.memoryBytes() + data_->marks.size();
}

void OccupancyOctree::recut(const GridGeometry& geometry, const Box& object_box) {
  if (geometry.voxel_size_m != data_->geometry.voxel_size_m)
    throw std::invalid_argument("occupancy octree: a map cannot be cut to another voxel size");
  requireGrid(geometry);
  Data cut(geometry, object_box, data_->config);
  cut.nodes = std::move(data_->nodes);
  cut.nodes.cut(cut.keys());
  *data_ = std::move(cut);
  data_->settle();
}

std::optional<float> OccupancyOctree::logOdds(const Eigen::Vector3i& voxel) const {
  if (!data_->geometry.contains(voxel)) return std::nullopt;
  return data_->nodes.at(data_->first_key + voxel);
}

VoxelState OccupancyOctree::label(const Eigen::Vector3i& voxel, int level) const {
  requireInRange("level of an octree node", level, 0, kDepth);
  const Eigen::Vector3i key = data_->first_key + voxel;
  const int edge = 1 << level;
  const Eigen::Vector3i corner = key.unaryExpr([&](int x) { return x >> level << level; });
  const KeyBox node = KeyBox{corner, corner + Eigen::Vector3i::Constant(edge)}.cut(data_->keys());
  if (node.empty()) return VoxelState::Unknown;
  if (data_->config.inner == InnerRule::Max) return data_->nodes.labelByMax(node, data_->band);
  return occupancyLabel(logOddsOf(data_->nodes.probabilitySum(node) / node.voxels()), data_->config);
}

void OccupancyOctree::readBrick(std::uint32_t brick, std::span<float> log_odds) const {
  const BrickRange r = data_->bricks.range(brick);
  const KeyBox box = data_->keysOf(r.begin, r.end);
  if (static_cast<double>(log_odds.size()) != box.voxels()) {
    std::ostringstream text;
    text << "brick " << brick << ": room for " << log_odds.size() << " voxels given, it holds "
         << box.voxels();
    throw std::invalid_argument(text.str());
  }
  data_->nodes.read(box, log_odds);
}

void OccupancyOctree::setBrick(std::uint32_t brick, std::span<const float> log_odds) {
  const BrickRange r = data_->bricks.range(brick);
  const Eigen::Vector3i size = r.end - r.begin;
  if (log_odds.size() != static_cast<std::size_t>(size.prod())) {
    std::ostringstream text;
    text << "brick " << brick << ": " << log_odds.size() << " voxels given, it holds " << size.prod();
    throw std::invalid_argument(text.str());
  }
  const KeyBox keys = data_->keysOf(r.begin, r.end);
  const auto equal = [&](float x) { return x == log_odds[0] || (std::isnan(x) && std::isnan(log_odds[0])); };
  if (std::all_of(log_odds.begin(), log_odds.end(), equal)) return data_->fill(keys, log_odds[0]);
  BrickSet changed(data_->bricks.total());
  data_->rewriteBlocksOf(keys, changed, [&](float value, std::size_t at) {
    const Eigen::Vector3i v = data_->geometry.voxel(at) - r.begin;
    if ((v.array() < 0).any() || (v.array() >= size.array()).any()) return value;
    return log_odds[(static_cast<std::size_t>(v.z()) * size.y() + v.y()) * size.x() + v.x()];
  });
}

void OccupancyOctree::set(const Eigen::Vector3i& voxel, float log_odds) {
  if (!data_->geometry.contains(voxel)) {
    std::ostringstream text;
    text << "occupancy octree: voxel " << voxel.transpose() << " lies outside the grid of "
         << data_->geometry.size.transpose();
    throw std::invalid_argument(text.str());
  }
  data_->fill(data_->keysOf(voxel, voxel + Eigen::Vector3i::Ones()), log_odds);
}

BrickSet OccupancyOctree::clearSphere(const Eigen::Vector3d& center_world, double radius_m) {
  Data& d = *data_;
  BrickSet changed(d.bricks.total());
  if (!(radius_m >= 0.0) || !center_world.allFinite()) return changed;
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(radius_m);
  const KeyBox near = voxelsIn(d.geometry, Box(center_world - margin, center_world + margin));
  if (near.empty()) return changed;
  d.rewriteBlocksOf(d.keysOf(near.begin, near.end), changed, [&](float value, std::size_t at) {
    const Eigen::Vector3d p = d.geometry.center(d.geometry.voxel(at));
    const bool near_enough = (p - center_world).norm() <= radius_m;
    return near_enough && d.band.label(value) == VoxelState::Unknown ? d.low : value;
  });
  return changed;
}

}  // namespace vantage
