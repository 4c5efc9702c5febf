#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/error.h"

namespace vantage {

/// The whole file as text. \throws InputError naming the file if it is missing, a folder, or larger than
/// `limit` bytes.
std::string readTextFile(const std::filesystem::path& path, std::uintmax_t limit = 64u << 20);

/// Refuses a path at which no file can be created, before work is spent on its content. An existing file
/// keeps its content. \throws InputError naming the file and the system's reason.
void requireCreatable(const std::filesystem::path& path);

/// Creates or replaces a file. \throws InputError if it cannot be created, std::runtime_error naming it if it
/// cannot be written in full, e.g. on a full disk.
void saveFile(const std::filesystem::path& path, std::string_view bytes);

/// "FILE:LINE" for messages.
std::string atLine(const std::filesystem::path& path, int line);

/// A number in full: "1.5", "-2e-3"; nothing for "1.5x", "" or a number that is not finite.
std::optional<double> parseNumber(std::string_view word);

/// Shortest decimal text that reads back to exactly this number.
std::string shortestNumber(double value);

/// One line of a text file, cut into words at blanks.
struct TextLine {
  int number = 0;  ///< from 1
  std::vector<std::string_view> words;
};

/// Lines with at least one word; `#` starts a comment. The words point into `text`.
std::vector<TextLine> splitLines(std::string_view text);

/// All numbers of a text, which holds nothing else but comments.
/// \throws InputError FILE:LINE for a word that is no number, or if there are more than `most`.
std::vector<double> parseNumbers(std::string_view text, const std::filesystem::path& path, std::size_t most);

}  // namespace vantage
