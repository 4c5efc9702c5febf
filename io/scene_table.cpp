#include "io/scene_table.h"

#include <cmath>

#include "io/error.h"
#include "io/suggest.h"

namespace vantage {
namespace {

std::string typeName(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a boolean";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
}

}  // namespace

std::string tomlPlace(const std::string& source, const toml::source_region& region) {
  return region.begin.line ? source + ":" + std::to_string(region.begin.line) : source;
}

std::string sourceOf(const toml::node& node) {
  return node.source().path ? *node.source().path : std::string();
}

SceneTable::SceneTable(const toml::table& table, std::string source, std::string what)
    : table_(table), source_(std::move(source)), what_(std::move(what)) {}

void SceneTable::fail(const std::string& key, const std::string& message) const {
  const toml::node* node = table_.get(key);
  throw InputError(tomlPlace(source_, node ? node->source() : table_.source()), what_ + ": " + message);
}

const toml::node& SceneTable::require(const std::string& key) {
  read_.insert(key);
  const toml::node* node = table_.get(key);
  if (!node) fail(key, "'" + key + "' is missing");
  return *node;
}

double SceneTable::finiteNumber(const toml::node& node, const std::string& key) const {
  const std::optional<double> value = node.value<double>();
  if (!value || !node.is_number()) fail(key, "'" + key + "' is " + typeName(node) + "; give a number");
  if (!std::isfinite(*value)) fail(key, "'" + key + "' is not finite; give a number");
  return *value;
}

double SceneTable::number(const std::string& key) {
  return finiteNumber(require(key), key);
}
double SceneTable::number(const std::string& key, double fallback) {
  read_.insert(key);
  return has(key) ? number(key) : fallback;
}

std::string SceneTable::text(const std::string& key) {
  const toml::node& node = require(key);
  if (!node.is_string()) fail(key, "'" + key + "' is " + typeName(node) + "; give a string");
  return node.as_string()->get();
}
std::string SceneTable::text(const std::string& key, const std::string& fallback) {
  read_.insert(key);
  return has(key) ? text(key) : fallback;
}

bool SceneTable::flag(const std::string& key, bool fallback) {
  read_.insert(key);
  if (!has(key)) return fallback;
  const toml::node& node = require(key);
  if (!node.is_boolean()) fail(key, "'" + key + "' is " + typeName(node) + "; give true or false");
  return node.as_boolean()->get();
}

std::vector<double> SceneTable::numberArray(const toml::node& node, const std::string& key,
                                            std::size_t count) const {
  const toml::array* array = node.as_array();
  if (!array || array->size() != count)
    fail(key, "'" + key + "' is " +
                  (array ? "an array of " + std::to_string(array->size()) : typeName(node)) +
                  "; give an array of " + std::to_string(count) + " numbers");
  std::vector<double> values;
  for (const toml::node& entry : *array) values.push_back(finiteNumber(entry, key));
  return values;
}

std::vector<double> SceneTable::numbers(const std::string& key, std::size_t count) {
  return numberArray(require(key), key, count);
}

std::vector<std::vector<double>> SceneTable::points(const std::string& key, std::size_t count) {
  const toml::node& node = require(key);
  const toml::array* array = node.as_array();
  if (!array)
    fail(key, "'" + key + "' is " + typeName(node) + "; give an array of arrays of " + std::to_string(count) +
                  " numbers");
  if (array->size() > 10000)
    fail(key, "'" + key + "' has " + std::to_string(array->size()) + " points; allowed: 10000");
  std::vector<std::vector<double>> points;
  for (const toml::node& entry : *array) points.push_back(numberArray(entry, key, count));
  return points;
}

void SceneTable::finish() const {
  const std::vector<std::string> known(read_.begin(), read_.end());
  for (const auto& [key, node] : table_) {
    const std::string name(key.str());
    if (read_.contains(name)) continue;
    throw InputError(tomlPlace(source_, key.source()),
                     what_ + ": unknown key '" + name + "'" + suggestion(name, known));
  }
}

}  // namespace vantage
