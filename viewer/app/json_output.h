#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace vantage::app {

/// Writes a JSON document to a file, or to standard output for "-"; nothing if `path` is empty.
/// \throws as saveFile().
void writeJson(const std::string& path, const nlohmann::ordered_json& document);

}  // namespace vantage::app
