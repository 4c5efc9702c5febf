#include <toml++/toml.h>

#include <cmath>

#include "io/dataset_parts.h"
#include "io/suggest.h"
#include "io/text_file.h"

namespace vantage::dataset {
namespace {

namespace fs = std::filesystem;

/// A table of the description with what messages need.
struct Section {
  const toml::table& table;
  const fs::path& file;
  std::string prefix;  ///< "" or "camera."

  [[noreturn]] void refuse(const toml::node& node, const std::string& key, const std::string& wanted) const {
    throw InputError(atLine(file, static_cast<int>(node.source().begin.line)),
                     prefix + key + " is not usable; allowed: " + wanted);
  }

  void requireKeys(const std::vector<std::string>& known) const {
    for (const auto& [key, node] : table) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      const std::string suggestion = nearest(key.str(), known);
      throw InputError(atLine(file, static_cast<int>(key.source().begin.line)),
                       "unknown key '" + prefix + std::string(key.str()) + "'" +
                           (suggestion.empty() ? "; see the data set formats"
                                               : "; did you mean '" + prefix + suggestion + "'?"));
    }
  }

  std::optional<std::string> text(const std::string& key) const {
    const toml::node* node = table.get(key);
    if (!node) return std::nullopt;
    if (!node->is_string()) refuse(*node, key, "a text in quotes");
    return *node->value<std::string>();
  }

  std::optional<double> number(const std::string& key, double low, double high) const {
    const toml::node* node = table.get(key);
    if (!node) return std::nullopt;
    const auto value = node->is_number() ? node->value<double>() : std::nullopt;
    if (!value || !(*value >= low && *value <= high))
      refuse(*node, key, "a number in " + shortestNumber(low) + " .. " + shortestNumber(high));
    return value;
  }

  std::optional<std::vector<double>> numbers(const std::string& key, std::size_t least, std::size_t most,
                                             double low, double high) const {
    const toml::node* node = table.get(key);
    if (!node) return std::nullopt;
    const std::string wanted =
        (least == most ? std::to_string(least) : std::to_string(least) + " to " + std::to_string(most)) +
        " numbers in " + shortestNumber(low) + " .. " + shortestNumber(high);
    if (!node->is_array()) refuse(*node, key, wanted);
    std::vector<double> values;
    for (const toml::node& entry : *node->as_array()) {
      const auto value = entry.is_number() ? entry.value<double>() : std::nullopt;
      if (!value || !(*value >= low && *value <= high)) refuse(*node, key, wanted);
      values.push_back(*value);
    }
    if (values.size() < least || values.size() > most) refuse(*node, key, wanted);
    return values;
  }

  std::optional<Section> section(const std::string& key) const {
    const toml::node* node = table.get(key);
    if (!node) return std::nullopt;
    if (!node->is_table()) refuse(*node, key, "a section [" + key + "]");
    return Section{*node->as_table(), file, prefix + key + "."};
  }
};

constexpr double kFar = 1e5;

Eigen::Vector3d vectorOf(const std::vector<double>& v) {
  return {v[0], v[1], v[2]};
}

Pose matrixPose(const Section& place) {
  const toml::node& node = *place.table.get("matrix");
  const std::string wanted = "4 rows of 4 numbers that make a rigid transform";
  Eigen::Matrix4d matrix;
  const toml::array* rows = node.as_array();
  if (!rows || rows->size() != 4) place.refuse(node, "matrix", wanted);
  for (int r = 0; r < 4; ++r) {
    const toml::array* row = rows->get(r)->as_array();
    if (!row || row->size() != 4) place.refuse(node, "matrix", wanted);
    for (int c = 0; c < 4; ++c) {
      const auto value = row->get(c)->is_number() ? row->get(c)->value<double>() : std::nullopt;
      if (!value) place.refuse(node, "matrix", wanted);
      matrix(r, c) = *value;
    }
  }
  if (!isRigid(matrix)) place.refuse(node, "matrix", wanted);
  return makePose(matrix.topRightCorner<3, 1>(),
                  Eigen::Quaterniond(Eigen::Matrix3d(matrix.topLeftCorner<3, 3>())));
}

Pose placement(const Section& place) {
  place.requireKeys({"position_m", "quaternion_xyzw", "matrix"});
  if (place.table.get("matrix")) return matrixPose(place);
  const auto position = place.numbers("position_m", 3, 3, -kFar, kFar).value_or(std::vector<double>{0, 0, 0});
  const auto q =
      place.numbers("quaternion_xyzw", 4, 4, -1.001, 1.001).value_or(std::vector<double>{0, 0, 0, 1});
  const Eigen::Quaterniond orientation(q[3], q[0], q[1], q[2]);
  if (std::abs(orientation.norm() - 1.0) > 1e-3)
    place.refuse(*place.table.get("quaternion_xyzw"), "quaternion_xyzw", "length 1 within 0.001");
  return makePose(vectorOf(position), orientation);
}

PinholeCamera cameraOf(const Section& section) {
  section.requireKeys({"fx", "fy", "cx", "cy"});
  PinholeCamera camera;
  const auto want = [&](const char* key, double low) {
    const auto value = section.number(key, low, 1e6);
    if (!value) section.refuse(section.table, key, "fx, fy, cx and cy together");
    return *value;
  };
  camera.fx = want("fx", 1e-3), camera.fy = want("fy", 1e-3);
  camera.cx = want("cx", -1e6), camera.cy = want("cy", -1e6);
  return camera;
}

Box boundsOf(const Section& section) {
  section.requireKeys({"min_m", "max_m"});
  const auto low = section.numbers("min_m", 3, 3, -kFar, kFar),
             high = section.numbers("max_m", 3, 3, -kFar, kFar);
  if (!low || !high || !(vectorOf(*low).array() < vectorOf(*high).array()).all())
    section.refuse(section.table, "min_m", "three numbers, each below those of max_m");
  return {vectorOf(*low), vectorOf(*high)};
}

void readRange(const Section& root, Description& description) {
  const auto range = root.numbers("range_m", 2, 2, 0.0, 1e4);
  if (!range) return;
  if (!((*range)[0] < (*range)[1]))
    root.refuse(*root.table.get("range_m"), "range_m", "[nearest, farthest], ascending");
  description.min_range_m = (*range)[0];
  description.max_range_m = (*range)[1];
}

void readDepthFormat(const Section& root, Description& description) {
  description.depth_unit_m = root.number("depth_unit_m", 1e-9, 10.0);
  if (const auto counts = root.numbers("invalid_depth", 0, 64, 0, 65535)) {
    description.invalid_depth.emplace();
    for (const double count : *counts)
      description.invalid_depth->push_back(static_cast<std::uint16_t>(count));
  }
}

/// One of a few words.
std::optional<std::string> word(const Section& root, const std::string& key, const std::string& a,
                                const std::string& b) {
  const auto value = root.text(key);
  if (value && *value != a && *value != b)
    root.refuse(*root.table.get(key), key, "\"" + a + "\" | \"" + b + "\"");
  return value;
}

toml::table parse(const fs::path& path) {
  try {
    return toml::parse(readTextFile(path, 1 << 20), path.string());
  } catch (const toml::parse_error& error) {
    throw InputError(atLine(path, static_cast<int>(error.source().begin.line)),
                     std::string(error.description()));
  }
}

}  // namespace

Description readDescription(const fs::path& path, Described what) {
  const toml::table table = parse(path);
  const Section root{table, path, ""};
  std::vector<std::string> keys = {"intrinsics",  "camera", "depth_unit_m",           "invalid_depth",
                                   "range_m",     "bounds", "observations_per_frame", "T_world_dataset",
                                   "description", "name"};
  const std::vector<std::string> of_folder = {"layout", "depth_pattern", "color_pattern", "pose_pattern",
                                              "pose_convention"},
                                 of_bag = {"depth_topic", "camera_info_topic", "fixed_frame"};
  const auto& others = what == Described::Bag ? of_bag : of_folder;
  keys.insert(keys.end(), others.begin(), others.end());
  root.requireKeys(keys);
  Description description;
  description.layout = word(root, "layout", "frames", "tum");
  description.depth_pattern = root.text("depth_pattern").value_or("");
  description.color_pattern = root.text("color_pattern").value_or("");
  description.pose_pattern = root.text("pose_pattern").value_or("");
  description.depth_topic = root.text("depth_topic");
  description.camera_info_topic = root.text("camera_info_topic");
  description.fixed_frame = root.text("fixed_frame");
  description.intrinsics_file = root.text("intrinsics");
  if (const auto camera = root.section("camera")) description.camera = cameraOf(*camera);
  readDepthFormat(root, description);
  description.world_to_camera =
      word(root, "pose_convention", "camera_to_world", "world_to_camera") == "world_to_camera";
  readRange(root, description);
  if (const auto count = root.number("observations_per_frame", 1, 1000))
    description.observations_per_frame = static_cast<int>(*count);
  if (const auto place = root.section("T_world_dataset")) description.T_world_dataset = placement(*place);
  if (const auto bounds = root.section("bounds")) description.bounds = boundsOf(*bounds);
  return description;
}

}  // namespace vantage::dataset
