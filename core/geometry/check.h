#pragma once

#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace vantage {

/// Refuses a value outside [low, high] (and NaN) with a message that names field, value and range.
/// \throws std::invalid_argument
template <class T, class L, class H>
void requireInRange(std::string_view field, const T& value, const L& low, const H& high) {
  if (value >= low && value <= high) return;
  std::ostringstream text;
  text << field << " = " << value << " is out of range; allowed: " << low << " .. " << high;
  throw std::invalid_argument(text.str());
}

}  // namespace vantage
