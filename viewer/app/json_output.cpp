#include "viewer/app/json_output.h"

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace vantage::app {

void writeJson(const std::string& path, const nlohmann::ordered_json& document) {
  if (path.empty()) return;
  const std::string text = document.dump(2) + "\n";
  if (path == "-") {
    std::fwrite(text.data(), 1, text.size(), stdout);
    return;
  }
  std::ofstream file(path, std::ios::binary);
  file << text << std::flush;
  if (!file)
    throw std::runtime_error(path + ": cannot be written; check the folder, the rights and the free space");
}

}  // namespace vantage::app
