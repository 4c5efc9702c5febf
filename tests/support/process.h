#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace vantage::test {

/// What a program printed and how it ended.
struct ProcessResult {
  int code = -1;  ///< exit code; 128 + signal if a signal ended it
  std::string out, err;
};

struct ProcessOptions {
  std::map<std::string, std::string> environment;  ///< added to the test's own
  std::filesystem::path folder;                    ///< working folder, empty = the test's own
  std::string input;                               ///< standard input
  std::size_t file_size_limit = 0;                 ///< bytes that files may reach, 0 = no limit: a full disk
  std::size_t memory_limit = 0;                    ///< bytes of address space, 0 = no limit
  double interrupt_after_s = 0.0;                  ///< send SIGINT after this time, 0 = never
};

/// Runs a program and waits for it. The first word is its path.
ProcessResult runProcess(const std::vector<std::string>& words, const ProcessOptions& options = {});

/// A program that runs beside the test, until it is killed at the end. What it prints goes to the test's own
/// output.
class BackgroundProcess {
 public:
  explicit BackgroundProcess(const std::vector<std::string>& words, const ProcessOptions& options = {});
  ~BackgroundProcess();
  BackgroundProcess(const BackgroundProcess&) = delete;
  bool running() const;

 private:
  mutable int child_ = -1;  ///< -1 = ended
};

/// A new folder that is removed at the end of the test.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  /// Path of a file in it.
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

std::string readFile(const std::filesystem::path& path);
void writeFile(const std::filesystem::path& path, const std::string& text);

}  // namespace vantage::test
