#include "io/octree_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "io/suggest.h"
#include "io/text_file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 32;
const std::vector<std::string> kKeys = {"map_min_m", "map_max_m", "object_min_m", "object_max_m"};

struct Boxes {
  Box map;
  std::optional<Box> object;
};

Eigen::Vector3d cornerOf(const toml::table& table, const fs::path& path, const std::string& key) {
  const toml::node* node = table.get(key);
  if (!node) throw InputError(path.string(), "'" + key + "' is missing; three numbers in metres are wanted");
  const std::string where = atLine(path, static_cast<int>(node->source().begin.line));
  Eigen::Vector3d corner = Eigen::Vector3d::Constant(NAN);
  const toml::array* numbers = node->as_array();
  for (std::size_t a = 0; numbers && numbers->size() == 3 && a < 3; ++a)
    corner[static_cast<int>(a)] = (*numbers)[a].value<double>().value_or(NAN);
  if (!corner.allFinite())
    throw InputError(where, "'" + key + "' wants three finite numbers in metres, e.g. [-0.4, -0.4, 0.0]");
  return corner;
}

Box boxOf(const toml::table& table, const fs::path& path, const std::string& low, const std::string& high) {
  const Box box(cornerOf(table, path, low), cornerOf(table, path, high));
  if (box.isEmpty()) throw InputError(path.string(), "'" + low + "' is above '" + high + "'");
  return box;
}

std::optional<Boxes> readBoxes(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  toml::table table;
  try {
    table = toml::parse(readTextFile(path, 1 << 20), path.string());
  } catch (const toml::parse_error& e) {
    throw InputError(atLine(path, static_cast<int>(e.source().begin.line)), std::string(e.description()));
  }
  for (const auto& [key, node] : table)
    if (std::find(kKeys.begin(), kKeys.end(), key.str()) == kKeys.end())
      throw InputError(atLine(path, static_cast<int>(node.source().begin.line)),
                       "unknown key '" + std::string(key.str()) + "'" + suggestion(key.str(), kKeys));
  Boxes boxes{boxOf(table, path, "map_min_m", "map_max_m"), std::nullopt};
  if (table.contains("object_min_m") || table.contains("object_max_m"))
    boxes.object = boxOf(table, path, "object_min_m", "object_max_m");
  return boxes;
}

std::string textOf(const Boxes& boxes) {
  const auto number = [](double x) { return shortestNumber(std::round(x * 1e9) / 1e9); };
  const auto line = [&](const std::string& key, const Eigen::Vector3d& p) {
    return key + " = [" + number(p.x()) + ", " + number(p.y()) + ", " + number(p.z()) + "]\n";
  };
  std::string text =
      "# Space that the octree beside this file maps, and the box of the object in it, metres. What is not\n"
      "# stored there is unknown.\n" +
      line("map_min_m", boxes.map.min()) + line("map_max_m", boxes.map.max());
  if (boxes.object)
    text += line("object_min_m", boxes.object->min()) + line("object_max_m", boxes.object->max());
  return text;
}

/// \param bounds for a tree that holds nothing and so has no extent of its own
OccupancyOctree parse(const std::string& bytes, const std::optional<Box>& bounds,
                      const OccupancyConfig& config) {
  std::istringstream in(bytes);
  return OccupancyOctree::read(in, bounds, config);
}

OccupancyOctree read(const fs::path& path, const std::optional<Boxes>& boxes, const OccupancyConfig& config) {
  const std::string bytes = readTextFile(path, kLargestFile);
  const bool empty = bytes.ends_with("\ndata\n");
  if (!boxes && empty) {
    parse(bytes, Box(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()),
          config);  // a bad file is refused as such
    throw InputError(path.string(), "holds no voxel, and there is no " +
                                        octreeBoxPath(path).filename().string() +
                                        " beside it with map_min_m and map_max_m to say which space it maps");
  }
  if (!boxes) return parse(bytes, std::nullopt, config);
  if (empty) {
    OccupancyOctree map = parse(bytes, boxes->map, config);
    map.recut(map.geometry(), boxes->object.value_or(boxes->map));
    return map;
  }
  OccupancyOctree map = parse(bytes, std::nullopt, config);
  const double l = map.geometry().voxel_size_m;
  const GridGeometry grid = OccupancyOctree::gridAround(map.geometry().bounds().merged(boxes->map), l);
  map.recut(grid, boxes->object.value_or(grid.bounds()));
  return map;
}

}  // namespace

fs::path octreeBoxPath(const fs::path& map) {
  return map.string() + ".toml";
}

OccupancyOctree readOctree(const fs::path& path, const OccupancyConfig& config) {
  const std::optional<Boxes> boxes = readBoxes(octreeBoxPath(path));
  try {
    return read(path, boxes, config);
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(path.string(), "too large for this machine's memory");
  } catch (const std::exception& e) {
    throw InputError(path.string(), e.what());
  }
}

void writeOctree(const fs::path& path, const OccupancyOctree& map) {
  const bool labels = path.extension() == ".bt";
  if (!labels && path.extension() != ".ot")
    throw InputError(path.string(), "an octree is written to .bt (labels) or .ot (probabilities)");
  requireCreatable(path);
  requireCreatable(octreeBoxPath(path));
  std::ostringstream out;
  map.write(out, labels ? OccupancyOctree::Format::Bt : OccupancyOctree::Format::Ot);
  saveFile(path, out.view());
  Boxes boxes{map.geometry().bounds(), std::nullopt};
  if (!map.objectBox().isEmpty()) boxes.object = map.objectBox();
  saveFile(octreeBoxPath(path), textOf(boxes));
}

}  // namespace vantage
