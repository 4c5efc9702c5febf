#pragma once

#include <string>
#include <utility>

namespace vantage::app {

/// "WxH" in pixels, each within what snapshots can be. \throws InputError naming the option
std::pair<int, int> parseSize(const std::string& option, const std::string& text);

}  // namespace vantage::app
