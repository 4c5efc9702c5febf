#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/error.h"

namespace vantage::mesh_text {

/// Walks through a text line by line and word by word; keeps the line number for messages. Internal to the
/// mesh readers.
class Cursor {
 public:
  Cursor(std::string_view text, std::string path) : rest_(text), path_(std::move(path)) {}

  /// Next line into line(); false at the end of the text.
  bool nextLine() {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    line_ = rest_.substr(0, end);
    rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    ++number_;
    return true;
  }
  /// Next word of the line; empty at its end.
  std::string_view word() {
    const std::size_t begin = line_.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return line_ = {};
    line_.remove_prefix(begin);
    const std::string_view found = line_.substr(0, line_.find_first_of(" \t"));
    line_.remove_prefix(found.size());
    return found;
  }
  template <class T>
  T number(std::string_view what) {
    const std::string_view text = word();
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc() || end != text.data() + text.size())
      fail(std::string(what) + " '" + std::string(text.substr(0, 40)) + "' is no number");
    return value;
  }
  /// A finite number.
  float coordinate() {
    const float value = number<float>("coordinate");
    if (!std::isfinite(value)) fail("a coordinate is not finite");
    return value;
  }
  /// What follows the current line.
  std::string_view rest() const { return rest_; }
  int lineNumber() const { return number_; }

  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(path_ + ":" + std::to_string(number_), message);
  }

 private:
  std::string_view rest_, line_;
  std::string path_;
  int number_ = 0;
};

}  // namespace vantage::mesh_text
