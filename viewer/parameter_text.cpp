#include "viewer/parameter_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "io/text_file.h"
#include "viewer/captions.h"
#include "viewer/parameters.h"
#include "viewer/view_words.h"

namespace vantage {
namespace {

double perUnitOf(const std::string& key) {
  const Parameter* parameter = parameterOf(key);
  return parameter ? parameter->per_unit : 1.0;
}

std::string unitOf(const std::string& key) {
  const Parameter* parameter = parameterOf(key);
  return parameter && !parameter->unit.empty() ? " " + parameter->unit : "";
}

/// Shortest text of a number that has at most nine digits after scaling.
std::string decimal(double value) {
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

/// The same for reading alone: a thousand million as "1 000 000 000".
std::string limitText(double value) {
  constexpr double kLong = 1e4, kLongest = 1e15;
  const bool whole = value == std::floor(value);
  if (whole && value >= kLong && value < kLongest) return grouped(static_cast<std::uint64_t>(value));
  return decimal(value);
}

/// "0 .. 200 mm". \param low, high in the key's own unit
std::string rangeText(const std::string& key, double low, double high) {
  const double per_unit = perUnitOf(key);
  return limitText(low / per_unit) + " .. " + limitText(high / per_unit) + unitOf(key);
}

bool isList(const config::Field& field) {
  return field.kind == config::Kind::Numbers || field.kind == config::Kind::Integers;
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string withoutUnit(const std::string& key, const std::string& typed) {
  const std::string text = trimmed(typed), unit = trimmed(unitOf(key));
  return !unit.empty() && text.ends_with(unit) ? trimmed(text.substr(0, text.size() - unit.size())) : text;
}

/// \throws std::invalid_argument
double typedNumber(const config::Field& field, const std::string& typed) {
  const std::string allowed = "; allowed: " + allowedText(field);
  const std::string text = withoutUnit(field.key, typed);
  const auto number = parseNumber(text);
  if (!number) {
    const std::string what = text.empty() ? "a number is missing" : "'" + typed + "' is not a number";
    throw std::invalid_argument(what + allowed);
  }
  const double value = *number * perUnitOf(field.key);
  if (!(value >= field.low && value <= field.high))
    throw std::invalid_argument(text + unitOf(field.key) + " is out of range" + allowed);
  const bool integer = field.kind == config::Kind::Integer || field.kind == config::Kind::Integers;
  if (integer && value != std::floor(value))
    throw std::invalid_argument(text + " is not a whole number" + allowed);
  return value;
}

std::vector<double> typedNumbers(const config::Field& field, const std::string& typed) {
  std::string text = trimmed(typed);
  if (text.starts_with('[') && text.ends_with(']')) text = text.substr(1, text.size() - 2);
  std::vector<double> numbers;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    numbers.push_back(typedNumber(field, trimmed(text.substr(at, end - at))));
    at = end + 1;
  }
  if (static_cast<int>(numbers.size()) < field.min_count ||
      static_cast<int>(numbers.size()) > field.max_count)
    throw std::invalid_argument(plural(numbers.size(), "number") + " given; allowed: " + allowedText(field));
  return numbers;
}

}  // namespace

std::string shownText(const std::string& key, const config::Value& value) {
  const config::Field* field = config::find(key);
  if (!field) throw std::logic_error("no setting '" + key + "'");
  if (const auto* number = std::get_if<double>(&value)) return decimal(*number / perUnitOf(key));
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return config::toToml(value, field->kind);
}

std::string allowedText(const config::Field& field) {
  using config::Kind;
  const std::string range = rangeText(field.key, field.low, field.high);
  if (field.kind == Kind::Number || field.kind == Kind::Integer) return range;
  if (!isList(field)) return field.allowed();
  return std::to_string(field.min_count) + " to " + std::to_string(field.max_count) +
         " numbers with commas between them, each " + range;
}

config::Value typedValue(const config::Field& field, const std::string& typed) {
  if (isList(field)) return typedNumbers(field, typed);
  const double value = typedNumber(field, typed);
  if (field.kind == config::Kind::Integer) return static_cast<std::int64_t>(value);
  return value;
}

std::string refusalText(const std::string& key, const OutOfRange& refused) {
  const Parameter* parameter = parameterOf(refused.field);
  const config::Field* field = config::find(refused.field);
  if (!parameter || !field) return refused.what();
  const std::string value = decimal(refused.value / parameter->per_unit) + unitOf(refused.field);
  return (refused.field == key ? value : "then '" + parameter->label + "', " + value + ",") +
         " is out of range; allowed: " +
         rangeText(refused.field, std::max(refused.low, field->low), std::min(refused.high, field->high));
}

}  // namespace vantage
