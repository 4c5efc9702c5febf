#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <istream>
#include <iterator>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "core/volume/occupancy_data.h"

namespace vantage {
namespace {

using octree::KeyBox;
using Format = OccupancyOctree::Format;

constexpr std::string_view kProbabilities = "# Octomap OcTree file";
constexpr std::string_view kLabels = "# Octomap OcTree binary file";

[[noreturn]] void refuse(const std::string& what) {
  throw std::runtime_error(what);
}

/// A word of a file as it may be shown.
std::string shown(std::string_view word) {
  std::string text(word.substr(0, 40));
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32 || c > 126; }, '?');
  return "'" + text + "'";
}

struct Header {
  Format format = Format::Ot;
  double voxel_size_m = 0.0;
  std::uint64_t nodes = 0;
  std::size_t data_at = 0;  ///< first byte of the data
};

template <class T>
T numberOf(std::string_view word, const char* what) {
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size())
    refuse(std::string("damaged header: ") + what + " is " + shown(word));
  return value;
}

/// One line, and past it.
std::string_view nextLine(std::string_view bytes, std::size_t& at) {
  const std::size_t end = bytes.find('\n', at);
  if (end == std::string_view::npos || end > 1 << 16) refuse("truncated or damaged: the header has no end");
  std::string_view line = bytes.substr(at, end - at);
  at = end + 1;
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
  return line;
}

Header parseHeader(std::string_view bytes) {
  Header header;
  if (bytes.starts_with(kLabels))
    header.format = Format::Bt;
  else if (!bytes.starts_with(kProbabilities))
    refuse("is no OctoMap file: it does not begin with '" + std::string(kProbabilities) + "' or '" +
           std::string(kLabels) + "'");
  bool has_id = false, has_size = false, has_resolution = false;
  for (;;) {
    const std::string_view line = nextLine(bytes, header.data_at);
    if (line == "data") break;
    if (line.empty() || line.front() == '#') continue;
    const std::size_t blank = std::min(line.find(' '), line.size());
    const std::string_view key = line.substr(0, blank);
    const std::string_view value = line.substr(std::min(line.find_first_not_of(' ', blank), line.size()));
    if (key == "id") {
      if (value != "OcTree")
        refuse("holds a tree of type " + shown(value) + "; only OcTree is read: write it as a plain OcTree");
      has_id = true;
    } else if (key == "size") {
      header.nodes = numberOf<std::uint64_t>(value, "the number of nodes (size)");
      has_size = true;
    } else if (key == "res") {
      header.voxel_size_m = numberOf<double>(value, "the resolution (res)");
      has_resolution = true;
    } else {
      refuse("damaged header: unknown line " + shown(line));
    }
  }
  if (!has_id || !has_size || !has_resolution)
    refuse("damaged header: the lines 'id', 'size' and 'res' are wanted before 'data'");
  if (!(header.voxel_size_m >= 1e-6 && header.voxel_size_m <= 1e3)) {
    std::ostringstream text;
    text << "the resolution (res) is " << header.voxel_size_m << " m; allowed: 1e-06 .. 1000";
    refuse(text.str());
  }
  return header;
}

/// Walks the data as OctoMap's readers do, who trust it: they recurse as deep as it says.
class DataCheck {
 public:
  DataCheck(std::string_view data, Format format) : data_(data), format_(format) {}

  /// \return nodes of the tree
  std::uint64_t run() {
    if (data_.empty()) return 0;
    nodes_ = 1;
    if (format_ == Format::Ot)
      probabilities(0);
    else
      labels(0);
    if (at_ != data_.size())
      refuse("damaged: " + std::to_string(data_.size() - at_) + " bytes follow the last node");
    return nodes_;
  }
  std::uint64_t inner() const { return inner_; }

 private:
  const char* take(std::size_t bytes) {
    if (data_.size() - at_ < bytes)
      refuse("truncated: the data end after " + std::to_string(data_.size()) + " bytes, within node " +
             std::to_string(nodes_));
    at_ += bytes;
    return data_.data() + at_ - bytes;
  }
  void requireDepth(int depth) const {
    if (depth > octree::kDepth) refuse("damaged: nodes lie deeper than 16 levels");
  }

  void probabilities(int depth) {
    requireDepth(depth);
    float value = 0.0f;
    std::memcpy(&value, take(sizeof value), sizeof value);
    if (!std::isfinite(value)) refuse("damaged: node " + std::to_string(nodes_) + " holds no finite number");
    const auto children = static_cast<unsigned char>(*take(1));
    inner_ += children != 0;
    for (int n = 0; n < 8; ++n)
      if (children >> n & 1) {
        ++nodes_;
        probabilities(depth + 1);
      }
  }

  void labels(int depth) {
    requireDepth(depth + 1);
    const auto* bytes = reinterpret_cast<const unsigned char*>(take(2));
    const unsigned children = bytes[0] | bytes[1] << 8;
    if (children == 0) refuse("damaged: an inner node has no children");
    ++inner_;
    for (int n = 0; n < 8; ++n) nodes_ += (children >> 2 * n & 3) != 0;
    for (int n = 0; n < 8; ++n)
      if ((children >> 2 * n & 3) == 3) labels(depth + 1);
  }

  std::string_view data_;
  Format format_;
  std::size_t at_ = 0;
  std::uint64_t nodes_ = 0, inner_ = 0;
};

/// Refuses data that are no well-formed tree, or a tree too large for the memory left.
void check(const Header& header, std::string_view data) {
  DataCheck tree(data, header.format);
  const std::uint64_t nodes = tree.run();
  if (nodes != header.nodes)
    refuse("damaged: the header announces " + std::to_string(header.nodes) + " nodes, the data hold " +
           std::to_string(nodes));
  constexpr std::uint64_t kNodeBytes = 32, kChildrenBytes = 80;  // as allocated
  if (nodes * kNodeBytes + tree.inner() * kChildrenBytes > availableMemory())
    refuse("a tree of " + std::to_string(nodes) + " nodes does not fit in memory");
}

/// The stored voxels; empty if there are none.
KeyBox extentOf(const octree::OctreeNodes& nodes) {
  KeyBox extent{Eigen::Vector3i::Constant(octree::kKeys), Eigen::Vector3i::Zero()};
  const KeyBox everything{Eigen::Vector3i::Zero(), Eigen::Vector3i::Constant(octree::kKeys)};
  nodes.visit(everything, [&](const KeyBox& part, float) {
    extent = {extent.begin.cwiseMin(part.begin), extent.end.cwiseMax(part.end)};
  });
  return extent;
}

GridGeometry geometryOf(const KeyBox& keys, double voxel_size_m) {
  GridGeometry geometry;
  geometry.voxel_size_m = voxel_size_m;
  geometry.origin_m = ((keys.begin.cast<double>().array() - octree::kKeys / 2) + 0.5) * voxel_size_m;
  geometry.size = keys.end - keys.begin;
  return geometry;
}

GridGeometry gridOf(const KeyBox& stored, const std::optional<Box>& bounds, double voxel_size_m) {
  if (bounds) {
    const GridGeometry geometry = OccupancyOctree::gridAround(*bounds, voxel_size_m);
    if (stored.empty()) return geometry;
    const Box map = geometryOf(stored, voxel_size_m).bounds();
    if (map.intersects(geometry.bounds())) return geometry;
    std::ostringstream text;
    text << "the bounds (" << bounds->min().transpose() << ") .. (" << bounds->max().transpose()
         << ") lie outside the map, which covers (" << map.min().transpose() << ") .. ("
         << map.max().transpose() << ")";
    refuse(text.str());
  }
  if (stored.empty()) refuse("holds no voxel; give the bounds of the space that is meant");
  const Eigen::Vector3i rim = Eigen::Vector3i::Ones();
  return geometryOf({(stored.begin - rim).cwiseMax(0), (stored.end + rim).cwiseMin(octree::kKeys)},
                    voxel_size_m);
}

}  // namespace

void OccupancyOctree::write(std::ostream& out, Format format) const {
  std::ostringstream data;
  const std::size_t nodes = format == Format::Ot ? data_->nodes.writeProbabilities(data)
                                                 : data_->nodes.writeLabels(data, data_->band);
  std::array<char, 40> resolution{};
  std::to_chars(resolution.data(), resolution.data() + resolution.size(), data_->geometry.voxel_size_m);
  out << (format == Format::Ot ? kProbabilities : kLabels) << '\n'
      << "# (feel free to add / change comments, but leave the first line as it is!)\n#\n"
      << "id OcTree\nsize " << nodes << "\nres " << resolution.data() << "\ndata\n"
      << data.view();
}

OccupancyOctree OccupancyOctree::read(std::istream& in, const std::optional<Box>& bounds,
                                      const OccupancyConfig& config) {
  config.validate();
  std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const Header header = parseHeader(bytes);
  bytes.erase(0, header.data_at);
  check(header, bytes);

  octree::OctreeNodes nodes(header.voxel_size_m);
  if (!bytes.empty()) {
    std::istringstream data(std::move(bytes));
    if (header.format == Format::Ot)
      nodes.readProbabilities(data);
    else
      nodes.readLabels(data, static_cast<float>(logOddsOf(config.clamp_min)),
                       static_cast<float>(logOddsOf(config.clamp_max)));
  }
  const GridGeometry geometry = gridOf(extentOf(nodes), bounds, header.voxel_size_m);
  OccupancyOctree map;
  map.data_ = std::make_unique<Data>(geometry, bounds ? *bounds : geometry.bounds(), config);
  map.data_->nodes = std::move(nodes);
  map.data_->nodes.cut(map.data_->keys());
  map.data_->settle();
  return map;
}

}  // namespace vantage
