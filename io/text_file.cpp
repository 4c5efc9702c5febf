#include "io/text_file.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace vantage {

std::string readTextFile(const std::filesystem::path& path, std::uintmax_t limit) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw InputError(path.string(), "is a folder; a file is wanted");
  std::ifstream file(path, std::ios::binary);
  if (!file.is_open()) throw InputError(path.string(), "cannot be read; check that the file exists");
  std::string text;
  std::array<char, 1 << 16> buffer;
  while (file.read(buffer.data(), buffer.size()) || file.gcount() > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > limit)
      throw InputError(path.string(),
                       "is larger than " + std::to_string(limit) + " bytes; no such file is that large");
  }
  if (file.bad()) throw InputError(path.string(), "cannot be read to its end");
  return text;
}

void requireCreatable(const std::filesystem::path& path) {
  const bool existed = std::filesystem::exists(path);
  errno = 0;
  if (!std::ofstream(path, std::ios::binary | std::ios::app))
    throw InputError(path.string(),
                     std::string("cannot be created (") + std::strerror(errno) + "); choose another place");
  std::error_code ignored;
  if (!existed) std::filesystem::remove(path, ignored);
}

void saveFile(const std::filesystem::path& path, std::string_view bytes) {
  requireCreatable(path);
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (file) return;
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) std::filesystem::remove(path, error);  // no half file
  throw std::runtime_error(path.string() + ": cannot be written in full; check the free space");
}

std::string atLine(const std::filesystem::path& path, int line) {
  return path.string() + ":" + std::to_string(line);
}

std::optional<double> parseNumber(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string shortestNumber(double value) {
  std::array<char, 40> buffer;
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr};
}

std::vector<TextLine> splitLines(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\v\f";
  std::vector<TextLine> lines;
  for (int number = 1; !text.empty(); ++number) {
    const auto end = text.find('\n');
    std::string_view rest = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    rest = rest.substr(0, rest.find('#'));
    TextLine line{number, {}};
    for (auto first = rest.find_first_not_of(kBlank); first != std::string_view::npos;
         first = rest.find_first_not_of(kBlank)) {
      rest.remove_prefix(first);
      const auto length = std::min(rest.find_first_of(kBlank), rest.size());
      line.words.push_back(rest.substr(0, length));
      rest.remove_prefix(length);
    }
    if (!line.words.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<double> parseNumbers(std::string_view text, const std::filesystem::path& path, std::size_t most) {
  std::vector<double> numbers;
  for (const TextLine& line : splitLines(text)) {
    for (const std::string_view word : line.words) {
      const auto number = parseNumber(word);
      if (!number)
        throw InputError(atLine(path, line.number),
                         "'" + std::string(word.substr(0, 40)) + "' is not a finite number");
      if (numbers.size() == most)
        throw InputError(atLine(path, line.number),
                         "more than " + std::to_string(most) + " numbers; expected that many");
      numbers.push_back(*number);
    }
  }
  return numbers;
}

}  // namespace vantage
