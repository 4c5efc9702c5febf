#include <fmt/format.h>
#include <tbb/global_control.h>

#include <fstream>
#include <string>
#include <thread>

#include "viewer/app/experiments/experiments.h"

namespace vantage::experiments {
namespace {

/// Value of the first line `KEY : VALUE` of a file in /proc.
std::string procValue(const char* file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(key)) {
      const std::size_t value = line.find_first_not_of(" \t", line.find(':') + 1);
      return value == std::string::npos ? "" : line.substr(value);
    }
  return "unknown";
}

}  // namespace

std::vector<std::string> machineText() {
  const auto threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return {fmt::format("processor: {}, {} hardware threads", procValue("/proc/cpuinfo", "model name"),
                      std::thread::hardware_concurrency()),
          fmt::format("threads used: {}", threads),
          fmt::format("memory: {}", procValue("/proc/meminfo", "MemTotal"))};
}

}  // namespace vantage::experiments
