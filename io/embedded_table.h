#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace vantage {

/// One file compiled in by assets/embed.cmake.
struct EmbeddedFile {
  std::string_view name;  ///< path below assets/
  const char* data = nullptr;
  std::size_t size = 0;
};

/// All of them; defined in the generated source.
std::span<const EmbeddedFile> embeddedTable();

}  // namespace vantage
