#pragma once

#include <span>
#include <string>
#include <string_view>

namespace vantage {

/// The known word nearest to a mistyped one by edit distance (Levenshtein); ties go to the first. Empty if
/// there is none within half of the longer word's length, or `known` is empty. Words beyond 200 characters
/// match nothing.
std::string nearest(std::string_view word, std::span<const std::string> known);

/// Ending of a message about an unknown word: `"; did you mean 'X'?"` for the nearest known one; if none is
/// near,
/// `"; known: a, b, c"`; empty if `known` is.
std::string suggestion(std::string_view word, std::span<const std::string> known);

}  // namespace vantage
