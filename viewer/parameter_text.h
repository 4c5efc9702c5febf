#pragma once

#include <string>

#include "core/geometry/check.h"
#include "io/config_fields.h"

namespace vantage {

// Values of settings as people read and type them: in the unit of their Parameter.

/// A value as its field shows it: in the parameter's unit, without the unit. \pre the key is a setting
std::string shownText(const std::string& key, const config::Value& value);

/// What is allowed: "0.001 .. 200 mm".
std::string allowedText(const config::Field& field);

/// What a person typed for a number or a list of numbers: " 15 ", "15 mm", "[0.7, 0.9]", "0.7, 0.9".
/// \throws std::invalid_argument with a line that says what is wrong and names range and unit
config::Value typedValue(const config::Field& field, const std::string& typed);

/// That a value is out of range, as a line at the field of `key`: in the units that are shown. The range may
/// be that of another parameter.
std::string refusalText(const std::string& key, const OutOfRange& refused);

}  // namespace vantage
