#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Contents of a file that is compiled into the program, by its path below assets/, e.g.
/// "scenes/tabletop.toml". Lives as long as the program. \throws InputError if there is none of this name,
/// with the nearest one.
std::string_view embeddedAsset(std::string_view name);

/// Names of the compiled-in files that begin with `prefix`, sorted; all for an empty prefix.
std::vector<std::string> embeddedAssetNames(std::string_view prefix = {});

}  // namespace vantage
