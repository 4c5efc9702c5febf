#include "io/config_fields.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace vantage::config {
namespace {

std::string shortest(double value) {
  std::array<char, 40> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  std::string text(buffer.data(), end);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result + '"';
}

std::string number(double value, bool integer) {
  return integer ? std::to_string(static_cast<std::int64_t>(value)) : shortest(value);
}

bool isInteger(Kind kind) {
  return kind == Kind::Integer || kind == Kind::Integers;
}
bool isArray(Kind kind) {
  return kind == Kind::Numbers || kind == Kind::Integers;
}

/// How a value of the wrong kind is called in a message.
std::string describe(const Value& value) {
  struct {
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(std::int64_t v) const { return std::to_string(v); }
    std::string operator()(double v) const { return shortest(v); }
    std::string operator()(const std::string& v) const { return quoted(v.substr(0, 60)); }
    std::string operator()(const std::vector<double>& v) const {
      std::string text = "[";
      for (std::size_t i = 0; i < v.size() && i < 8; ++i) text += (i ? ", " : "") + shortest(v[i]);
      return text + (v.size() > 8 ? ", ...]" : "]");
    }
  } visitor;
  return std::visit(visitor, value);
}

[[noreturn]] void refuse(const Field& field, const Value& value, const std::string& problem) {
  throw std::invalid_argument(field.key + " = " + describe(value) + " " + problem +
                              "; allowed: " + field.allowed());
}

void requireRange(const Field& field, const Value& whole, double entry) {
  if (!(entry >= field.low && entry <= field.high)) refuse(field, whole, "is out of range");
}

std::vector<double> checkedArray(const Field& field, const Value& value) {
  const auto* numbers = std::get_if<std::vector<double>>(&value);
  if (!numbers) refuse(field, value, "is not an array of numbers");
  const int count = static_cast<int>(std::min<std::size_t>(numbers->size(), 1000000));
  if (count < field.min_count || count > field.max_count)
    refuse(field, value, "has the wrong number of entries");
  for (const double entry : *numbers) {
    if (field.kind == Kind::Integers && entry != std::floor(entry)) refuse(field, value, "holds a fraction");
    requireRange(field, value, entry);
  }
  return *numbers;
}

bool isNames(const Field& field, std::string_view text) {
  for (;;) {
    const std::size_t comma = text.find(',');
    if (std::ranges::find(field.choices, text.substr(0, comma)) == field.choices.end()) return false;
    if (comma == std::string_view::npos) return true;
    text.remove_prefix(comma + 1);
  }
}

}  // namespace

std::string Field::allowed() const {
  if (kind == Kind::Boolean) return "true | false";
  if (kind == Kind::Choice || kind == Kind::Names) {
    std::string text;
    for (const std::string& choice : choices) text += (text.empty() ? "" : " | ") + choice;
    return kind == Kind::Names ? text + ", several with commas between them" : text;
  }
  const bool integer = isInteger(kind);
  const std::string range = number(low, integer) + " .. " + number(high, integer);
  if (!isArray(kind)) return range;
  const std::string count = min_count == max_count
                                ? std::to_string(min_count)
                                : std::to_string(min_count) + " to " + std::to_string(max_count);
  return count + " numbers in " + range;
}

std::string toToml(const Value& value, Kind kind) {
  const auto* numbers = std::get_if<std::vector<double>>(&value);
  if (!numbers) return describe(value);
  std::string text = "[";
  for (std::size_t i = 0; i < numbers->size(); ++i)
    text += (i ? ", " : "") + number((*numbers)[i], isInteger(kind));
  return text + "]";
}

Value checked(const Field& field, Value value) {
  switch (field.kind) {
    case Kind::Boolean:
      if (!std::holds_alternative<bool>(value)) refuse(field, value, "is not true or false");
      return value;
    case Kind::Choice: {
      const auto* text = std::get_if<std::string>(&value);
      if (!text || std::find(field.choices.begin(), field.choices.end(), *text) == field.choices.end())
        refuse(field, value, "is not a choice");
      return value;
    }
    case Kind::Names: {
      const auto* text = std::get_if<std::string>(&value);
      if (!text || !isNames(field, *text)) refuse(field, value, "is not a choice");
      return value;
    }
    case Kind::Integer: {
      const auto* integer = std::get_if<std::int64_t>(&value);
      if (!integer) refuse(field, value, "is not an integer");
      requireRange(field, value, static_cast<double>(*integer));
      return value;
    }
    case Kind::Number: {
      if (const auto* integer = std::get_if<std::int64_t>(&value)) value = static_cast<double>(*integer);
      const auto* real = std::get_if<double>(&value);
      if (!real) refuse(field, value, "is not a number");
      requireRange(field, value, *real);
      return value;
    }
    case Kind::Numbers:
    case Kind::Integers:
      return checkedArray(field, value);
  }
  throw std::logic_error("unknown kind of setting");
}

}  // namespace vantage::config
