#pragma once

#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace vantage {

/// A value outside its range; the message names field, value and range.
class OutOfRange : public std::invalid_argument {
 public:
  OutOfRange(const std::string& message, std::string field_name, double refused, double lowest,
             double highest)
      : std::invalid_argument(message),
        field(std::move(field_name)),
        value(refused),
        low(lowest),
        high(highest) {}
  std::string field;
  double value, low, high;
};

/// Refuses a value outside [low, high] (and NaN) with a message that names field, value and range.
/// \throws OutOfRange
template <class T, class L, class H>
void requireInRange(std::string_view field, const T& value, const L& low, const H& high) {
  if (value >= low && value <= high) return;
  std::ostringstream text;
  text << field << " = " << value << " is out of range; allowed: " << low << " .. " << high;
  throw OutOfRange(text.str(), std::string(field), static_cast<double>(value), static_cast<double>(low),
                   static_cast<double>(high));
}

}  // namespace vantage
