#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "io/scene_file.h"

namespace vantage::test {

/// Folder of the running test, emptied at its start and removed at its end.
class TestFolder {
 public:
  TestFolder() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() / ("vantage_" + std::string(info->test_suite_name()) +
                                                      "_" + info->name() + "_" + std::to_string(getpid()));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  std::string write(const std::string& name, const std::string& bytes) const {
    const std::string path = (path_ / name).string();
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

/// Message of the InputError that a call throws; fails the test if it throws nothing or something else.
template <class Call>
std::string inputError(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "no InputError but: " << error.what();
    return {};
  }
  ADD_FAILURE() << "no error";
  return {};
}

inline SceneFile sceneOf(const std::string& toml) {
  return parseScene(toml, "test.toml", ".");
}

}  // namespace vantage::test
