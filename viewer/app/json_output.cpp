#include "viewer/app/json_output.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "io/text_file.h"

namespace vantage::app {

void writeJson(const std::string& path, const nlohmann::ordered_json& document) {
  if (path.empty()) return;
  const std::string text = document.dump(2) + "\n";
  if (path == "-")
    std::fwrite(text.data(), 1, text.size(), stdout);
  else
    saveFile(path, text);
}

}  // namespace vantage::app
