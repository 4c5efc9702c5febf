#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "io/config_file.h"

namespace vantage::config {

/// A value as TOML knows it; arrays hold numbers only.
using Value = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;

/// Names: one or more of the choices, with commas between them.
enum class Kind { Boolean, Integer, Number, Choice, Names, Numbers, Integers };

/// One configurable value: how it is called, what is allowed, and the way into Settings and back.
struct Field {
  std::string key;
  std::string documentation;
  Kind kind = Kind::Number;
  double low = 0.0, high = 0.0;      ///< range of the number, or of each entry
  int min_count = 0, max_count = 0;  ///< entries of an array
  std::vector<std::string> choices;  ///< of Kind::Choice and Kind::Names
  std::function<Value(const Settings&)> get;
  std::function<void(Settings&, const Value&)> set;  ///< the value is of the kind and in range

  std::string allowed() const;  ///< for people
};

/// Every field once, grouped by section.
const std::vector<Field>& fields();

/// Field of a key, or null.
const Field* find(std::string_view key);

/// Value as TOML text, exact in both directions.
std::string toToml(const Value& value, Kind kind);

/// Converts integers to numbers where a number is wanted and checks kind and range.
/// \throws std::invalid_argument "KEY = VALUE ...; allowed: ..."
Value checked(const Field& field, Value value);

}  // namespace vantage::config
