#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace vantage::test {

/// Runs the program with these words.
inline ProcessResult vantage(std::vector<std::string> words, ProcessOptions options = {}) {
  words.insert(words.begin(), VANTAGE_BINARY);
  options.environment.emplace("XDG_CONFIG_HOME", "/nonexistent");  // no user configuration
  return runProcess(words, options);
}

/// Bad input or usage: exit code 2 and exactly one line on standard error, which holds all of `parts`.
inline void expectRefused(const ProcessResult& result, const std::vector<std::string>& parts, int code = 2) {
  EXPECT_EQ(result.code, code) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_EQ(result.err.rfind("vantage: ", 0), 0u) << result.err;
  for (const std::string& part : parts)
    EXPECT_NE(result.err.find(part), std::string::npos) << part << " in " << result.err;
}

/// Lines of a text without their ends.
inline std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> all;
  std::size_t start = 0;
  while (start < text.size()) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    all.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return all;
}

}  // namespace vantage::test
