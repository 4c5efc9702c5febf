#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

#include "io/scene_file.h"

namespace vantage {

/// A scene file and the bases below it as one document. Internal to the scene reader.
struct ComposedScene {
  /// Without `base`, `without` and `move`; every solid has an object's name and a colour. A solid's and the
  /// room's source() tell the file they came from.
  toml::table table;
  std::vector<SceneLayer> layers;  ///< the lowest base first, the file itself last
  std::size_t numbered = 0;        ///< solids of all files, those left out included
};

/// \throws InputError for broken TOML, a base that is missing or leads back to itself, and a `without` or
/// `move` that fits nothing in the base.
ComposedScene composeScene(const SceneLayer& file);

/// Text of an embedded scene or of a file. \throws InputError
SceneLayer readSceneLayer(const std::string& name_or_path);

std::vector<std::string> embeddedSceneNames();

/// \throws InputError `SOURCE:LINE: ...`
toml::table parseSceneToml(std::string_view text, const std::string& source);

}  // namespace vantage
