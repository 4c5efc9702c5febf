#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "io/error.h"

namespace vantage {

/// What an action that must be refused says.
inline std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

/// A folder of its own for every test, removed afterwards.
class FolderTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        std::filesystem::temp_directory_path() / ("vantage_" + std::string(info->test_suite_name()) + "_" +
                                                  info->name() + "_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  std::string read(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::filesystem::path folder_;
};

/// Folder with recorded data, or the test skips and says why.
#define VANTAGE_RECORDED(variable, name)                                                    \
  const std::filesystem::path variable = std::filesystem::path(VANTAGE_TEST_DATA) / (name); \
  if (!std::filesystem::exists(variable)) GTEST_SKIP() << "recorded data is absent: " << variable

}  // namespace vantage
