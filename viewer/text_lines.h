#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace vantage {

/// The text with a new line wherever the next word no longer fits. Lines end at spaces alone, and a number
/// stays with what follows it: "0.61", "35 248 rays" and "0.1 .. 200 mm" are never torn. What is wider than a
/// line by itself is broken where it has to be. Lines that the text has stay. \param width of a line, in the
/// unit of `width_of`; the text as it is if not positive
std::string brokenAtSpaces(const std::string& text, double width,
                           const std::function<double(std::string_view)>& width_of);

}  // namespace vantage
