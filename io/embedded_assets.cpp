#include "io/embedded_assets.h"

#include <algorithm>

#include "io/embedded_table.h"
#include "io/error.h"
#include "io/suggest.h"

namespace vantage {

std::string_view embeddedAsset(std::string_view name) {
  for (const EmbeddedFile& file : embeddedTable())
    if (file.name == name) return {file.data, file.size};
  throw InputError(std::string(name),
                   "no built-in file of this name" + suggestion(name, embeddedAssetNames()));
}

std::vector<std::string> embeddedAssetNames(std::string_view prefix) {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : embeddedTable())
    if (file.name.starts_with(prefix)) names.emplace_back(file.name);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace vantage
