#include "io/camera_file.h"

#include <yaml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "io/text_file.h"

namespace vantage {
namespace {

/// A YAML file as a tree; freed at the end.
class YamlDocument {
 public:
  YamlDocument(std::string file, const std::string& text) : file_(std::move(file)) {
    yaml_parser_t parser;
    if (!yaml_parser_initialize(&parser)) throw std::bad_alloc();
    yaml_parser_set_input_string(&parser, reinterpret_cast<const unsigned char*>(text.data()), text.size());
    loaded_ = yaml_parser_load(&parser, &document_) != 0;
    const std::string problem = loaded_ || !parser.problem ? "" : parser.problem;
    const auto line = parser.problem_mark.line + 1;
    yaml_parser_delete(&parser);
    if (!loaded_) throw InputError(file_ + ":" + std::to_string(line), "broken YAML: " + problem);
  }
  ~YamlDocument() {
    if (loaded_) yaml_document_delete(&document_);
  }
  YamlDocument(const YamlDocument&) = delete;

  yaml_node_t* root() { return yaml_document_get_root_node(&document_); }
  yaml_node_t* node(int index) { return yaml_document_get_node(&document_, index); }

  /// Value of a key of a map, or null.
  yaml_node_t* get(yaml_node_t* map, std::string_view key) {
    if (!map || map->type != YAML_MAPPING_NODE) return nullptr;
    for (auto* pair = map->data.mapping.pairs.start; pair < map->data.mapping.pairs.top; ++pair) {
      yaml_node_t* name = node(pair->key);
      if (name && name->type == YAML_SCALAR_NODE && text(name) == key) return node(pair->value);
    }
    return nullptr;
  }

  static std::string_view text(const yaml_node_t* node) {
    return {reinterpret_cast<const char*>(node->data.scalar.value), node->data.scalar.length};
  }
  std::string where(const yaml_node_t* node) const {
    return file_ + ":" + std::to_string(node->start_mark.line + 1);
  }
  const std::string& file() const { return file_; }

  double number(const yaml_node_t* node, std::string_view key) const {
    const auto value = node->type == YAML_SCALAR_NODE ? parseNumber(text(node)) : std::nullopt;
    if (!value) throw InputError(where(node), std::string(key) + " is not a finite number");
    return *value;
  }

  /// A list of numbers, or the `data` of a matrix.
  std::vector<double> numbers(yaml_node_t* list, std::string_view key) {
    if (yaml_node_t* data = get(list, "data")) list = data;
    if (list->type != YAML_SEQUENCE_NODE)
      throw InputError(where(list), std::string(key) + " is not a list of numbers");
    std::vector<double> values;
    for (auto* item = list->data.sequence.items.start; item < list->data.sequence.items.top; ++item)
      values.push_back(number(node(*item), key));
    return values;
  }

 private:
  std::string file_;
  yaml_document_t document_;
  bool loaded_ = false;
};

yaml_node_t* firstOf(YamlDocument& document, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys)
    if (yaml_node_t* node = document.get(document.root(), key)) return node;
  return nullptr;
}

int pixels(YamlDocument& document, std::initializer_list<std::string_view> keys) {
  const std::string key(*keys.begin());
  yaml_node_t* node = firstOf(document, keys);
  if (!node)
    throw InputError(
        document.file(),
        "has no '" + key + "'; a camera file states image_width, image_height and camera_matrix");
  const double value = document.number(node, key);
  if (!(value >= 1 && value <= 8192 && value == std::floor(value)))
    throw InputError(document.where(node),
                     key + " = " + shortestNumber(value) + " is out of range; allowed: 1 .. 8192");
  return static_cast<int>(value);
}

void readMatrix(YamlDocument& document, PinholeCamera& camera) {
  yaml_node_t* node = firstOf(document, {"camera_matrix", "Camera_Matrix", "cameraMatrix", "K", "k"});
  if (!node)
    throw InputError(
        document.file(),
        "has no 'camera_matrix'; a camera file states image_width, image_height and camera_matrix");
  const std::vector<double> k = document.numbers(node, "camera_matrix");
  if (k.size() != 9)
    throw InputError(document.where(node),
                     "camera_matrix holds " + std::to_string(k.size()) + " numbers; 9 are wanted");
  if (k[1] != 0.0 || k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0)
    throw InputError(document.where(node), "camera_matrix is not of the form fx 0 cx, 0 fy cy, 0 0 1");
  camera.fx = k[0], camera.cx = k[2], camera.fy = k[4], camera.cy = k[5];
}

void warnOfDistortion(YamlDocument& document, std::vector<std::string>* warnings) {
  yaml_node_t* node =
      firstOf(document, {"distortion_coefficients", "Distortion_Parameters", "distCoeffs", "D", "d"});
  if (!warnings || !node) return;
  const std::vector<double> d = document.numbers(node, "distortion_coefficients");
  if (std::any_of(d.begin(), d.end(), [](double x) { return x != 0.0; }))
    warnings->push_back(document.where(node) + ": lens distortion is not modelled; rectify the images first");
}

/// OpenCV's first line "%YAML:1.0" is none that YAML knows; it is blanked so that line numbers stay.
std::string withoutDirective(std::string text) {
  if (text.starts_with("%YAML:")) text.replace(0, std::min(text.find('\n'), text.size()), "");
  return text;
}

}  // namespace

PinholeCamera readCamera(const std::filesystem::path& path, const PinholeCamera& defaults,
                         std::vector<std::string>* warnings) {
  YamlDocument document(path.string(), withoutDirective(readTextFile(path, 1 << 20)));
  if (!document.root() || document.root()->type != YAML_MAPPING_NODE)
    throw InputError(path.string(),
                     "is not a camera file; image_width, image_height and camera_matrix are wanted");
  PinholeCamera camera = defaults;
  camera.width = pixels(document, {"image_width", "width"});
  camera.height = pixels(document, {"image_height", "height"});
  readMatrix(document, camera);
  if (yaml_node_t* node = firstOf(document, {"min_range_m"}))
    camera.min_range_m = document.number(node, "min_range_m");
  if (yaml_node_t* node = firstOf(document, {"max_range_m"}))
    camera.max_range_m = document.number(node, "max_range_m");
  warnOfDistortion(document, warnings);
  try {
    camera.validate();
  } catch (const std::invalid_argument& error) {
    throw InputError(path.string(), error.what());
  }
  return camera;
}

void writeCamera(const std::filesystem::path& path, const PinholeCamera& camera) {
  const auto n = shortestNumber;
  std::ostringstream file;
  file << "image_width: " << camera.width << "\nimage_height: " << camera.height
       << "\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [" << n(camera.fx) << ", 0, " << n(camera.cx)
       << ", 0, " << n(camera.fy) << ", " << n(camera.cy) << ", 0, 0, 1]\ndistortion_model: plumb_bob\n"
       << "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0, 0, 0, 0, 0]\nmin_range_m: "
       << n(camera.min_range_m) << "\nmax_range_m: " << n(camera.max_range_m) << "\n";
  saveFile(path, file.str());
}

}  // namespace vantage
